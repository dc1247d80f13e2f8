#pragma once
#include <cstddef>
#include <optional>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/contract/parameters.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace ricochet {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The structure and its contact points before anything marches, for laws to which the displacement of a point is not
/// enough. Such a law replaces H by G and K by K':
///
///     M q'' + (αK' + ηM) q' + K' q = F(t) + Gᵀ p,     p = Φ(lower − G q) − Φ(G q − upper)
///
/// q is relative to the clamp; G must report a rigid translation as it is, as H does. Where the points are, penetration
/// and the dates of impacts are those of H, whatever the law measures.
struct ContactStructure {
  const FiniteElementSpace* space = nullptr;
  double rigidity = 0;                  ///< EI of a beam (N m²), EA of a bar (N), k of an oscillator (N/m)
  const SparseRows* contact = nullptr;  ///< H (m × n), displacements of the contact points
  SparseRows measured;                  ///< in: H; out: G (m × n)
  SparseMatrix stiffness;               ///< in: K; out: K', symmetric positive (semi)definite, n × n, both triangles
};

/// Columns of the Delassus operator W = H S⁻¹ Hᵀ (m × m, SPD or semidefinite, m/N), computed when first asked for. The
/// first time a column costs one solve with S. Later it is a lookup.
class DelassusColumns {
 public:
  virtual ~DelassusColumns() = default;
  /// Column j: m numbers, valid until the operator is rebuilt.
  virtual const double* column(int j) = 0;
};

/// How a law's work on one lane ended.
struct LaneOutcome {
  bool converged = true;
  int iterations = 0;      ///< pivoting, augmentation or Newton iterations of this solve
  double residual = 0;     ///< complementarity residual, or error of the force law, in units of the measure
  double dissipation = 0;  ///< power that the law itself dissipates at its evaluation (W ≥ 0): a damper's
};

/// Numbers `stride` apart: what one lane has in a block, by point.
template <class Number>
struct Strided {
  Number* first = nullptr;
  int stride = 1;
  template <class Index>
  Number& operator[](Index i) const {
    return first[static_cast<std::ptrdiff_t>(i) * stride];
  }
  explicit operator bool() const { return first != nullptr; }
};

/// What a law sees of one lane of a stage, affine in the efforts p:
///
///     measure_i = free_i + reach · (W p)_i,     lower_i and upper_i are ±∞ where a side is absent or open
///     rate_i    = rate_free_i + rate_reach · (W p)_i        (only for laws that read a rate)
///
/// p_i > 0 pushes up from the lower stop, p_i < 0 down from the upper one. The frame is that of the laboratory.
struct LaneProblem {
  int points = 0;
  DelassusColumns* delassus = nullptr;
  double reach = 0, rate_reach = 0;
  Strided<const double> free, lower, upper;
  Strided<const double> rate_free, before;  ///< absent (false) where ReducedProblem has none
  Strided<double> effort;                   ///< in: what this stage found last; out: p
};

/// What a law sees of one stage: a block of lanes with the same W. Blocks are m × lanes, lanes contiguous: point i of
/// lane l stands at i·lanes + l. lane() and memory_of() are their views.
struct ReducedProblem {
  int points = 0, lanes = 0;
  DelassusColumns* delassus = nullptr;
  double reach = 0;  ///< η π₀ ≥ 0; 0: the effort does not move the measure (explicit evaluation)
  const double* free = nullptr;
  const double* lower = nullptr;
  const double* upper = nullptr;
  double rate_reach = 0;
  const double* rate_free = nullptr;  ///< m/s
  const double* before = nullptr;  ///< the measure one step before, against the same bounds; null where there is none
  /// What the law keeps per point and lane (memory_per_point() blocks of m × lanes, one after the other), zero at
  /// first.
  double* memory = nullptr;
  double* effort = nullptr;        ///< lanes that are not in `touched` are left alone
  std::span<const int> touched;    ///< lanes whose measure, free or before, passes a bound, or that were in contact
  LaneOutcome* outcome = nullptr;  ///< per lane

  LaneProblem lane(int l) const {
    const auto of = [&](auto* block) {
      return Strided<std::remove_pointer_t<decltype(block)>>{block ? block + l : block, lanes};
    };
    return {points, delassus, reach, rate_reach, of(free), of(lower), of(upper), of(rate_free), of(before), of(effort)};
  }
  /// The kept number `which` of each point of a lane.
  Strided<double> memory_of(int l, int which = 0) const {
    return {memory + static_cast<std::ptrdiff_t>(which) * points * lanes + l, lanes};
  }
};

/// Slopes of a compliant law at one point: δp = −stiffness δg − viscosity δu − before δg⁻. They are those of the side
/// that is in contact, in the frame of (5). All ≥ 0 for a law that does not soften.
struct ContactSlopes {
  double stiffness = 0;  ///< N/m
  double viscosity = 0;  ///< N s/m
  double before = 0;     ///< N/m
};

/// Of ContactLaw::memory_per_point().
inline constexpr int most_memory = 16;
/// What a law keeps of a point that no solve has seen.
inline constexpr double nothing_kept[most_memory] = {};

/// One side of one contact point between two solves.
struct StopState {
  double depth = 0;  ///< beyond the stop, m, at least −layer
  int set = 0;       ///< number of the parameter set
  int side = 1;      ///< the sign of its efforts: 1 of the lower stop, −1 of the upper one
  /// By number, what the law keeps of the point (memory_per_point()), as its last solve left it.
  Strided<const double> memory = {nothing_kept, 1};
};

/// A contact law: it never knows the scheme, nor the scheme the law.
///
/// A law that changes the problem is shown it first, by prepare_problem(). The loop calls prepare() once (and again
/// when parameters of a lane change). At each stage that has the measure the law reads it calls solve() with the lanes
/// that are touched, then reads slopes() and the outcomes.
class ContactLaw {
 public:
  virtual ~ContactLaw() = default;

  // What the law is, asked once before anything is prepared.

  /// No contact at all: no rows of H, no box problem.
  virtual bool absent() const { return false; }
  /// Which compliance measure it reads; none: the impact measure, and the law is rigid.
  virtual std::optional<Evaluation> reads() const { return std::nullopt; }
  /// Whether rate_free is needed.
  virtual bool reads_rate() const { return false; }
  /// Whether it measures something else than displacements, or changes the stiffness: prepare_problem() is then called
  /// before prepare(), once for each law object. All lanes of such a law have the same parameters.
  virtual bool changes_problem() const { return false; }
  /// Numbers that the law keeps per point and lane from stage to stage (ReducedProblem::memory); part of a lane's
  /// state.
  virtual int memory_per_point() const { return 0; }

  // What the loop asks.

  /// Replaces `measured` and `stiffness`, the same for the same parameters; a Refusal where the structure is none for
  /// it.
  virtual std::optional<Refusal> prepare_problem(ContactStructure& /*structure*/) { return std::nullopt; }
  /// Sizes workspaces; `lanes` holds one checked parameter set per lane (only `per_lane` parameters differ).
  virtual void prepare(int points, std::span<const Parameters> lanes) = 0;
  /// Whether prepare_points() may take the place of prepare().
  virtual bool per_point() const { return false; }
  /// The same with a set for each point and lane: that of point i of lane l is the number i·lanes + l. Only parameters
  /// that have a role differ within a lane.
  virtual void prepare_points(int /*points*/, int /*lanes*/, std::span<const Parameters> /*sets*/) {
    throw std::logic_error("the law has one parameter set per lane");
  }
  /// Key of its parameter that has this role; empty: none has. The registry answers, from the declaration.
  virtual std::string parameter_of(ParameterRole /*role*/) const { return {}; }

  // A `set` below is the number of a parameter set: the lane, or after prepare_points() that of the point in its lane.

  /// Distance before the stop at which the law begins to act (m ≥ 0). The bounds that solve() sees are shifted by it.
  /// Depth and penetration stay measured at the stop.
  virtual double layer(int /*set*/) const { return 0; }
  /// Finds p for each touched lane. No allocation here.
  virtual void solve(ReducedProblem& problem) = 0;
  /// Energy (J ≥ 0) that one side stores: what its force can still give back. It is 0 at a depth of −layer, and where a
  /// law that remembers has let its point go; what no force gives back is dissipated. Rigid laws store none.
  virtual double potential(const StopState& /*at*/) const { return 0; }

  // What analyses ask: flights, exponents, spectra, references, `plan` and `describe`.

  /// The slopes of a compliant law that is linear as long as a point pushes; none: not linear, or not told. They are
  /// the same at every depth δ > 0 beyond the stop (and depth before δ⁻ > 0, where that has a slope). The force is p =
  /// stiffness δ + viscosity δ̇ + before δ⁻, the dissipation viscosity δ̇².
  virtual std::optional<ContactSlopes> linear_slopes(int /*set*/) const { return std::nullopt; }
  /// Whether slopes() are known: tangents use them; without, exponents of a compliant law are those of twins.
  virtual bool offers_slopes() const { return false; }
  /// Slopes at the last solve of a point in contact.
  virtual ContactSlopes slopes(int /*point*/, int /*lane*/) const { return {}; }
  /// Of a law that reads the measure before the step: whether its force at rest is the discrete gradient of its
  /// potential. That is p (δ − δ⁻) = U(δ) − U(δ⁻), whatever the step. A damper's force comes on top, and is
  /// dissipation.
  virtual bool conserves_energy() const { return false; }
  /// Whether a problem of that many points is solved in closed form: then no search is needed, and `plan` says so.
  virtual bool closed_form(int /*points*/) const { return false; }
  /// How solve() finds the efforts, a few words for `describe`; "" leaves it unsaid.
  virtual std::string how_solved() const { return {}; }
};

/// κ (N/m) of a compliant law whose force is κ times the depth, whatever the depth; none: rigid, damped or not linear.
/// A mean over the step has a half of κ at each of its ends.
inline std::optional<double> constant_stiffness(const ContactLaw& law, int set = 0) {
  const auto slopes = law.linear_slopes(set);
  if (!slopes || slopes->viscosity != 0) return std::nullopt;
  return slopes->stiffness + slopes->before;
}

}  // namespace ricochet
