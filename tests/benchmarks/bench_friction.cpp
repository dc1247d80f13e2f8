// What friction costs. A tube in two planes rubs along uz at two stops, at the places of those in
// tests/engine/friction_tubes.cpp, or at 24. Microseconds per step beside the same scene without friction, and with
// stops out of reach: the march alone, and as a trajectory has it, with audit, contacts and wear. Medians of
// interleaved rounds, with their range.
//
//     bench_friction [--rounds N]
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/contact/friction_watch.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/contact/stop_contacts.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

struct Case {
  const char* scene;
  const char* law;
  const char* scheme;
  int stops = 2;
  bool rubs = false, reached = true;
  int steps = 0;
  std::vector<double> alone = {}, watched = {};  // µs per step
  bool ran = true;
};

LoadTerm pushes(double x, const char* component, const char* history) {
  LoadTerm term;
  term.force = true;
  term.at = x;
  term.towards.component = component;
  term.history = Formula(history, "", "t");
  return term;
}

// L 1.2 m, EI 90 N m², ρS 0.8 kg/m, two planes; stops below along uy, spread over the outer half.
SceneSpec tube(const Case& one) {
  BeamSpec beam;
  beam.length = 1.2;
  beam.young = beam.density = 1;
  beam.section.type = Section::Type::given;
  beam.section.EI = 90;
  beam.section.rhoS = 0.8;
  beam.damping = {.stiffness = 2e-4, .mass = 0.6};
  beam.planes = 2;
  SceneSpec scene;
  scene.structure = beam;
  for (int i = 0; i < one.stops; ++i) {
    const double x = 1.2 * (0.5 + 0.5 * (i + 1) / one.stops);
    NamedStop stop;
    stop.name = fmt::format("s{}", i);
    stop.at.x = one.stops == 2 ? 0.6 * (i + 1) : x;
    stop.at.component = "uy";
    stop.lower = one.reached ? (one.stops == 2 ? (i == 0 ? -2e-4 : -1e-3) : -2e-4 * (i + 1) / one.stops) : -1.0;
    TangentSpec across;
    across.component = "uz";
    stop.tangent = across;
    if (one.rubs) stop.friction = FrictionSpec{0.3, 0.3};
    scene.stops.named.push_back(stop);
  }
  scene.load.terms = {pushes(1.2, "uy", "-6+0.8*cos(14*pi*t)"), pushes(1.2, "uz", "2.6*cos(14*pi*t)")};
  return scene;
}

Marcher made(const Registry& registry, const Case& one) {
  const auto* mass = registry.mass("consistent");
  const auto* time = registry.time(one.scheme);
  const auto* contact = registry.contact(one.law);
  const auto* friction = registry.friction("coulomb");
  auto problem = std::make_shared<const SemiDiscrete>(std::get<SemiDiscrete>(
      discretise(tube(one), one.stops == 2 ? 2 : one.stops, *mass->make(defaults(mass->manual)))));
  std::map<std::string, ParameterValue> values;
  for (const ParameterSpec& spec : contact->manual.parameters) {
    if (spec.role == ParameterRole::stiffness) values[spec.key] = 2e4;
    if (spec.key == "evaluation") values[spec.key] = std::string("averaged");
  }
  const Parameters parameters = defaults(contact->manual, values);
  auto law = contact->make(parameters);
  auto plan = std::get<StepPlan>(time->make(defaults(time->manual))->plan(6.25e-5, problem_facts(*problem, *law)));
  CompileOptions options;
  options.make_friction = [friction] { return friction->make(defaults(friction->manual)); };
  return Marcher(
      std::get<Program>(compile(problem, plan, 6.25e-5, std::move(law), {scene_lane(*problem, parameters)}, options)));
}

// Microseconds per step, once it has settled.
double timed(Marcher& tube, int steps, const Observers& observers) {
  tube.start(observers);
  tube.march(steps / 4, observers);
  const double begin = thread_nanoseconds();
  tube.march(steps, observers);
  return 1e-3 * (thread_nanoseconds() - begin) / steps;
}

void measure(const Registry& registry, Case& one) {
  Marcher tube = made(registry, one);
  one.alone.push_back(timed(tube, one.steps, {}));
  Marcher other = made(registry, one);
  EnergyAudit audit(other, SamplingMode::seldom);
  FrictionWatch wear(other, audit, {});
  ImpactRecorder recorder(other);
  const StopContacts contacts(other, recorder);
  Observers observers{&audit};
  if (wear.any()) observers.add(&wear);
  observers.add(&recorder);
  one.watched.push_back(timed(other, one.steps, observers));
  one.ran &= tube.status(0).running && other.status(0).running;
}

std::string ratio(const std::vector<double>& rubbing, const std::vector<double>& plain) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < rubbing.size(); ++k) ratios.push_back(rubbing[k] / plain[k]);
  const auto [low, high] = std::minmax_element(ratios.begin(), ratios.end());
  return fmt::format("{:.3f} | {:.3f} | {:.2f} ({:.2f} to {:.2f})", median(plain), median(rubbing), median(ratios),
                     *low, *high);
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 5;
  if (argc == 3 && std::strcmp(argv[1], "--rounds") == 0) rounds = std::max(1, std::atoi(argv[2]));
  Catalogue catalogue(RICOCHET_PLUGIN_DIR, {}, {});
  Registry registry;
  catalogue.open_all(registry);
  std::vector<Case> cases;
  for (const auto& [law, scheme] : {std::pair{"penalty", "moreau-jean"},
                                    {"penalty", "newmark-dumont-paoli"},
                                    {"signorini", "moreau-jean"},
                                    {"signorini", "newmark-dumont-paoli"}})
    for (const int stops : {2, 24})
      for (const bool reached : {true, false})
        for (const bool rubs : {false, true})
          cases.push_back({stops == 2 ? "tube, 2 stops" : "tube, 24 stops", law, scheme, stops, rubs, reached,
                           stops == 2 ? 20000 : 4000});
  for (int round = 0; round < rounds; ++round)
    for (Case& one : cases) measure(registry, one);
  fmt::print("h = 6.25e-5 s, one lane, every step; {} rounds, medians; µs per step\n\n", rounds);
  fmt::print(
      "| scene | law, scheme | stops | watched by | without friction | with it | ratio (range) |\n"
      "|---|---|---|---|---|---|---|\n");
  for (std::size_t k = 0; k + 1 < cases.size(); k += 2) {
    const Case &plain = cases[k], &rubbing = cases[k + 1];
    for (const auto& [watch, times] : {std::pair{"nothing", &Case::alone}, {"audit, contacts, wear", &Case::watched}})
      fmt::print("| {} | {}, {} | {} | {} | {} |\n", plain.scene, plain.law, plain.scheme,
                 plain.reached ? "pressed" : "out of reach", watch,
                 plain.ran && rubbing.ran ? ratio(rubbing.*times, plain.*times) : "| | one of both ended");
  }
  return 0;
}
