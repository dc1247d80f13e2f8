#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/basis/modal_basis.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/coincident_stops.hpp>
#include <ricochet/scene/massless_part.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/stop_parameters.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/structure/missing_residuals.hpp>
#include <ricochet/scene/supports.hpp>
#include <ricochet/scene/surfaces.hpp>
#include <ricochet/scene/whole_load.hpp>
#include <stdexcept>

namespace ricochet {

/// Fills problem.kernel_energy from the state as it is. `pushed`: Gᵀp of a compliant law that pushes in it, n; empty:
/// none does.
void measure_mass_constraint(SemiDiscrete& problem, const Eigen::VectorXd& pushed = {});

/// Brings the state onto the constraint of a singular mass. Z spans Ker M; multiplied by Zᵀ the equation of motion has
/// no inertia left (C = αK + ηM, MZ = 0):
///
///     Zᵀ(α K v + K q − F(t)) = 0,     F = load − φ'' s                                              (1)
///
/// α = 0: (1) constrains q, its time derivative v:   ZᵀK q = ZᵀF(0),  ZᵀK v = ZᵀF'(0).
/// α > 0: (1) gives the v that goes with any q; q is put at rest on it:  ZᵀK q = ZᵀF(0), then  ZᵀK v = 0.
///
/// Both by x ← x − Z(ZᵀKZ)⁻¹Zᵀ(Kx − right side), the nearest such state in the norm of K; M x is not changed. F'(0) by
/// seven forward values of the load, 2e-5 s apart (sixth order). Adds the energy it cost, and a note.
void project_on_mass_constraint(SemiDiscrete& problem);

namespace {

double energy(const SemiDiscrete& problem) {
  return 0.5 * problem.position.dot(problem.stiffness * problem.position) +
         0.5 * problem.velocity.dot(apply_mass(problem.inertia, problem.velocity));
}

Eigen::VectorXd load_rate_at_start(const DistributedLoad& load, int dofs) {
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(dofs), value(dofs);
  if (load.absent() || load.constant_in_time()) return rate;
  constexpr double spacing = 2e-5;
  constexpr std::array<double, 7> weights{-49.0 / 20, 6, -15.0 / 2, 20.0 / 3, -15.0 / 4, 6.0 / 5, -1.0 / 6};
  for (std::size_t j = 0; j < weights.size(); ++j) {
    load.assemble(static_cast<double>(j) * spacing, value.data());
    rate += weights[j] / spacing * value;
  }
  return rate;
}

void note_held(SemiDiscrete& problem, const char* what, const char* place, const char* unit, double formula,
               double imposed, double rounding) {
  if (std::abs(formula - imposed) <= rounding) return;
  problem.notes.push_back(fmt::format("the initial {} at {} is {:.6g} {}; {} imposes {:.6g} {}", what, place, formula,
                                      unit, place, imposed, unit));
}

Eigen::VectorXd load_at_start(const SemiDiscrete& problem) {
  Eigen::VectorXd load(problem.dofs());
  problem.load->assemble(0, load.data());
  return load - support_at_start(problem.support).acceleration * problem.support_shape;
}

}  // namespace

void interpolate_initial(const SceneSpec& scene, SemiDiscrete& problem) {
  const double length = structure_length(scene);
  // At rest where it has become a motion among others.
  const auto support = support_at_start(problem.support);
  problem.position.resize(problem.space.dofs);
  problem.velocity.resize(problem.space.dofs);
  const auto places = dof_places(problem.space);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto [x, slope, across] = places[i];
    const InitialSpec& initial = scene.initial;
    if (across) {
      problem.position[row] = initial_across(initial.displacement_z, places[i], length);
      problem.velocity[row] = initial_across(initial.velocity_z, places[i], length);
      continue;
    }
    // The last node, i·(L/N), may lie an ulp beyond the end.
    problem.position[row] =
        slope ? initial.displacement.slope(std::min(x, length), 0, length) : initial.displacement(x) - support.position;
    problem.velocity[row] =
        slope ? initial.velocity.slope(std::min(x, length), 0, length) : initial.velocity(x) - support.velocity;
  }
  if (const auto* spec = std::get_if<AssembledSpec>(&scene.structure)) {
    problem.position = initial_dofs(*spec->structure, scene.initial, &DofState::displacement);
    problem.velocity = initial_dofs(*spec->structure, scene.initial, &DofState::velocity);
    if (const JoinedBodies* bodies = bodies_of(scene.structure)) begin_bodies(*bodies, scene.initial, problem);
    if (problem.support.amplitude != 0) {
      const Eigen::VectorXd lift = problem.static_modes.rowwise().sum();
      problem.position -= support.position * lift;
      problem.velocity -= support.velocity * lift;
    }
  }
  const SupportMotions& motions = problem.motions;
  if (!motions.empty() && !motions.from_supports)
    for (std::size_t k = 0; k < motions.histories.size(); ++k)
      for (const std::size_t j : motions.supports[k]) {
        const auto mode = problem.static_modes.col(static_cast<Eigen::Index>(j));
        problem.position -= motions.histories[k]->value(0) * mode;
        problem.velocity -= motions.histories[k]->rate(0) * mode;
      }
  const std::vector<HeldPlace> held = held_places(scene);
  if (held.empty() || !motions.empty()) return;
  const double size = problem.position.lpNorm<Eigen::Infinity>() + std::abs(support.position);
  const double rate = problem.velocity.lpNorm<Eigen::Infinity>() + std::abs(support.velocity);
  // Values are rounded to 1e-16; slopes come from a stencil of length/256.
  for (const auto& [x, displacement, rotation, name] : held) {
    const char* at = name.c_str();
    if (displacement) {
      note_held(problem, "displacement", at, "m", scene.initial.displacement(x), support.position, 1e-12 * size);
      note_held(problem, "velocity", at, "m/s", scene.initial.velocity(x), support.velocity, 1e-12 * rate);
    }
    if (!rotation) continue;
    note_held(problem, "slope", at, "rad", scene.initial.displacement.slope(x, 0, length), 0,
              1e-10 * (size + size / length));
    note_held(problem, "rate of slope", at, "rad/s", scene.initial.velocity.slope(x, 0, length), 0,
              1e-10 * (rate + rate / length));
  }
}

void measure_mass_constraint(SemiDiscrete& problem, const Eigen::VectorXd& pushed) {
  if (problem.inertia.kernel_dimension == 0) return;
  const MasslessPart massless(problem.stiffness, problem.inertia);
  Eigen::VectorXd residual = problem.stiffness * problem.position - load_at_start(problem);
  if (pushed.size() > 0) residual -= pushed;
  problem.kernel_energy = massless.energy(residual);
}

void project_on_mass_constraint(SemiDiscrete& problem) {
  if (problem.inertia.kernel_dimension == 0) {
    problem.notes.emplace_back("projection of the initial state: nothing to do, the mass is regular");
    return;
  }
  const Eigen::VectorXd load = load_at_start(problem);
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(problem.dofs());
  if (problem.damping.stiffness == 0)
    rate = load_rate_at_start(*problem.load, problem.dofs()) -
           support_at_start(problem.support).jerk * problem.support_shape;

  const MasslessPart massless(problem.stiffness, problem.inertia);
  const auto project = [&](Eigen::VectorXd& state, const Eigen::VectorXd& right) {
    state -= massless.response(problem.stiffness * state - right);
  };
  const double before = energy(problem);
  project(problem.position, load);
  project(problem.velocity, rate);
  problem.projection_energy = energy(problem) - before;
  problem.notes.push_back(
      fmt::format("projection of the initial state on the constraint of the singular mass: energy "
                  "from {:.6g} J to {:.6g} J",
                  before, before + problem.projection_energy));
}

Eigen::VectorXd lift_at_start(const SemiDiscrete& problem) {
  Eigen::VectorXd lift = Eigen::VectorXd::Constant(problem.points(), support_at_start(problem.support).position);
  for (int i = 0; i < problem.points(); ++i) lift[i] += problem.motions.point(i, 0);
  return lift;
}

namespace {

// The structure itself, before any law.
ContactStructure structure_of(const SemiDiscrete& problem) {
  return {.space = &problem.space,
          .rigidity = problem.rigidity,
          .contact = &problem.contact,
          .measured = problem.contact,
          .stiffness = problem.changed_by_law() ? problem.own_stiffness : problem.stiffness};
}

std::optional<Refusal> change_by(ContactLaw& law, SemiDiscrete& problem) {
  ContactStructure structure = structure_of(problem);
  if (auto refusal = law.prepare_problem(structure)) return refusal;
  problem.own_stiffness = std::move(problem.stiffness);
  problem.stiffness = std::move(structure.stiffness);
  problem.law_rows = std::move(structure.measured);
  problem.stiffness.makeCompressed();
  problem.law_rows.makeCompressed();
  return std::nullopt;
}

// The columns of H that are not zero.
std::vector<int> touched_dofs(const SparseRows& contact) {
  std::vector<int> dofs;
  for (int i = 0; i < contact.outerSize(); ++i)
    for (SparseRows::InnerIterator it(contact, i); it; ++it)
      if (it.value() != 0) dofs.push_back(static_cast<int>(it.col()));
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
  return dofs;
}

// Rows of points that have a bound; the others are empty.
SparseRows bounded_rows(const SparseRows& contact, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  SparseRows rows = contact;
  rows.prune([&](Eigen::Index i, Eigen::Index, double) { return std::isfinite(lower[i]) || std::isfinite(upper[i]); });
  return rows;
}

void check_start(const SemiDiscrete& problem, const std::string& pointer, const std::string& what,
                 const ForceBeyond& beyond) {
  const Eigen::VectorXd absolute = problem.contact * problem.position + lift_at_start(problem);
  check_between_stops(problem.contact_x, absolute, problem.lower, problem.upper, pointer, what, beyond, problem.stops,
                      problem.circles());
}

/// Gᵀp of a compliant law that pushes in the initial state; empty where none does.
Eigen::VectorXd pushed_at_start(ContactLaw& law, const Parameters& parameters, const SemiDiscrete& problem) {
  const int points = problem.points();
  if (points == 0 || law.absent() || !law.reads()) return {};
  prepare_law(law, points, {&parameters, 1}, problem.own);
  const Eigen::VectorXd place = problem.measured() * problem.position + lift_at_start(problem);
  const bool own = sets_per_point(law, problem.own);
  Eigen::VectorXd lower = problem.lower, upper = problem.upper;
  for (int i = 0; i < points; ++i) {
    const double layer = law.layer(own ? i : 0);
    lower[i] += layer;
    upper[i] -= layer;
  }
  const std::vector<double> force =
      standing_force(law, {points, 1, place.data(), lower.data(), upper.data(), problem.circles()});
  const Eigen::Map<const Eigen::VectorXd> p(force.data(), points);
  if (p.isZero(0)) return {};
  return problem.measured().transpose() * p;
}

InertiaOrRefusal build_mass(const SemiDiscrete& problem, const MassStrategy& mass) {
  if (!problem.in_modes()) {
    if (!problem.space.across.empty()) return mass_by_plane(mass, problem.space);
    if (problem.space.given && !mass.takes_given())
      return Refusal{
          "this mass is made of velocities on elements, and an assembled structure has matrices alone: use consistent "
          "or another mass that takes matrices"};
    return mass.build(problem.space);
  }
  if (!mass.takes_modes())
    return Refusal{
        "a structure in modes has the mass of its modes: use consistent or singular, or leave mesh.modes out"};
  if (!problem.basis) return mass.build(problem.space);
  FiniteElementSpace space;
  space.structure = problem.space.structure;
  space.basis = FiniteElementSpace::Basis::linear;
  space.dofs = problem.basis->dofs();
  space.given = GivenMass{.mass = problem.basis->mass,
                          .modes = true,
                          .attached = problem.basis->stops(),
                          .attached_mass = !problem.space.given || problem.space.given->attached_mass};
  space.contact_dofs = touched_dofs(SparseRows(problem.basis->at_points.topRows(problem.points()).sparseView()));
  return mass.build(space);
}

// What was made on the dofs of the mesh, in the coordinates of the basis.
void march_in_basis(const SceneSpec& scene, const SparseMatrix& mass, const SparseRows& pushed, SemiDiscrete& problem,
                    DistributedLoad& load) {
  const ModalBasis& basis = *problem.basis;
  const bool least_squares = scene.initial.projection == InitialSpec::Projection::least_squares;
  for (Eigen::VectorXd* state : {&problem.position, &problem.velocity})
    *state = least_squares ? in_basis_by_least_squares(basis, *state) : in_basis(basis, mass, pushed, *state);
  SparseMatrix stiffness(basis.dofs(), basis.dofs());
  for (int i = 0; i < basis.dofs(); ++i) stiffness.insert(i, i) = basis.stiffness[i];
  stiffness.makeCompressed();
  problem.stiffness = std::move(stiffness);
  if (const auto& C = problem.damping.matrix) {
    const Eigen::MatrixXd damping = basis.shapes.transpose() * (*C * basis.shapes);
    problem.damping.matrix =
        std::make_shared<const SparseMatrix>(((damping + damping.transpose()) / 2).eval().sparseView());
  }
  problem.contact = basis.at_points.topRows(problem.points()).sparseView();
  for (SparseRows* rows :
       {&problem.tip, &problem.observed.rows, &problem.fields.rows, &problem.tangents.rows, &problem.rubbed.rows})
    *rows = problem.on_unknowns(std::move(*rows));
  problem.support_shape = basis.shapes.transpose() * problem.support_shape;
  load.project({problem.basis, &basis.shapes});
}

void take_points(const ContactPoints& points, const SceneSpec& scene, SemiDiscrete& problem) {
  problem.contact_x = points.x;
  problem.contact = points.rows;
  problem.stops = points.names;
  problem.own = points.own;
  problem.lower = points.lower;
  problem.upper = points.upper;
  problem.clearances = clearances_of(scene.stops);
  problem.space.contact_dofs = touched_dofs(bounded_rows(problem.contact, points.lower, points.upper));
}

// Modes of the structure, where it marches in them, and the mass matrix that is chosen.
std::optional<Refusal> give_inertia(const SceneSpec& scene, const MassStrategy& mass, const SparseMatrix& whole,
                                    const SparseRows& pushed_rows, SemiDiscrete& problem) {
  const JoinedBodies* bodies = bodies_of(scene.structure);
  if (scene.basis)
    problem.basis =
        bodies ? std::make_shared<const ModalBasis>(join_bases(*bodies, problem, whole, pushed_rows, *scene.basis))
               : shared_basis(problem.stiffness, whole, pushed_rows, problem.held, *scene.basis);
  const auto build = [&](const SemiDiscrete& structure) { return build_mass(structure, mass); };
  auto built = bodies ? join_masses(*bodies, problem, build) : build(problem);
  if (auto* refusal = std::get_if<Refusal>(&built)) return *refusal;
  problem.inertia = std::get<Inertia>(std::move(built));
  problem.inertia.mass.makeCompressed();
  problem.stiffness.makeCompressed();
  return std::nullopt;
}

// Where the tip is, unless a person would know.
void note_tip(const SceneSpec& scene, SemiDiscrete& problem) {
  if (const std::string chosen = tip_choice(scene); !chosen.empty()) problem.notes.push_back("the tip is " + chosen);
  if (shown_position(scene) != structure_length(scene) && std::holds_alternative<BeamSpec>(scene.structure))
    problem.notes.push_back(
        fmt::format("the displacement shown as that of the tip is at x = {:.6g} m", shown_position(scene)));
}

// The state at t = 0, checked. `still`: F(0) before supports accelerate; `law`: null where none decides.
std::optional<Refusal> begin(const InitialSpec& initial, const Eigen::VectorXd& still, const ForceBeyond& beyond,
                             ContactLaw* law, const Parameters* parameters, SemiDiscrete& problem) {
  Eigen::VectorXd pushed;
  if (initial.equilibrium) {
    if (law) prepare_law(*law, std::max(1, problem.points()), {parameters, 1}, problem.own);
    Equilibrium found = equilibrium(problem, still, lift_at_start(problem), law);
    check_rest(initial, found, problem);
    problem.position = std::move(found.position);
    if (!found.pushed.isZero(0)) pushed = std::move(found.pushed);
  }
  // A law that lets points rest somewhere lets them start there.
  if (!initial.equilibrium || !law)
    check_start(problem, "/scene/initial/displacement", "the initial displacement", beyond);
  if (!initial.equilibrium && law && problem.inertia.kernel_dimension > 0)
    pushed = pushed_at_start(*law, *parameters, problem);
  if (initial.projection != InitialSpec::Projection::constraint) {
    measure_mass_constraint(problem, pushed);
    return std::nullopt;
  }
  if (pushed.size() > 0)
    return Refusal{
        "the initial state lies beyond a stop, whose force the projection does not know; expected a state "
        "between the stops, or no projection"};
  project_on_mass_constraint(problem);
  check_start(problem, "/scene/initial/projection", "the projected initial displacement", beyond);
  return std::nullopt;
}

}  // namespace

SemiDiscreteOrRefusal discretise(const SceneSpec& shared, int elements, const MassStrategy& mass, ContactLaw* law,
                                 const Parameters* parameters) try {
  // Formulas keep their variables inside: evaluate our own copies.
  SceneSpec scene = on_mesh(shared, elements);
  const bool acts = law && !law->absent(), compliant = acts && law->reads();
  if (compliant) scene.stops = with_circles(std::move(scene.stops));
  const bool law_decides = law && parameters;
  // A law that changes the problem knows its force once it has.
  ForceBeyond beyond;
  if (law_decides) beyond = law->changes_problem() ? anywhere_beyond() : force_beyond(*law, *parameters);
  check_scene(scene, elements, beyond);
  const bool rigid = acts && !compliant;
  if (rigid)
    if (auto refusal = refuse_polygon(scene.stops)) return *refusal;

  SemiDiscrete problem = structure_alone(scene.structure, elements);
  problem.notes.insert(problem.notes.begin(), scene.notes.begin(), scene.notes.end());
  const ContactPoints points = contact_points(scene, problem.space, elements);
  take_points(points, scene, problem);
  if (rigid)
    for (std::string& note : polygon_notes(problem.clearances)) problem.notes.push_back(std::move(note));
  problem.support = scene.support;
  // The modes of K with the consistent or given mass, whatever mass is marched.
  const SparseMatrix whole = scene.basis ? consistent_mass(problem.space) : SparseMatrix();
  const SparseRows pushed_rows = scene.basis ? pushed_rows_of(scene, problem) : SparseRows();
  if (auto refusal = give_inertia(scene, mass, whole, pushed_rows, problem)) return *refusal;

  const auto* assembled = std::get_if<AssembledSpec>(&scene.structure);
  auto load = std::make_shared<DistributedLoad>(whole_load(scene), problem.space,
                                                assembled ? assembled->structure.get() : nullptr);
  show_tip(scene, problem);
  note_tip(scene, problem);
  Eigen::VectorXd still;  // F(0), before supports accelerate
  if (scene.initial.equilibrium) load->assemble(0, (still.resize(problem.space.dofs), still.data()));
  add_support(scene, points.on_supports, problem, *load);
  observe_rows(scene, problem);
  for (std::string& note : missing_residuals(scene, problem.space)) problem.notes.push_back(std::move(note));
  if (law_decides && rigid)
    if (auto refusal = keep_nearest_bounds(problem)) return *refusal;
  interpolate_initial(scene, problem);
  if (problem.basis) march_in_basis(scene, whole, pushed_rows, problem, *load);
  if (const JoinedBodies* bodies = bodies_of(scene.structure); bodies && problem.damping.matrix)
    problem.damping.matrix = std::make_shared<const SparseMatrix>(join_dampings(*bodies, problem));
  problem.load = std::move(load);
  if (law && law->changes_problem() && problem.points() > 0) {
    if (auto refusal = change_by(*law, problem)) return *refusal;
    if (law_decides) beyond = force_beyond(*law, *parameters);
  }
  if (problem.basis && scene.initial.equilibrium) still = problem.basis->shapes.transpose() * still;
  if (auto refusal = begin(scene.initial, still, beyond, law_decides ? law : nullptr, parameters, problem))
    return *refusal;
  return problem;
} catch (const BeyondStop& error) {
  if (!law || !parameters) throw;
  return Refusal{error.what()};
}

SparseRows SemiDiscrete::on_unknowns(SparseRows rows) const {
  return basis ? SparseRows((rows * basis->shapes).sparseView()) : std::move(rows);
}

void show_problem(ContactLaw& law, const SemiDiscrete& problem) {
  if (problem.points() == 0 || law.absent() || (!law.changes_problem() && !problem.changed_by_law())) return;
  ContactStructure structure = structure_of(problem);
  const bool refused = law.changes_problem() && law.prepare_problem(structure).has_value();
  const bool same = !refused && problem.changed_by_law() && law.changes_problem() &&
                    (structure.stiffness - problem.stiffness).squaredNorm() == 0 &&
                    (structure.measured - problem.law_rows).squaredNorm() == 0;
  if (!same) throw std::logic_error("the problem was discretised for another contact law");
}

}  // namespace ricochet
