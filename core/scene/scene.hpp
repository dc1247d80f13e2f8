#pragma once
#include <array>
#include <memory>
#include <optional>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/scene/formula.hpp>
#include <ricochet/scene/history/time_history.hpp>
#include <ricochet/scene/place.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// \file
/// What is simulated, as the study says it, in SI units. Nothing numerical is chosen here.
namespace ricochet {

/// A cross-section, reduced to what Euler–Bernoulli needs: EI (N m²) and ρS (kg/m). See section_properties().
struct Section {
  enum class Type { tube, circle, rectangle, given };
  Type type = Type::tube;
  double outer_diameter = 0, wall = 0;  ///< tube
  double diameter = 0;                  ///< circle
  double width = 0, height = 0;         ///< rectangle, bending across height
  double EI = 0, rhoS = 0;              ///< given
  double EI_z = 0;                      ///< given: EI of bending along z where it differs; 0: EI
};

struct SectionProperties {
  double EI = 0;        ///< N m²
  double rhoS = 0;      ///< kg/m
  double I = 0, S = 0;  ///< m⁴, m²; 0 of a given section
};
/// tube: I = π(D⁴ − d⁴)/64, S = π(D² − d²)/4, d = D − 2·wall; circle: I = πD⁴/64; rectangle: I = b h³/12.
SectionProperties section_properties(const Section& section, double young, double density);
/// k of kGA (Cowper 1966), m = d/D: rectangle 10(1+ν)/(12+11ν); circle 6(1+ν)/(7+6ν); tube
/// 6(1+ν)(1+m²)²/((7+6ν)(1+m²)² + (20+12ν)m²).
double shear_factor(const Section& section, double poisson);

/// C = α K + η M; or by modes, C φ_k = 2 ζ_k ω_k M φ_k on the modes of the matrices that are marched: modes without
/// mass and rigid ones have none then; or a matrix of its own.
struct Damping {
  double stiffness = 0;               ///< α, s
  double mass = 0;                    ///< η, 1/s
  std::vector<double> ratios = {};    ///< ζ_k, slowest elastic mode first
  std::optional<double> beyond = {};  ///< ζ of the modes after these

  std::shared_ptr<const SparseMatrix> matrix = {};  ///< C, n × n, both triangles

  bool by_modes() const { return !ratios.empty() || beyond; }
  /// Whether C is something else than αK + ηM.
  bool own() const { return by_modes() || matrix; }
  /// Of the elastic mode number k, from 0; of a mode that no ratio is given for, 0.
  double ratio(std::size_t k) const { return k < ratios.size() ? ratios[k] : beyond.value_or(0.0); }
  /// C on an elastic mode of unit mass, ω² its square (s⁻²) and k its number, 1/s.
  double rate(double square, std::size_t k) const;
  bool operator==(const Damping&) const = default;
};

/// What holds a beam at x. An elastic support stands on springs, whose ground end is what it holds.
struct BeamSupport {
  enum class Type { clamped, pinned, sliding, elastic };  ///< w = w' = 0; w = 0; w' = 0; springs
  std::string name;
  double x = 0;  ///< m, 0 to L
  Type type = Type::clamped;
  double stiffness = 0;                         ///< elastic: N/m, against w
  double rotation = 0;                          ///< elastic: N m/rad, against w'
  std::array<bool, 2> in_plane = {true, true};  ///< whether it holds u_y, u_z; of a beam in two planes

  bool holds_displacement() const { return type == Type::clamped || type == Type::pinned; }
  bool holds_rotation() const { return type == Type::clamped || type == Type::sliding; }
  /// Whether a motion of the support is felt: by what it holds, or through a spring.
  bool moves_beam() const { return holds_displacement() || stiffness > 0; }
};

/// A length of a beam with one section: from where the one before ends (or 0) to `to`.
struct BeamPart {
  double to = 0;  ///< m
  Section section;
  double young = 0, density = 0;
};

/// A point mass on a beam.
struct BeamMass {
  double x = 0;        ///< m, 0 to L
  double mass = 0;     ///< kg
  double inertia = 0;  ///< kg m², against rotation
};

/// Shear deformation (Timoshenko), G = E/(2(1+ν)).
struct BeamShear {
  double poisson = 0;            ///< ν
  std::optional<double> factor;  ///< k of kGA; none: shear_factor()
  bool rotary = false;           ///< whether cross-sections have inertia against rotation, ρI
};

/// A beam in bending, ρS w_tt + (EI w_xx)_xx − T w_xx + k_f w = f, each term of it with C = αK + ηM.
struct BeamSpec {
  double length = 1;
  double young = 0, density = 0;
  Section section;
  Damping damping;
  std::optional<std::vector<BeamSupport>> supports;  ///< none: clamped at 0, free at L; an end without one is free
  std::vector<BeamPart> sections;                    ///< from 0 upwards to L; empty: `section` all along
  double added_mass = 0;                             ///< kg/m, of what moves with it
  double tension = 0;                                ///< T, N; below 0 it compresses
  double foundation = 0;                             ///< k_f, N/m²
  std::vector<BeamMass> masses;
  std::optional<BeamShear> shear;  ///< none: Euler–Bernoulli
  int planes = 1;                  ///< 2: it bends along z as well (planes.hpp)
};

/// One mass on a spring and a dashpot, m w'' + c w' + k w = F cos(ωt + ψ) + load(t) − m φ''. Its only point is the tip.
struct OscillatorSpec {
  double mass = 1;       ///< m, kg
  double stiffness = 0;  ///< k, N/m; 0: a free mass
  double damping = 0;    ///< c, N s/m
  HarmonicTerm force;    ///< F cos(ωt + ψ), N
};

/// A bar in tension and compression, ρA w_tt = (EA (w + αw_t)_x)_x; its tip is the free end (x = 0 unless that is
/// fixed).
struct BarSpec {
  enum class Fixed { right, left, none };
  double length = 1;  ///< m
  double EA = 1;      ///< N
  double rhoA = 1;    ///< kg/m
  Fixed fixed = Fixed::right;
  Damping damping;
};

struct AssembledStructure;
struct Bodies;
/// A structure given by its matrices, as its files say it (assembled_structure.hpp); or several bodies, joined on a
/// mesh (bodies.hpp).
struct AssembledSpec {
  std::shared_ptr<const AssembledStructure> structure;
  Damping damping = {};
  /// The displacement shown to people; none: that of the first stop, else of the first load.
  std::optional<Place> tip = {};
  std::shared_ptr<const Bodies> bodies = {};  ///< null: files
};
using StructureSpec = std::variant<BeamSpec, OscillatorSpec, BarSpec, AssembledSpec>;
/// How it is damped; that of an oscillator is one of mass.
Damping damping_of(const StructureSpec& structure);

/// What a stop has of its own, in the place of the parameter of the law or scheme that has this role.
struct StopParameters {
  std::optional<double> stiffness = {};    ///< N/m
  std::optional<double> damping = {};      ///< N s/m
  std::optional<double> restitution = {};  ///< 1

  bool any() const { return stiffness || damping || restitution; }
  bool operator==(const StopParameters&) const = default;
};

/// Coulomb's coefficients: μ of a point that stuck in the stage before, and of one that slides.
struct FrictionSpec {
  double held = 0, sliding = 0;

  bool none() const { return held == 0 && sliding == 0; }
};

/// A row of a clearance: a side of the polygon round its circle, or of the circle itself u₁ (α = 0) or u₂ (α = π/2). It
/// bounds cos α u₁ + sin α u₂, with u₁ at its own places and u₂ at those here. Opposite sides are one row with two
/// bounds.
struct ClearanceSide {
  int number = 0;                         ///< from 0
  double angle = 0;                       ///< α, rad
  double radius = 0;                      ///< m
  int sides = 0;                          ///< of the polygon
  std::array<double, 2> offset = {0, 0};  ///< of the centre, m
  bool circle = false;                    ///< whether it is one of the two rows of the circle itself
  Place across;
  std::optional<Place> across_to = {};
};

/// A stop of its own name: lower ≤ u(at) − u(to) ≤ upper, m. The sides of a clearance have one name.
struct NamedStop {
  std::string name;  ///< letters, digits, '-' and '_'
  Place at;
  std::optional<Place> to;  ///< absent: the ground
  std::optional<double> lower, upper;
  std::string moves_with = {};  ///< the support that carries it, or all; empty: it stands still
  std::optional<TangentSpec> tangent = {}, across = {};  ///< the second one, of a stop that slides in a plane
  StopParameters own = {};
  std::shared_ptr<const MotionSpec> motion = {};  ///< of its own; null: none
  std::optional<ClearanceSide> side = {};         ///< of a clearance, whose sides follow each other
  std::size_t entry = 0;                          ///< its number in the list of the study
  std::optional<FrictionSpec> friction = {};
  std::optional<double> normal_force = {};  ///< N, of a friction damper, which has no bounds
};

/// Two rigid stops g1(x) ≤ u ≤ g2(x); a missing formula is an absent stop. Or a list of stops that have names: then
/// the rest is empty.
struct StopsSpec {
  enum class Place { nodes, tip, positions };
  std::optional<Formula> lower, upper;
  Place place = Place::nodes;
  std::vector<double> positions;  ///< m, for Place::positions, anywhere in ]0, L]
  std::vector<NamedStop> named = {};
  std::string moves_with = {};  ///< the support that carries the stops, or all; empty: they stand still

  bool any() const { return lower || upper || !named.empty(); }
};

/// φ(t) = A0 sin(ωt + ψ).
struct SupportSpec {
  double amplitude = 0;  ///< m
  double pulsation = 0;  ///< rad/s
  double phase = 0;      ///< rad
};

/// A motion φ(t) of supports, a stop or a surface, given as a function of time.
struct MotionSpec {
  enum class Gives { displacement, speed, acceleration };
  std::vector<std::string> supports;            ///< their names; empty: all
  std::shared_ptr<const TimeHistory> history;   ///< φ, m
  std::shared_ptr<const TimeTable> table = {};  ///< what it was made of; null: of something else
  Gives gives = Gives::acceleration;            ///< what the table gives of φ
  std::string component = {};                   ///< of a beam in two planes: uy or uz; empty: uy
  double period = 0;                            ///< s, after which it repeats; 0: none is declared
};

/// The word for all supports together, where a name may stand.
inline constexpr const char* all_supports = "all";

/// How one dof of a table begins.
struct DofState {
  int dof = 0;                            ///< from 1
  double displacement = 0, velocity = 0;  ///< m, m/s; of a rotation rad, rad/s
};

/// u(x,0) and u_t(x,0), absolute or from the supports as the scene's frame says.
struct InitialSpec {
  enum class Projection { none, constraint, least_squares };
  Formula displacement, velocity;
  Projection projection = Projection::none;
  std::vector<DofState> dofs = {};               ///< of matrices that are given: those that do not begin at rest at 0
  bool equilibrium = false;                      ///< the displacement is that at rest under F(0) and the stops
  bool frictionless = false;                     ///< that of stops that do not rub
  Formula displacement_z = {}, velocity_z = {};  ///< of u_z of a beam in two planes
  std::string body = {};                         ///< which this is of, among of_bodies
  std::vector<InitialSpec> of_bodies = {};       ///< of several bodies those that do not begin at rest at 0
};

/// One part of a load whose form in space stays as it is: a shape that a history scales, or a force at a point.
struct LoadTerm {
  bool force = false;                           ///< at a point
  std::optional<double> at;                     ///< where that is, m; none of an oscillator, which has one point
  Formula shape;                                ///< f(x), N/m, of what is spread
  Formula history;                              ///< g(t), 1; of a force F(t), N
  std::optional<ricochet::Place> place = {};    ///< of a force on matrices that are given; of a shape its body
  std::shared_ptr<const TimeTable> table = {};  ///< that the history was made of, where it was
  double period = 0;                            ///< s, after which a random history repeats; 0: none
  Place towards = {};                           ///< component or direction of a load on a beam; neither: uy
};

/// What pushes the structure, beside its support: a formula, and terms that are added to it.
struct LoadSpec {
  Formula formula;  ///< f(x,t), N/m; for an oscillator f(t), N
  std::vector<LoadTerm> terms;

  LoadSpec() = default;
  LoadSpec(Formula whole) : formula(std::move(whole)) {}  // NOLINT: a formula is a load
  bool is_zero() const;
  bool uses_t() const;
  bool has_point_forces() const;
  /// What is spread, f + Σ f_k(x) g_k(t), N/m. Of an oscillator every term is: then N, forces among them.
  double spread(double x, double t) const;
};

/// The structure in its N slowest modes, in the place of its mesh.
struct BasisSpec {
  int modes = 0;                    ///< N; 0: all that have mass; of bodies those of each, or of all in of_bodies
  bool residual = true;             ///< whether the static shapes of its stops stand beside them
  std::vector<int> of_bodies = {};  ///< of each body; empty: `modes` of each

  bool operator==(const BasisSpec&) const = default;
};

struct SceneSpec {
  StructureSpec structure;
  StopsSpec stops;
  SupportSpec support;
  LoadSpec load;
  InitialSpec initial;
  std::vector<MotionSpec> motions;  ///< beside `support`, which is at rest then
  /// Whether the initial state, and the displacements that are shown, count from the supports that move by `motions`.
  bool from_supports = false;
  std::vector<PointSpec> points = {};   ///< displacements that are shown; the first is where the tip is
  std::optional<BasisSpec> basis = {};  ///< none: all dofs of the mesh
  std::vector<std::string> notes = {};  ///< what was recognised in its files that a reader should know
};

/// Whether supports or stops move by histories, beside the harmonic support.
bool moves_by_histories(const SceneSpec& scene);

/// A motion by a history, where the study gives it, and what a sentence calls it ("a motion").
struct GivenMotion {
  const MotionSpec* motion = nullptr;
  std::string pointer, what;
};
/// Those of supports, stops and surfaces, each once.
std::vector<GivenMotion> given_motions(const SceneSpec& scene);

}  // namespace ricochet
