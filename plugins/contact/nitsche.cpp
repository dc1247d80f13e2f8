#include <algorithm>
#include <cmath>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <vector>

#include "power_law.hpp"

namespace {

using namespace ricochet;

/// κ/γ₀: 12EI/ℓ³ of a beam's element, EA/ℓ of a bar's, N/m; ℓ the shortest.
double element_stiffness(const ContactStructure& structure) {
  double shortest = structure.space->elements.front().length;
  for (const auto& element : structure.space->elements) shortest = std::min(shortest, element.length);
  const bool beam = structure.space->basis == FiniteElementSpace::Basis::hermite;
  return structure.rigidity * (beam ? 12 / (shortest * shortest * shortest) : 1 / shortest);
}

// Rows that are one displacement dof, exactly: points at nodes.
bool stands_at_node(const SparseRows& rows, Eigen::Index i) {
  return rows.row(i).nonZeros() == 1 && rows.row(i).sum() == 1;
}

// Of rows that stand at nodes.
bool share_a_node(const SparseRows& rows) {
  std::vector<Eigen::Index> dofs;
  for (Eigen::Index i = 0; i < rows.outerSize(); ++i)
    for (SparseRows::InnerIterator entry(rows, i); entry; ++entry)
      if (entry.value() != 0) dofs.push_back(entry.col());
  std::sort(dofs.begin(), dofs.end());
  return std::adjacent_find(dofs.begin(), dofs.end()) != dofs.end();
}

/// λ_max(s K⁻¹ sᵀ) = λ_max(H K Hᵀ) as s = H K; its bound by the largest row sum where that is enough for κ.
double coercivity_limit(const SparseMatrix& reactions, double kappa) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(reactions.rows());
  for (Eigen::Index j = 0; j < reactions.outerSize(); ++j)
    for (SparseMatrix::InnerIterator entry(reactions, j); entry; ++entry) sums[entry.row()] += std::abs(entry.value());
  if (kappa > sums.maxCoeff()) return sums.maxCoeff();
  return symmetric_modes(reactions, EigenVectors::none).values.maxCoeff();
}

/// Nitsche's method with θ = 1 at pointwise stops. The elements report the reaction σ_i = s_iᵀq at node i. Of a beam it
/// is the jump of shear EI(u‴₊ − u‴₋), of a bar EA(u′₋ − u′₊). Both are the row of K q: s = H K. With κ = γ₀·12EI/ℓ³ or
/// γ₀·EA/ℓ
///
///     G = H − s/κ,     K' = K − sᵀs/κ always,     p = κ(lower − G q)₊ − κ(G q − upper)₊
///
/// the optimality of ½qᵀKq − |σ|²/2κ + |p|²/2κ. Consistent: where σ = p rests on the stop, nothing of κ is left. K' is
/// definite for κ > λ_max(s K⁻¹ sᵀ), 12EI/ℓ³ at the tip of a beam, up to 48EI/ℓ³ with stops at all nodes.
class Nitsche final : public PointwiseContact {
 public:
  Nitsche(double gamma, long long theta, const ForceEvaluation& evaluation)
      : PointwiseContact(evaluation), gamma_(gamma), theta_(theta) {}
  bool changes_problem() const override { return true; }
  bool per_point() const override { return false; }

  std::optional<Refusal> prepare_problem(ContactStructure& structure) override {
    if (theta_ != 1)
      return Refusal{
          said("theta = {} makes the contact problem nonsymmetric, G S⁻¹ Hᵀ, and its points cannot be solved as "
               "the minimum that all laws are: take theta = 1",
               theta_)};
    if (structure.space->elements.empty())
      return Refusal{"an oscillator has no elements that could report a reaction at its stop: take a penalty"};
    const SparseRows& H = *structure.contact;
    for (Eigen::Index i = 0; i < H.rows(); ++i)
      if (!stands_at_node(H, i))
        return Refusal{
            said("contact point {} of {} lies within an element, where the elements report no "
                 "reaction: put the stops at nodes of the mesh",
                 i + 1, H.rows())};
    if (share_a_node(H))
      return Refusal{
          "two stops stand at one node, where the elements report one reaction: keep one of them, or use a penalty"};
    const double scale = element_stiffness(structure), kappa = gamma_ * scale;
    const SparseRows s = H * structure.stiffness;
    const double limit = coercivity_limit(s * H.transpose(), kappa);
    if (!(kappa > limit))
      return Refusal{
          said("gamma0 = {:g} leaves the structure a stiffness that is not positive: with {} contact point{} the "
               "limit is {:.6g}, take a larger one",
               gamma_, H.rows(), H.rows() == 1 ? "" : "s", limit / scale)};
    structure.measured = H - s * (1 / kappa);
    const SparseMatrix soft = SparseMatrix(s.transpose()) * SparseMatrix(s);
    structure.stiffness = structure.stiffness - soft * (1 / kappa);
    spring_ = {kappa, 1};
    return std::nullopt;
  }

  std::optional<ContactSlopes> linear_slopes(int) const override {
    if (spring_.stiffness == 0) return std::nullopt;
    return spring_slopes(spring_.stiffness, reads());
  }

 private:
  void set_lanes(std::span<const Parameters>) override {}
  PointForce at(const ContactState& state) const override { return spring_.at(state.depth); }
  PointForce gradient(const ContactState& state) const override { return spring_.between(state.depth, state.before); }
  double stored(double depth, int) const override { return spring_.stored(depth); }

  double gamma_;
  long long theta_;
  PowerLaw spring_;  // κ, once the structure is known
};

void register_nitsche(Registry& registry) {
  registry.add_contact(
      {.name = "nitsche",
       .summary = "Nitsche's method: springs on the displacement less the reaction that the elements report",
       .text =
           R"(A penalty of stiffness κ on G q = H q − σ/κ in place of the displacement H q of each contact point, σ
          the reaction of the elements there (a beam's jump of shear, a bar's of the axial force), while the stiffness
          of the structure is K − Σσσᵀ/κ whether it touches or not. At rest on a stop σ is the contact force and κ
          leaves no error, where a penalty leaves p/κ. κ is gamma0 times 12EI/ℓ³ of an element of a beam, EA/ℓ of a
          bar. In motion σ holds the inertia of half an element as well: at the tip the error is below that of the
          penalty of the same κ, with stops at all nodes it is above, for the free beam is softened. The stiffness
          stays positive for κ beyond a limit, one 12EI/ℓ³ at the tip of a beam, up to four with stops at all nodes:
          below it the method is refused. Penetration is still that of the points. A load at a contact node and the
          viscous part of the reaction are not in σ, and C is αK' + ηM with the changed K'. )" +
           std::string(evaluation_text) + "The restitution of the time scheme has no part in it.",
       .source = R"(Nitsche (1971), Über ein Variationsprinzip; Chouly and Hild (2013), A Nitsche-based method for
          unilateral contact problems; hybrid: Chouly, Hild and Renard (2015))",
       .parameters = {real_parameter("gamma0", "1", 10.0, {.low = 0, .low_open = true},
                                     "γ₀, κ over 12EI/ℓ³ of a beam's element or EA/ℓ of a bar's"),
                      integer_parameter("theta", 1, {.low = -1, .high = 1},
                                        "θ of Nitsche's family; 1, the symmetric method, is the one that is offered"),
                      evaluation_parameter()},
       .words = "Nitsche"},
      [](const Parameters& p) {
        return std::make_unique<Nitsche>(p.real("gamma0"), p.integer("theta"), evaluation_of(p));
      });
}

}  // namespace

RICOCHET_PLUGIN(contact, nitsche, register_nitsche)
