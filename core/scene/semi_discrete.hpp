#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <algorithm>
#include <memory>
#include <optional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/history/time_history.hpp>
#include <ricochet/scene/observed_rows.hpp>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <variant>
#include <vector>

namespace ricochet {

class ContactLaw;
struct ModalBasis;

/// Counts of an assembly of the load vector.
struct LoadWork {
  double evaluations = 0, operations = 0, numbers = 0;
};

/// Assembles the load vector F_i(t) = ∫f(x,t) φ_i dx (N, N m) by 4-point Gauss quadrature per element; without
/// elements, the force f(0,t) (N) itself. Terms are assembled once, f_k into F_k by the same quadrature and a force at
/// x into φ_i(x), and then scaled: F(t) = ∫f φ dx + Σ g_k(t) F_k.
class DistributedLoad {
 public:
  DistributedLoad(const LoadSpec& load, const FiniteElementSpace& space, const AssembledStructure* assembled = nullptr);
  /// From now on QᵀF in the place of F, Q n × n̂.
  void project(std::shared_ptr<const Eigen::MatrixXd> basis);
  /// One more term: g(t) times F_k (n).
  void add(Eigen::VectorXd shape, Formula history);
  bool absent() const { return formula_.is_zero() && terms_.empty(); }
  bool constant_in_time() const { return !formula_.uses_t() && !terms_vary_; }
  /// Ω > 0 (rad/s) where F(t) = c + a sin Ωt + b cos Ωt; none where that is not so, or cannot be told.
  std::optional<double> pulsation() const;
  /// F(t) into `out` (n); no allocation. Values that are not finite are passed on, and stop the lane as diverged.
  void assemble(double t, double* out) const;

  /// F₀ (n), the formula and the terms that do not depend on t: what has a potential, −F₀ᵀq. False where there is none.
  bool assemble_steady(double* out) const;

  /// Whether there is more than terms.
  bool has_formula() const { return !formula_.is_zero(); }
  /// F(t) without the terms.
  void assemble_formula(double t, double* out) const;
  int terms() const { return static_cast<int>(terms_.size()); }
  /// F_k (n).
  const Eigen::VectorXd& shape(int k) const { return terms_[static_cast<std::size_t>(k)].shape; }
  /// What assembling F(t) takes: formulas that are evaluated, operators in these (Formula::operations) and numbers that
  /// are added up.
  LoadWork work() const;
  /// g_k(t); not finite where the formula is not.
  double scale(int k, double t) const { return terms_[static_cast<std::size_t>(k)].history.value(0, t); }

 private:
  struct Term {
    Eigen::VectorXd shape;
    Formula history;
  };
  void integrate(const Formula& load, double t, double* out) const;
  int unknowns() const { return basis_ ? static_cast<int>(basis_->cols()) : size_; }

  Formula formula_;
  std::vector<Term> terms_;
  bool terms_vary_ = false;
  std::vector<double> points_;  ///< 4 per element, or one
  mutable std::vector<double> values_;
  std::vector<std::array<int, 4>> dofs_;
  std::vector<std::array<double, 16>> weights_;  ///< per element: weight·φ_a at each Gauss point
  int size_ = 0;
  std::shared_ptr<const Eigen::MatrixXd> basis_;  ///< Q, where there is one
  mutable Eigen::VectorXd nodal_;
};

/// What a surface has of friction: μ where a point stuck in the stage before, and else. N where a force is given (N).
struct Rubbing {
  double held = 0, sliding = 0;
  std::optional<double> normal_force = {};
  double largest() const { return std::max(held, sliding); }
  bool operator==(const Rubbing&) const = default;
};

/// What the surface of a row of what rubs does beside its constant speed: share·φ(t), m.
struct SurfaceMotion {
  int row = 0;
  double share = 1;
  std::shared_ptr<const TimeHistory> history;
};

/// A surface that runs along a tangent of a stop, with or without friction: V t + φ(t), m; of a round one its rim.
struct RunningSurface {
  int row = 0;                                 ///< of SemiDiscrete::tangents, of a round one the first
  double speed = 0;                            ///< V, m/s
  std::shared_ptr<const TimeHistory> history;  ///< φ; null: none
};

/// A contact point that rubs: |p_t| ≤ μ|p_n| against u = T q' + lift − V, p_n its effort or a force that is given. A
/// round one is met in the direction n = (n₁, n₂) of its circle. Its rows are u₁, u₂ and the rim, which nothing but its
/// speed moves; of a surface that bends also r θ₁ and r θ₂. Its tangents are −n₂u₁ + n₁u₂ + rim and n₁rθ₁ + n₂rθ₂.
struct RubbingPoint {
  int point = 0;          ///< contact point, of a round one that of u₁
  int row = 0, rows = 1;  ///< of SemiDiscrete::rubbed
  bool round = false;     ///< in a clearance that is met as a circle
  Rubbing given;          ///< by the scene; lanes have their own

  int tangents() const { return round ? rows / 2 : rows; }
  /// The same but for what lanes have of their own.
  bool like(const RubbingPoint& other) const {
    return point == other.point && row == other.row && rows == other.rows && round == other.round &&
           given.normal_force.has_value() == other.given.normal_force.has_value();
  }
};

/// The semi-discrete problem for w = u − φ:
///     M q'' + C q' + K q = F(t) − φ''(t) s + Hᵀ p,     lower − φ(t) ≤ H q ≤ upper − φ(t),     C = αK + ηM
/// with s_i = ∫ρS φ_i (whatever the mass strategy). φ moves all supports and the ground of a foundation together.
/// Motions φ_j of supports by histories: w = u − Σ ψ_j φ_j, F holds −Σ s_j φ_j'', and bounds are less Σ (Hψ)_j φ_j. Of
/// a contact law that changes the problem, K is the K' and H the G of ContactStructure; `contact` stays H. With a
/// basis, q is q̂, and what is n × n, m × n or n holds in its coordinates. What supports do (static_modes,
/// support_loads) and `space` stay those of the mesh.
struct SemiDiscrete {
  FiniteElementSpace space;
  std::shared_ptr<const ModalBasis> basis;  ///< null: q are the dofs of the mesh
  Inertia inertia;
  double rigidity = 0;     ///< EI (N m²), EA (N), k (N/m)
  SparseMatrix stiffness;  ///< K, both triangles, n × n
  Damping damping;         ///< α, η
  SupportSpec support;
  Eigen::VectorXd support_shape;  ///< s (kg)
  /// Names of what holds it: supports of a beam, clamp of a beam or bar, base of an oscillator, supports of the table
  /// of dofs.
  std::vector<std::string> supports;
  /// ψ_j (n × r), K ψ_j = −K_fs e_j: the displacement of the structure at rest while support j alone is moved by 1. Its
  /// columns sum to the rigid translation, unless a foundation, whose ground stays at rest, holds the beam too.
  Eigen::MatrixXd static_modes;
  /// s_j = M ψ_j + M_fs e_j (n × r, kg) with the consistent mass whatever the strategy. A support j that accelerates by
  /// a loads the displacements relative to ψ_j by −a s_j.
  Eigen::MatrixXd support_loads;
  std::vector<double> support_x;  ///< where each holds the displacement of a beam or bar, m; NaN where it holds none
  /// Whether nothing of the structure can move rigidly, so that K is positive definite; false of an oscillator.
  bool held = false;
  SupportMotions motions;
  std::shared_ptr<const DistributedLoad> load;
  SparseRows contact;                 ///< H, m × n: displacements of the contact points
  SparseRows law_rows;                ///< G, where the law changed the problem; else empty
  SparseMatrix own_stiffness;         ///< K of the structure itself there; else empty
  std::vector<double> contact_x;      ///< position of each contact point, m
  std::vector<std::string> stops;     ///< name of each contact point's stop; empty where they have none
  std::vector<StopParameters> own;    ///< parameters of each point's stop; empty where none has its own
  std::vector<Clearance> clearances;  ///< whose rows are contact points of one name
  Eigen::VectorXd lower, upper;       ///< g1, g2 at the contact points, of a circle c ∓ r; ±∞ where absent
  Eigen::SparseMatrix<double, Eigen::RowMajor> tip;  ///< 1 × n: the displacement shown to people
  Eigen::RowVectorXd tip_on_supports;                ///< 1 × r: ψ_j there, of matrices that are given
  ObservedRows observed;                             ///< points that are shown
  ObservedRows fields;                               ///< moments (N m) and shear forces (N) there, by name
  ObservedRows tangents;                             ///< motions along surfaces of stops
  std::vector<RunningSurface> surfaces = {};         ///< along tangents
  std::vector<int> tangent_of;                       ///< row of each contact point in them, −1: none; or empty
  std::vector<RubbingPoint> rubbing;                 ///< contact points with friction
  ObservedRows rubbed;                               ///< T, their rows
  Eigen::VectorXd rubbed_speeds;                     ///< V of the surface along each of these, m/s
  std::vector<SurfaceMotion> rubbed_motions = {};    ///< what surfaces do beside it
  Eigen::VectorXd position, velocity;                ///< q₀, v₀ of w
  double projection_energy = 0;  ///< ½qᵀKq + ½vᵀMv after projection minus before (J); 0 without projection
  /// ½ rᵀZ(ZᵀKZ)⁻¹Zᵀr, r = Kq₀ − F(0) − Hᵀp(q₀), Z = Ker M: what an initial state off the constraint of a singular mass
  /// exceeds the equilibrium of its massless part by (J), and loses in the first steps at any h; 0 for a regular mass
  /// or after projection.
  double kernel_energy = 0;
  std::vector<std::string> notes;  ///< what was done that a reader should know
  /// What the law measures and pushes along: H, or G.
  const SparseRows& measured() const { return changed_by_law() ? law_rows : contact; }
  bool changed_by_law() const { return own_stiffness.rows() > 0; }
  int dofs() const { return static_cast<int>(position.size()); }
  int points() const { return static_cast<int>(contact.rows()); }
  /// The first contact point of the stop of a contact point: of a clearance its first side.
  int stop_row(int point) const {
    for (const Clearance& one : clearances)
      if (point >= one.first && point <= one.last()) return one.first;
    return point;
  }
  /// The first rows of clearances that are met as circles: their contact points are u₁ and u₂.
  std::vector<int> circles() const {
    std::vector<int> first;
    for (const Clearance& one : clearances)
      if (one.circle) first.push_back(one.first);
    return first;
  }
  /// 0, 1: the contact point is u₁ or u₂ of a circle; −1: it is on none.
  int circle_axis(int point) const {
    for (const Clearance& one : clearances)
      if (one.circle && point >= one.first && point <= one.last()) return point - one.first;
    return -1;
  }
  /// Whether a contact point is a row of a clearance.
  bool round(int point) const {
    return std::any_of(clearances.begin(), clearances.end(),
                       [&](const Clearance& one) { return point >= one.first && point <= one.last(); });
  }
  /// Whether q counts coordinates of modes.
  bool in_modes() const { return basis || (space.given && space.given->modes); }
  /// Rows on the dofs of the mesh as rows on q.
  SparseRows on_unknowns(SparseRows rows) const;
  bool damped() const { return damping.stiffness != 0 || damping.mass != 0 || damping.own(); }
  /// Whether only modes march it.
  bool asks_for_modes() const { return in_modes() || damping.by_modes(); }
};

using SemiDiscreteOrRefusal = std::variant<SemiDiscrete, Refusal>;

/// (Hψ)_j at x (m): rows of places, a column for each support. 1 at the support itself.
Eigen::MatrixXd support_shapes(const SemiDiscrete& problem, const std::vector<double>& x);

/// The share that places x (m) have of each motion, places × motions: Σ of (Hψ)_j over the supports that it moves.
Eigen::MatrixXd motion_shapes(const SemiDiscrete& problem, const std::vector<double>& x);

/// Interpolation of w = u0 − φ(0) and w_t = u1 − φ'(0): values and slopes at the free nodes into `position` and
/// `velocity`. What the clamp imposes is dropped, and a note says so when the formulas differ from it.
void interpolate_initial(const SceneSpec& scene, SemiDiscrete& problem);

/// The displacement space of the structure without contact dofs, on `elements` equal elements. A beam with supports,
/// sections or masses between its ends has the elements of beam_intervals().
FiniteElementSpace make_space(const StructureSpec& structure, int elements);

/// A structure by itself: its space, K, supports and static modes. Nothing acts on it, and it has no mass yet.
SemiDiscrete structure_alone(const StructureSpec& structure, int elements);

/// Scene × mesh × mass strategy → matrices. Throws InputError with JSON pointers into the scene ("/scene/stops/lower",
/// …) for stops that cross (lower > upper somewhere) or a clamp that the support pushes through one. The same for an
/// initial state outside the stops and formulas that give no finite value. A strategy that does not apply is a Refusal,
/// and so is a law. Without a law the problem is that of laws that do not change it.
///
/// With a law and its parameters, stops may cross, and the clamp and the initial state lie beyond them, where the law
/// pushes back (force_beyond()). Where it does not, that is a Refusal of the law.
SemiDiscreteOrRefusal discretise(const SceneSpec& scene, int elements, const MassStrategy& mass,
                                 ContactLaw* law = nullptr, const Parameters* parameters = nullptr);

/// Shows a law the problem that was discretised for one with its parameters; nothing to do for laws that do not change
/// it. Throws std::logic_error where the problem was made for another law.
void show_problem(ContactLaw& law, const SemiDiscrete& problem);

/// The checks of discretise() that need no mass and no mesh, for a study to run before any case (mesh: finest of the
/// study). `beyond`: of the law, or of any law that the scene is to be run with.
void check_scene(const SceneSpec& scene, int elements, const ForceBeyond& beyond = {});

/// Orthonormal-in-nothing basis Z (n × N) of Ker M (only for kernel_dimension > 0).
Eigen::MatrixXd mass_kernel(const Inertia& inertia);

/// M as a dense matrix, BᵀCv⁻¹B where it is kept in factors, solved for where its inverse is given. For set-up.
Eigen::MatrixXd dense_mass(const Inertia& inertia);

/// M x, through the factors or the inverse where M is not formed. For set-up, not for the marching loop.
Eigen::VectorXd apply_mass(const Inertia& inertia, const Eigen::VectorXd& x);

/// A structure at rest under its load and its stops:
///
///     K q = F + Gᵀ p,     p the force of the contact law at G q + lift, at rest
///
/// of a rigid law lower ≤ G q + lift ≤ upper ⊥ p. Where K is singular, as the limit of K + εD, D its diagonal: stops
/// that push hold the rigid motions.
struct Equilibrium {
  Eigen::VectorXd position;  ///< q, n
  Eigen::VectorXd pushed;    ///< Gᵀ p, n
};

/// `load` F (n), `lift` (m): what supports move the contact points by, less the motion of their stops. `law`: prepared
/// for one lane; null: no stops. Throws InputError at /scene/initial/equilibrium where nothing balances the load, or
/// the law finds no force.
Equilibrium equilibrium(const SemiDiscrete& problem, const Eigen::VectorXd& load, const Eigen::VectorXd& lift,
                        ContactLaw* law);

/// The lowest potential energy of the structure between its stops, J,
///
///     min over q of ½qᵀKq − Fᵀq + U(Gq + lift),     U of a compliant law; of a rigid one lower ≤ Gq + lift ≤ upper
///
/// `load` F (n) steady, lift that of supports and stops at t = 0. It is that of equilibrium(). Nothing where no stop
/// and no stiffness holds the structure against the load: then it has none.
std::optional<double> lowest_potential(const SemiDiscrete& problem, const Eigen::VectorXd& load, ContactLaw* law);

/// What supports lift each contact point by at t = 0, less what its stop moves by, m.
Eigen::VectorXd lift_at_start(const SemiDiscrete& problem);

}  // namespace ricochet
