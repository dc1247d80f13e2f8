// What references cost, for a forecast.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <ricochet/loader/child.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/supports.hpp>
#include <ricochet/scene/whole_load.hpp>
#include <set>

#include "runners/kinds/comparison/references.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {
namespace {

// Seconds that all solutions together may be tried for, and one of them. One that is not done by then counts as if it
// had been.
constexpr double enough_trying = 1, longest_trial = 2;
// Shares of the duration that are solved: what the second adds to the first, the rest will add as well.
constexpr double first_share = 0.125, second_share = 0.25;
const std::string refused = "refused: ";  // what a child says of a reference that does not apply begins so

StudyCase beginning_of(const StudyCase& study_case, double share) {
  StudyCase part = study_case;
  part.duration = share * study_case.duration;
  part.samples = std::max(1, static_cast<int>(share * study_case.samples));
  return part;
}

}  // namespace

std::vector<References::Aside> References::marches(const std::vector<const StudyCase*>& cases) const {
  std::vector<Aside> found;
  std::set<std::string> known;
  const bool several = finest_ != coarsest_;
  for (const StudyCase* one : cases) {
    for (const MethodChoice& choice : one->references) {
      if (choice.name != marched_reference || !known.insert(key(*one, choice)).second) continue;
      const double least = one->duration / smallest_step_, elements = std::max(1, one->elements);
      found.push_back({one, (4 + 8) * least, several ? 2 * finest_ / elements : 1});
      if (several) found.push_back({one, 4 * least, finest_ / elements});
    }
    const Json twin = {{"scene", one->scene_json}, {"elements", one->elements}};
    if (!one->settings.contains("horizon") && known.insert(twin.dump()).second)
      found.push_back({one, 2 * one->duration / one->step, 1});
  }
  return found;
}

References::Solutions References::solutions(const std::vector<const StudyCase*>& cases) const {
  Solutions found;
  std::set<std::string> known;
  std::map<std::string, std::vector<double>> tried;  // by name
  std::map<std::string, std::size_t> untried;
  double spent = 0;
  for (const StudyCase* one : cases)
    for (const MethodChoice& choice : one->references) {
      if (choice.name == marched_reference || !known.insert(key(*one, choice)).second) continue;
      if (spent > enough_trying) {
        ++untried[choice.name];
        found.may_apply = true;
        continue;
      }
      const auto begun = std::chrono::steady_clock::now();
      // A reference may be anybody's library, and never return.
      const ChildOutcome outcome = run_in_child(
          [&] {
            const std::atomic<bool> stop = false;
            double seconds[2] = {};
            for (const int k : {0, 1}) {
              const double begin = thread_seconds();
              const KnownReference part =
                  compute(beginning_of(*one, k == 0 ? first_share : second_share), choice, stop);
              if (!part.refusal.empty()) return refused + part.refusal.text;
              seconds[k] = thread_seconds() - begin;
            }
            const double more = std::max(0.0, seconds[1] - seconds[0]) / (second_share - first_share);
            return fmt::format("{} {}", seconds[0] + seconds[1], seconds[1] + (1 - second_share) * more);
          },
          longest_trial);
      double trial = longest_trial, seconds = longest_trial / (first_share + second_share);
      if (outcome.ok() && outcome.text.starts_with(refused)) {
        found.refusals.insert(choice.name + ": " + outcome.text.substr(refused.size()));
        spent += seconds_since(begun);
        continue;
      }
      found.may_apply = true;
      if (outcome.ok()) {
        char* rest = nullptr;
        trial = std::strtod(outcome.text.c_str(), &rest);
        seconds = std::strtod(rest, nullptr);
      } else if (outcome.end != ChildOutcome::End::timeout) {
        continue;  // told in the rows of its cases
      }
      spent += trial;
      found.seconds += seconds;
      tried[choice.name].push_back(seconds);
    }
  for (const auto& [name, count] : untried) {
    double sum = 0;
    for (const double seconds : tried[name]) sum += seconds;
    found.seconds +=
        tried[name].empty() ? 0 : sum / static_cast<double>(tried[name].size()) * static_cast<double>(count);
  }
  return found;
}

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::function<double(double)> of_x(const Formula& formula) {
  return [formula](double x) { return formula(x); };
}
std::function<double(double)> of_x(const std::optional<Formula>& formula, double absent) {
  if (!formula) return [absent](double) { return absent; };
  return of_x(*formula);
}

/// The bounds of stops that have names, at their places.
std::function<double(double)> of_stops(const std::vector<NamedStop>& stops, std::optional<double> NamedStop::*bound,
                                       double absent) {
  return [=](double x) {
    for (const NamedStop& stop : stops)
      if (stop.at.x == x) return (stop.*bound).value_or(absent);
    return absent;
  };
}

void describe(const BeamSpec& beam, ReferenceProblem& problem) {
  problem.other_beam = beam.supports || !beam.sections.empty() || !beam.masses.empty() || beam.shear ||
                       beam.tension != 0 || beam.foundation != 0 || beam.added_mass != 0 || beam.planes == 2;
  const SectionProperties section = uniform_parts(beam).front().section;
  problem.structure = "beam";
  problem.length = beam.length;
  problem.stiffness = section.EI;
  problem.inertia = section.rhoS;
  problem.left_fixed = !problem.other_beam;
}
void describe(const BarSpec& bar, ReferenceProblem& problem) {
  problem.structure = "bar";
  problem.length = bar.length;
  problem.stiffness = bar.EA;
  problem.inertia = bar.rhoA;
  problem.left_fixed = bar.fixed == BarSpec::Fixed::left;
  problem.right_fixed = bar.fixed == BarSpec::Fixed::right;
}
void describe(const OscillatorSpec& oscillator, ReferenceProblem& problem) {
  problem.structure = "oscillator";
  problem.stiffness = oscillator.stiffness;
  problem.inertia = oscillator.mass;
  problem.force_amplitude = oscillator.force.amplitude;
  problem.force_pulsation = oscillator.force.pulsation;
  problem.force_phase = oscillator.force.phase;
}

void describe(const AssembledSpec&, ReferenceProblem& problem) {
  problem.structure = "assembled structure";
}

}  // namespace

ReferenceProblem reference_problem(const StudyCase& study_case, const Registry& registry) {
  const SceneSpec& scene = study_case.scene;
  ReferenceProblem problem;
  std::visit([&](const auto& structure) { describe(structure, problem); }, scene.structure);
  const Damping damping = damping_of(scene.structure);
  problem.damping_stiffness = damping.stiffness;
  problem.damping_mass = damping.mass;
  problem.support_amplitude = scene.support.amplitude;
  problem.support_pulsation = scene.support.pulsation;
  problem.support_phase = scene.support.phase;
  // The force of one oscillator is described beside its load.
  const LoadSpec load_of_all = problem.structure == "oscillator" ? scene.load : whole_load(scene);
  problem.load_zero = load_of_all.is_zero();
  problem.load_constant = !load_of_all.uses_t();
  problem.load = [load = load_of_all](double x, double t) { return load.spread(x, t); };
  problem.displacement = of_x(scene.initial.displacement);
  problem.velocity = of_x(scene.initial.velocity);
  problem.projected = scene.initial.projection == InitialSpec::Projection::constraint;
  problem.stop_places = contact_positions(scene, study_case.elements);
  problem.stops_at_nodes = scene.stops.place == StopsSpec::Place::nodes && problem.structure != "oscillator";
  problem.stops_at_tip = problem.stop_places.size() == 1 &&
                         std::abs(problem.stop_places[0] - tip_position(scene)) <= 1e-12 * problem.length;
  problem.lower = scene.stops.named.empty() ? of_x(scene.stops.lower, -infinity)
                                            : of_stops(scene.stops.named, &NamedStop::lower, -infinity);
  problem.upper = scene.stops.named.empty() ? of_x(scene.stops.upper, infinity)
                                            : of_stops(scene.stops.named, &NamedStop::upper, infinity);
  if (std::any_of(scene.stops.named.begin(), scene.stops.named.end(), [](const auto& stop) { return stop.to; }))
    problem.structure = "structure with a stop between two places";
  auto law = make_law(study_case, registry);
  problem.contact_absent = law->absent();
  if (law->reads()) {
    const Parameters parameters = study_case.contact.parameters;
    law->prepare(std::max<int>(1, static_cast<int>(problem.stop_places.size())), {&parameters, 1});
    const auto stiffness = constant_stiffness(*law);
    problem.contact_nonlinear = !stiffness;
    problem.contact_stiffness = stiffness.value_or(0);
  }
  problem.restitution = scheme_restitution(study_case, registry).value_or(0);
  return problem;
}

bool meets_own_stops(const StudyCase& study_case, bool of_the_mesh) {
  return of_the_mesh || std::holds_alternative<OscillatorSpec>(study_case.scene.structure);
}

std::variant<ReferenceProblem, Refusal> seen_by_reference(const StudyCase& study_case, const Registry& registry,
                                                          bool of_the_mesh) {
  if (!of_the_mesh && study_case.scene.load.has_point_forces())
    return Refusal{
        "the load has a force at a point, and this reference knows loads that are spread: use a reference of the mesh"};
  if (damping_of(study_case.scene.structure).own())
    return Refusal{"damping is not made of K and M, and references know C = αK + ηM: use the reference self"};
  if (std::any_of(study_case.scene.stops.named.begin(), study_case.scene.stops.named.end(),
                  [](const NamedStop& stop) { return stop.own.any(); }))
    return Refusal{"stops have parameters of their own, and references know one set for all: use the reference self"};
  if (moves_by_histories(study_case.scene) || support_bends(study_case.scene))
    return Refusal{
        "supports or stops move by motions, and references know the harmonic support: use the reference self"};
  if (std::any_of(study_case.scene.stops.named.begin(), study_case.scene.stops.named.end(),
                  [](const NamedStop& stop) { return stop.side.has_value(); }) &&
      make_law(study_case, registry)->reads())
    return Refusal{
        "a compliant law meets the circle of a clearance, and references know stops along rows: use the reference "
        "self"};
  ReferenceProblem problem = reference_problem(study_case, registry);
  if (meets_own_stops(study_case, of_the_mesh)) return problem;
  // A continuum meets rigid stops; its point of contact has no mass, and no coefficient acts on it.
  problem.contact_stiffness = 0;
  problem.contact_nonlinear = false;
  problem.restitution = 0;
  return problem;
}

}  // namespace ricochet
