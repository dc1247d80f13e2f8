#include <algorithm>
#include <cmath>
#include <numeric>
#include <ricochet/contract/plugin.hpp>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <vector>

namespace {

using namespace ricochet;

/// Contact dofs whose neighbourhoods overlap, and the dofs of these neighbourhoods.
struct DofGroup {
  std::vector<int> dofs;   ///< sorted
  std::vector<char> near;  ///< of each of the n dofs
};

/// Groups of contact dofs on the graph of K and M. The neighbourhood of a dof holds the dofs at most `reach` entries
/// away. Dofs whose neighbourhoods meet are one group. Reach 0: all dofs, one group.
std::vector<DofGroup> ring_groups(const GivenMass& given, const std::vector<int>& contact, int reach) {
  const auto n = static_cast<std::size_t>(given.mass.rows());
  if (contact.empty()) return {};
  if (reach == 0) return {{contact, std::vector<char>(n, 1)}};
  std::vector<std::vector<int>> rings;
  std::vector<std::size_t> group(contact.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto first_of = [&](std::size_t k) {
    while (group[k] != k) k = group[k];
    return k;
  };
  std::vector<int> owner(n, -1), met(n, -1);
  for (std::size_t k = 0; k < contact.size(); ++k) {
    const auto mine = static_cast<int>(k);
    std::vector<int>& ring = rings.emplace_back(1, contact[k]);
    met[static_cast<std::size_t>(contact[k])] = mine;
    std::size_t begin = 0;
    for (int step = 0; step < reach; ++step) {
      const std::size_t end = ring.size();
      for (; begin < end; ++begin)
        for (const SparseMatrix* graph : {&given.stiffness, &given.mass})
          for (SparseMatrix::InnerIterator it(*graph, ring[begin]); it; ++it)
            if (int& at = met[static_cast<std::size_t>(it.row())]; at != mine && it.value() != 0) {
              at = mine;
              ring.push_back(static_cast<int>(it.row()));
            }
    }
    for (const int dof : ring) {
      int& other = owner[static_cast<std::size_t>(dof)];
      if (other < 0) other = mine;
      const std::size_t a = first_of(k), b = first_of(static_cast<std::size_t>(other));
      group[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<DofGroup> out;
  std::vector<int> number(contact.size(), -1);
  for (std::size_t k = 0; k < contact.size(); ++k) {
    int& at = number[first_of(k)];
    if (at < 0) {
      at = static_cast<int>(out.size());
      out.push_back({{}, std::vector<char>(n, 0)});
    }
    DofGroup& one = out[static_cast<std::size_t>(at)];
    one.dofs.push_back(contact[k]);
    for (const int dof : rings[k]) one.near[static_cast<std::size_t>(dof)] = 1;
  }
  return out;
}

// Mass moved off the dofs where contact acts, by a projection (Khenous, Laborde and Renard 2008, there over the whole
// mesh).
//
// With M the consistent mass of the free dofs and X the rigid motions (translation; of a beam rotation, of a bar x):
//
//     min ‖D (M_r − M) D‖_F,  D = diag(M)^{-1/2},     M_r = 0 in the rows and columns of contact dofs,
//     M_r − M sparse as M, and zero beyond `reach` elements from a contact point,     Xᵀ M_r X = Xᵀ M X
//
// Hence M_r = M° + Σ_ab λ_ab D⁻² ½(X_a X_bᵀ + X_b X_aᵀ) D⁻² on these entries, M° being M without the rows: three
// multipliers. D makes displacements and rotations weigh the same on any mesh; with one length for both instead, beams
// have negative eigenvalues.

/// Where a dof stands, and the rigid motions there.
struct RigidMotions {
  Eigen::VectorXd place;
  Eigen::MatrixXd columns;  ///< n × 2: 1 and x, or (1, 0) and (x, 1)
  explicit RigidMotions(const FiniteElementSpace& space) : place(space.dofs), columns(space.dofs, 2) {
    const bool hermite = space.basis == FiniteElementSpace::Basis::hermite;
    for (const auto& element : space.elements)
      for (int a = 0; a < space.functions(); ++a) {
        if (element.dof[a] < 0) continue;
        const bool second = hermite ? a >= 2 : a == 1, rotation = hermite && a % 2 == 1;
        const double x = element.left + (second ? element.length : 0);
        place[element.dof[a]] = x;
        columns.row(element.dof[a]) << (rotation ? 0.0 : 1.0), (rotation ? 1.0 : x);
      }
  }
  /// The same motions about x₀, in units of `length`.
  Eigen::MatrixXd about(double x0, double length) const {
    Eigen::MatrixXd moved = columns;
    moved.col(1) = (columns.col(1) - x0 * columns.col(0)) / length;
    return moved;
  }
};

/// Takes the mass off the dofs `empty` (sorted), whose neighbours in `near` (n) get it, so that XᵀMX stays, X (n × k)
/// the rigid motions. False where they cannot carry it.
template <int k>
bool move_mass(SparseMatrix& mass, const Eigen::Matrix<double, Eigen::Dynamic, k>& X, const std::vector<int>& empty,
               const std::vector<char>& near) {
  constexpr int size = k == Eigen::Dynamic ? Eigen::Dynamic : k * (k + 1) / 2, most = 21;
  using Moments = Eigen::Matrix<double, size, 1, 0, k == Eigen::Dynamic ? most : size, 1>;
  using Response = Eigen::Matrix<double, size, size, 0, Moments::MaxSizeAtCompileTime, Moments::MaxSizeAtCompileTime>;
  const Eigen::Index motions = X.cols(), moments = motions * (motions + 1) / 2;
  const Eigen::VectorXd diagonal = mass.diagonal();
  const auto is_empty = [&](Eigen::Index i) {
    return std::binary_search(empty.begin(), empty.end(), static_cast<int>(i));
  };
  const auto takes = [&](Eigen::Index i) { return near[static_cast<std::size_t>(i)] != 0; };
  // ½(X_a X_bᵀ + X_b X_aᵀ)_ij for ab = 11, 12, …, 22, ….
  const auto share = [&](Eigen::Index i, Eigen::Index j) {
    Moments s(moments);
    Eigen::Index p = 0;
    for (Eigen::Index a = 0; a < motions; ++a) {
      s[p++] = X(i, a) * X(j, a);
      for (Eigen::Index b = a + 1; b < motions; ++b) s[p++] = 0.5 * (X(i, a) * X(j, b) + X(i, b) * X(j, a));
    }
    return s;
  };
  Moments lost = Moments::Zero(moments);
  Response response = Response::Zero(moments, moments);
  const auto each = [&](auto&& use) {
    for (Eigen::Index j = 0; j < mass.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(mass, j); it; ++it) use(it, is_empty(it.row()) || is_empty(j));
  };
  each([&](const SparseMatrix::InnerIterator& it, bool emptied) {
    const Moments s = share(it.row(), it.col());
    if (emptied)
      lost += it.value() * s;
    else if (takes(it.row()) && takes(it.col()))
      response += diagonal[it.row()] * diagonal[it.col()] * s * s.transpose();
  });
  const Moments lambda = least_norm_solve(response, lost);
  if (!((response * lambda - lost).norm() <= 1e-9 * lost.norm())) return false;
  each([&](SparseMatrix::InnerIterator& it, bool emptied) {
    if (emptied)
      it.valueRef() = 0;
    else if (takes(it.row()) && takes(it.col()))
      it.valueRef() += diagonal[it.row()] * diagonal[it.col()] * lambda.dot(share(it.row(), it.col()));
  });
  return true;
}

/// The same within `reach` of the places of `empty`, in m; infinite: all.
bool move_mass(SparseMatrix& mass, const RigidMotions& rigid, const std::vector<int>& empty, double reach) {
  const double first = rigid.place[empty.front()], last = rigid.place[empty.back()];
  const double length = std::min(reach, rigid.place.maxCoeff() - rigid.place.minCoeff());
  std::vector<char> near;
  for (const double place : rigid.place)
    near.push_back(std::any_of(empty.begin(), empty.end(),
                               [&](int dof) { return std::abs(place - rigid.place[dof]) <= reach * (1 + 1e-9); }));
  return move_mass<2>(mass, rigid.about((first + last) / 2, length), empty, near);
}

/// The same of matrices that are given. X spans the motions of the neighbourhood, orthonormal in diag(M): those that it
/// cannot tell apart count once.
bool move_mass(SparseMatrix& mass, const GivenMass& given, const DofGroup& group) {
  constexpr double apart = 1e-9;
  Eigen::VectorXd scale = mass.diagonal();
  for (Eigen::Index i = 0; i < scale.size(); ++i)
    scale[i] = scale[i] > 0 && group.near[static_cast<std::size_t>(i)] ? std::sqrt(scale[i]) : 0;
  Eigen::MatrixXd X(mass.rows(), 0);
  for (Eigen::Index k = 0; k < given.rigid.cols(); ++k) {
    Eigen::VectorXd motion = scale.asDiagonal() * given.rigid.col(k);
    const double before = motion.norm();
    for (int twice = 0; twice < 2; ++twice) motion -= X * (X.transpose() * motion);
    if (!(motion.norm() > apart * before)) continue;
    X.conservativeResize(Eigen::NoChange, X.cols() + 1);
    X.rightCols(1) = motion / motion.norm();
  }
  for (double& one : scale) one = one > 0 ? 1 / one : 0;
  X = scale.asDiagonal() * X;
  return move_mass<Eigen::Dynamic>(mass, X, group.dofs, group.near);
}

/// Whether a mass is positive definite outside the rows `empty`. Where it may have a `kernel` there, too, positive
/// semidefinite is enough.
inline bool positive_elsewhere(const SparseMatrix& mass, const std::vector<int>& empty, bool kernel = false) {
  Eigen::VectorXd scale = mass.diagonal();
  if (!(scale.minCoeff() >= 0)) return false;
  for (double& value : scale) value = value > 0 ? 1 / std::sqrt(value) : 1;
  SparseMatrix scaled = scale.asDiagonal() * mass * scale.asDiagonal();
  const double regular = kernel ? -1e-11 : 1e-9;
  for (int i = 0; i < scaled.rows(); ++i)
    scaled.coeffRef(i, i) += std::binary_search(empty.begin(), empty.end(), i) ? 1 : -regular;
  SparseLdlt factors;
  return factors.factorise(scaled) &&
         std::all_of(factors.pivot().begin(), factors.pivot().end(), [](double pivot) { return pivot > 0; });
}

/// form lumped: lumped mass whose free ends carry none. The half element mass m/2 of a free end node goes to its two
/// neighbours, at ℓ and 2ℓ, as m and −m/2. The sum m/2 and the first moment 0 are as before: total mass and centre of
/// gravity are kept. The diagonal next to that end becomes (0, 2m, m/2, m, …).
class OfTheEnds : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.basis != FiniteElementSpace::Basis::linear || space.elements.empty())
      return Refusal{"the redistributed mass empties the end nodes of a bar; for this " + space.structure +
                     (space.given ? " use its form projected" : " use its form projected or the mass singular")};
    const int free_ends = (space.left_fixed ? 0 : 1) + (space.right_fixed ? 0 : 1);
    const auto count = static_cast<int>(space.elements.size());
    // Both neighbours of an end must be free nodes, and not those of the other end.
    if (count < 2 * free_ends + 1)
      return Refusal{said("the mass of a free end needs two further free nodes to go to: use at least {} elements",
                          2 * free_ends + 1)};
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(space.dofs);
    for (const auto& element : space.elements)
      for (int a = 0; a < 2; ++a)
        if (element.dof[a] >= 0) diagonal[element.dof[a]] += element.line_density * element.length / 2;
    const auto empty_end = [&](const FiniteElementSpace::Element& end, int step) {
      const int node = end.dof[step > 0 ? 0 : 1];
      const double mass = end.line_density * end.length;
      diagonal[node] -= mass / 2;
      diagonal[node + step] += mass;
      diagonal[node + 2 * step] -= mass / 2;
      diagonal[node] = 0;
    };
    if (!space.left_fixed) empty_end(space.elements.front(), 1);
    if (!space.right_fixed) empty_end(space.elements.back(), -1);
    for (const auto& point : space.point_masses) diagonal[point.dof] += point.mass;

    Inertia inertia;
    inertia.mass.resize(space.dofs, space.dofs);
    for (int i = 0; i < space.dofs; ++i) {
      if (diagonal[i] == 0) ++inertia.kernel_dimension;
      if (diagonal[i] != 0) inertia.mass.insert(i, i) = diagonal[i];
    }
    inertia.mass.makeCompressed();
    return inertia;
  }
  bool takes_given() const override { return true; }
};

/// form projected: consistent mass whose contact dofs carry none.
class Projected : public MassStrategy {
 public:
  explicit Projected(int reach) : reach_(reach) {}

  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (space.given) return of_given(*space.given, space.contact_dofs);
    if (space.elements.empty())
      return Refusal{"a redistributed mass needs elements to move mass over, and this " + space.structure +
                     " has none: use the mass consistent or lumped"};
    FiniteElementSpace bare = space;
    bare.point_masses.clear();
    Inertia inertia;
    inertia.mass = consistent_mass(bare);
    const RigidMotions rigid(space);
    // Where elements differ, `reach` counts the longest.
    double length = 0;
    for (const auto& element : space.elements) length = std::max(length, element.length);
    const double reach = reach_ > 0 ? reach_ * length : INFINITY;
    for (const std::vector<int>& group : groups(space.contact_dofs, rigid, reach))
      if (!move_mass(inertia.mass, rigid, group, reach))
        return Refusal{"no dof near the contact points of this " + space.structure +
                       " is left to carry their mass, its centre and its moment of inertia: use more elements, fewer "
                       "stops or the mass singular"};
    inertia.mass.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0; });
    if (!positive_elsewhere(inertia.mass, space.contact_dofs))
      return Refusal{"the mass moved off the contact points of this " + space.structure +
                     " leaves a negative eigenvalue: use another reach, more elements or the mass singular"};
    for (const auto& point : space.point_masses) inertia.mass.coeffRef(point.dof, point.dof) += point.mass;
    inertia.mass.makeCompressed();
    for (const int dof : space.contact_dofs)
      if (inertia.mass.coeff(dof, dof) == 0) ++inertia.kernel_dimension;
    return inertia;
  }

  bool takes_given() const override { return true; }

 private:
  // Over `reach` rings of the graph of the matrices, or all of it.
  InertiaOrRefusal of_given(const GivenMass& given, const std::vector<int>& contact) const {
    Inertia inertia;
    inertia.mass = given.mass;
    for (const DofGroup& group : ring_groups(given, contact, reach_))
      if (!move_mass(inertia.mass, given, group))
        return Refusal{
            "no dof near the contact points of this assembled structure is left to carry their mass in its rigid "
            "motions: use a larger reach. Otherwise use fewer stops, or the mass consistent"};
    inertia.mass.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0; });
    if (!positive_elsewhere(inertia.mass, contact, true))
      return Refusal{
          "the mass moved off the contact points of this assembled structure leaves a negative eigenvalue: use another "
          "reach or the mass consistent"};
    inertia.mass.makeCompressed();
    inertia.kernel_dimension = static_cast<int>(inertia.mass.rows()) - semidefinite_rank(inertia.mass);
    return inertia;
  }

  // Contact dofs whose neighbourhoods overlap: mass, centre and moment of inertia are kept for each group.
  static std::vector<std::vector<int>> groups(const std::vector<int>& dofs, const RigidMotions& rigid, double reach) {
    std::vector<std::vector<int>> found;
    for (const int dof : dofs) {
      if (found.empty() || rigid.place[dof] - rigid.place[found.back().back()] > 2.001 * reach) found.emplace_back();
      found.back().push_back(dof);
    }
    return found;
  }

  int reach_;
};

void register_redistributed(Registry& registry) {
  PluginManual manual;
  manual.name = "redistributed";
  manual.summary = "mass whose contact points carry none: it is moved to their neighbours";
  manual.text =
      R"(A contact point then has no inertia: an impact there moves no mass and destroys no energy. Form lumped, of
          bars: the diagonal mass, the share of each free end moved to its two neighbours, total mass and centre of
          gravity kept; order 2.6. Form projected, of bars and beams: the matrix nearest to the consistent one whose
          contact dofs have no row, with the same total mass, centre and moment of inertia of the free dofs. It
          differs within `reach` elements of a contact point, and frequencies keep their order; reach 0 spreads the
          mass over the whole mesh, as the paper does, and leaves order 1. Of an assembled structure, `reach` counts
          rings of neighbours in K and M, and the translations and rotations of the table of dofs keep their mass. A
          damped beam with a stop at its tip converges with order 2 to 4 (reach 2) and 1 (reach 0) in the element
          length. Refused where no dof is left to carry the mass (stops at all nodes: singular does that through its
          velocity space) and where a negative eigenvalue would be left.)";
  manual.source =
      R"(Khenous, Laborde, Renard 2008, Mass redistribution method for finite element contact problems in
          elastodynamics, Eur. J. Mech. A/Solids 27, 918-932; its diagonal form with two neighbours and the reach:
          this program)";
  manual.parameters = {
      word_parameter(
          "form", {"lumped", "projected"}, "lumped",
          R"(lumped: the free ends of a bar, from its diagonal mass; projected: the contact dofs of the scene, from
          the consistent mass)"),
      integer_parameter("reach", 2, {.low = 0, .high = 1000},
                        "elements, or rings of neighbours, over which form projected moves mass; 0: the whole mesh")};
  registry.add_mass(std::move(manual), [](const Parameters& p) -> std::unique_ptr<MassStrategy> {
    if (p.word("form") == "lumped") return std::make_unique<OfTheEnds>();
    return std::make_unique<Projected>(static_cast<int>(p.integer("reach")));
  });
}

}  // namespace

RICOCHET_PLUGIN(mass, redistributed, register_redistributed)
