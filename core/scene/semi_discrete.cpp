#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/algebra/infinity.hpp>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/initial.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/start_force.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

void add_stiffness(const BeamSpec& beam, SemiDiscrete& problem) {
  problem.rigidity = section_properties(beam.section, beam.young, beam.density).EI;
  problem.stiffness = bending_stiffness(problem.space, problem.rigidity);
  problem.damping = beam.damping;
}
void add_stiffness(const BarSpec& bar, SemiDiscrete& problem) {
  problem.rigidity = bar.EA;
  problem.stiffness = axial_stiffness(problem.space, bar.EA);
  problem.damping = bar.damping;
}
void add_stiffness(const OscillatorSpec& oscillator, SemiDiscrete& problem) {
  problem.rigidity = oscillator.stiffness;
  problem.stiffness.resize(1, 1);
  problem.stiffness.insert(0, 0) = oscillator.stiffness;
  problem.stiffness.makeCompressed();
  problem.damping.mass = oscillator.damping / oscillator.mass;
}

// An oscillator's harmonic force is one more term of its load.
LoadSpec whole_load(const SceneSpec& scene) {
  LoadSpec load = scene.load;
  const auto* oscillator = std::get_if<OscillatorSpec>(&scene.structure);
  if (!oscillator || oscillator->force.amplitude == 0) return load;
  const auto& force = oscillator->force;
  if (force.pulsation == 0 && !load.formula.uses_t())
    load.formula = Formula(load.formula(0) + force.amplitude * std::cos(force.phase));
  else
    load.terms.push_back(
        {.force = true,
         .at = std::nullopt,
         .shape = Formula(),
         .history = Formula(fmt::format("({})*cos(({})*t + ({}))", force.amplitude, force.pulsation, force.phase),
                            "/scene/structure/force", "t")});
  return load;
}

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

void check_start(const SemiDiscrete& problem, const std::string& pointer, const std::string& what,
                 const ForceBeyond& beyond) {
  const double support = support_at_start(problem.support).position;
  const Eigen::VectorXd absolute = (problem.contact * problem.position).array() + support;
  check_between_stops(problem.contact_x, absolute, problem.lower, problem.upper, pointer, what, beyond);
}

/// Gᵀp of a compliant law that pushes in the initial state; empty where none does.
Eigen::VectorXd pushed_at_start(ContactLaw& law, const Parameters& parameters, const SemiDiscrete& problem) {
  const int points = problem.points();
  if (points == 0 || law.absent() || !law.reads()) return {};
  law.prepare(points, {&parameters, 1});
  const double layer = law.layer(0);
  const Eigen::VectorXd place =
      (problem.measured() * problem.position).array() + support_at_start(problem.support).position;
  const Eigen::VectorXd lower = problem.lower.array() + layer, upper = problem.upper.array() - layer;
  const std::vector<double> force = standing_force(law, {points, 1, place.data(), lower.data(), upper.data()});
  const Eigen::Map<const Eigen::VectorXd> p(force.data(), points);
  if (p.isZero(0)) return {};
  return problem.measured().transpose() * p;
}

}  // namespace

SemiDiscreteOrRefusal discretise(const SceneSpec& shared, int elements, const MassStrategy& mass, ContactLaw* law,
                                 const Parameters* parameters) try {
  const SceneSpec scene = shared;  // formulas keep their variables inside: evaluate our own copies
  const bool law_decides = law && parameters;
  // A law that changes the problem knows its force once it has.
  ForceBeyond beyond;
  if (law_decides) beyond = law->changes_problem() ? anywhere_beyond() : force_beyond(*law, *parameters);
  check_scene(scene, elements, beyond);

  SemiDiscrete problem;
  problem.space = make_space(scene.structure, elements);
  problem.contact_x = contact_positions(scene, elements);
  problem.contact = displacement_rows(problem.space, problem.contact_x);
  problem.space.contact_dofs = touched_dofs(problem.contact);
  auto built = mass.build(problem.space);
  if (auto* refusal = std::get_if<Refusal>(&built)) return *refusal;
  problem.inertia = std::get<Inertia>(std::move(built));

  std::visit([&](const auto& structure) { add_stiffness(structure, problem); }, scene.structure);
  problem.support = scene.support;
  problem.support_shape = rigid_motion_load(problem.space);
  problem.load = std::make_shared<const DistributedLoad>(whole_load(scene), problem.space);

  problem.lower = stop_values(scene.stops.lower, problem.contact_x, -infinity);
  problem.upper = stop_values(scene.stops.upper, problem.contact_x, infinity);
  problem.tip = displacement_rows(problem.space, {tip_position(scene)});
  if (law && law->changes_problem() && problem.points() > 0) {
    if (auto refusal = change_by(*law, problem)) return *refusal;
    if (law_decides) beyond = force_beyond(*law, *parameters);
  }

  interpolate_initial(scene, problem);
  check_start(problem, "/scene/initial/displacement", "the initial displacement", beyond);
  Eigen::VectorXd pushed;
  if (law_decides && problem.inertia.kernel_dimension > 0) pushed = pushed_at_start(*law, *parameters, problem);
  if (scene.initial.projection == InitialSpec::Projection::constraint) {
    if (pushed.size() > 0)
      return Refusal{
          "the initial state lies beyond a stop, whose force the projection does not know; expected a state "
          "between the stops, or no projection"};
    project_on_mass_constraint(problem);
    check_start(problem, "/scene/initial/projection", "the projected initial displacement", beyond);
  } else {
    measure_mass_constraint(problem, pushed);
  }
  return problem;
} catch (const BeyondStop& error) {
  if (!law || !parameters) throw;
  return Refusal{error.what()};
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
