// Marches that leave out the steps in which nothing happens, beside the same integration of every step. Both have the
// energy audit and the recorder of impacts. Printed: times, steps visited, and how far their ends are apart. Medians of
// interleaved rounds, every-step of the same build as partner.
//
//     bench_flight [--rounds N] [--only WORD]
//     bench_flight --flown N [--only WORD]     N flown marches alone, for a profiler
//     bench_flight --auto yes [--rounds N] [--only WORD]     both ways, set-up included, beside what `auto` takes
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>

#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

struct Scene {
  std::string name;
  SceneSpec scene;
  int elements = 50;
  std::string mass = "singular", velocity = "P1";
  double h = 1e-5, duration = 0.5;
  double beta = 0.5;
  double stiffness = 0;    // of springs behind the stops, N/m; 0: rigid
  bool every_step = true;  // whether the integration of every step can be waited for
};

struct Outcome {
  double nanoseconds = 0, set_up = 0;
  long long steps = 0, visited = 0;
  Eigen::VectorXd end;
  double energy = 0, damping = 0, loads = 0, impulse = 0, residual = 0, gain = 0;
  long long contact_steps = 0, impacts = 0;
  bool flew = false;
  double predicted = 0;  // of all steps and the set-up, ns
  std::string refusal;
};

SceneSpec free_swing(double viscosity) {
  SceneSpec scene = reference_beam(StopsSpec::Place::nodes);
  std::get<BeamSpec>(scene.structure).damping.stiffness = viscosity;
  scene.support.amplitude = 0;
  scene.initial.displacement = Formula("0.04*x^2", "/scene/initial/displacement", "x");
  scene.initial.velocity = Formula("-2*x", "/scene/initial/velocity", "x");
  return scene;
}

Outcome march(const Scene& scene, MarchWay way, Registry& registry) {
  Outcome out;
  const double begin = thread_nanoseconds();
  const auto* mass = registry.mass(scene.mass);
  std::map<std::string, ParameterValue> words;
  if (scene.mass == "singular") words["velocity"] = scene.velocity;
  const auto strategy = mass->make(defaults(mass->manual, words));
  auto made = discretise(scene.scene, scene.elements, *strategy);
  const auto problem = std::make_shared<const SemiDiscrete>(std::move(std::get<SemiDiscrete>(made)));
  const auto* law = registry.contact(scene.stiffness > 0 ? "penalty" : "signorini");
  std::map<std::string, ParameterValue> springs;
  if (scene.stiffness > 0) springs["stiffness"] = scene.stiffness;
  const Parameters parameters = defaults(law->manual, springs);
  const auto* time = registry.time("newmark-dumont-paoli");
  auto contact = law->make(parameters);
  const auto scheme = time->make(defaults(time->manual, {{"beta", scene.beta}, {"start", std::string("first-order")}}));
  auto plan = scheme->plan(scene.h, problem_facts(*problem, *contact));
  CompileOptions options;
  options.march = way;
  options.expected_steps = std::llround(scene.duration / scene.h);
  auto program = compile(problem, std::get<StepPlan>(plan), scene.h, std::move(contact),
                         {scene_lane(*problem, parameters)}, options);
  if (const auto* refusal = std::get_if<Refusal>(&program)) {
    out.refusal = refusal->sentence.text;
    return out;
  }
  out.flew = std::get<Program>(program).flight != nullptr;
  out.predicted =
      1e9 * (std::get<Program>(program).predicted_setup_seconds +
             static_cast<double>(options.expected_steps) * std::get<Program>(program).predicted_step_seconds);
  Marcher marcher(std::move(std::get<Program>(program)));
  EnergyAudit audit(marcher, SamplingMode::seldom);
  ImpactRecorder recorder(marcher);
  const double start = thread_nanoseconds();
  out.set_up = start - begin;
  marcher.start({&audit, &recorder});
  out.steps = options.expected_steps;
  marcher.march(out.steps - marcher.step(), {&audit, &recorder});
  out.nanoseconds = thread_nanoseconds() - start;
  recorder.finish(marcher);
  out.visited = marcher.steps_visited();
  out.end = marcher.position(0);
  const EnergyTotals& energy = audit.totals(0);
  out.energy = energy.last.scheme;
  out.damping = energy.work_of_damping;
  out.loads = energy.work_of_loads;
  out.residual = energy.balance_residual();
  out.gain = energy.largest_step_gain;
  out.impulse = audit.contact(0).impulse;
  out.contact_steps = audit.contact(0).contact_steps;
  out.impacts = recorder.count(0);
  return out;
}

std::vector<Scene> scenes() {
  std::vector<Scene> list;
  for (const char* mass : {"singular", "consistent", "lumped"})
    for (const double h : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
      Scene one{fmt::format("free {} {:g}", mass, h), free_swing(0)};
      one.mass = mass;
      one.h = h;
      one.every_step = h > 5e-8;
      list.push_back(one);
    }
  Scene damped{"damped singular 1e-05", free_swing(1e-4)};
  list.push_back(damped);
  for (const int steps : {2000, 8000, 32000}) {
    Scene forced{fmt::format("forced singular {}", steps), reference_beam(StopsSpec::Place::nodes)};
    forced.elements = 20;
    forced.h = 2 * M_PI / 10 / steps;
    forced.duration = 6 * 2 * M_PI / 10;
    list.push_back(forced);
  }
  for (const double h : {1e-5, 1e-6, 1e-7}) {
    Scene springs{fmt::format("penalty consistent {:g}", h), free_swing(0)};
    springs.mass = "consistent";
    springs.h = h;
    springs.stiffness = 1e5;
    list.push_back(springs);
    springs.name = fmt::format("penalty tip consistent {:g}", h);
    springs.scene.stops.place = StopsSpec::Place::tip;
    list.push_back(springs);
    // Pressed onto a spring at its tip, where it comes to rest.
    springs.name = fmt::format("pressed consistent {:g}", h);
    springs.scene = free_swing(1e-4);
    springs.scene.stops.place = StopsSpec::Place::tip;
    springs.scene.load = Formula("20*x", "/scene/load");
    list.push_back(springs);
  }
  return list;
}

std::vector<Scene> scenes_of_sizes() {
  std::vector<Scene> list;
  for (const int elements : {20, 50, 100, 200, 400}) {
    for (const double h : {1e-4, 1e-5, 2e-6}) {
      Scene one{fmt::format("free nodes N {} h {:g}", elements, h), free_swing(0)};
      one.mass = "consistent";
      one.elements = elements;
      one.h = h;
      one.duration = elements > 100 ? 0.1 : 0.25;
      list.push_back(one);
      one.name = fmt::format("damped tip N {} h {:g}", elements, h);
      one.scene = free_swing(1e-4);
      one.scene.stops.place = StopsSpec::Place::tip;
      list.push_back(one);
    }
  }
  return list;
}

double median(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Whether `auto` takes the faster way: where they are a third apart, it has to.
void compare_choices(int rounds, const std::string& only, Registry& registry) {
  constexpr double apart = 1.33;
  int scenes = 0, wrong = 0;
  for (const Scene& scene : scenes_of_sizes()) {
    if (scene.name.find(only) == std::string::npos) continue;
    std::vector<double> every_step, flights, set_up;
    Outcome every, flown;
    for (int round = 0; round < rounds; ++round) {
      every = march(scene, MarchWay::every_step, registry);
      flown = march(scene, MarchWay::flights, registry);
      every_step.push_back(every.set_up + every.nanoseconds);
      flights.push_back(flown.set_up + flown.nanoseconds);
      set_up.push_back(flown.set_up);
    }
    const bool flew = march(scene, MarchWay::automatic, registry).flew;
    const double marched = median(every_step), left_out = median(flights);
    const bool bad = flew ? left_out > apart * marched : marched > apart * left_out;
    ++scenes;
    wrong += bad;
    fmt::print(
        "{:<28} every step {:>8.1f} ms ({:.1f} predicted), flights {:>8.1f} ms ({:.1f}), of it set-up {:.1f}; "
        "auto {}{}\n",
        scene.name, marched / 1e6, every.predicted / 1e6, left_out / 1e6, flown.predicted / 1e6, median(set_up) / 1e6,
        flew ? "flies" : "marches", bad ? ", the slower way" : "");
  }
  fmt::print("{} of {} choices are the slower way by a third\n", wrong, scenes);
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 1, flown_alone = 0;
  bool choices = false;
  std::string only;
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--flown") == 0) flown_alone = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--only") == 0) only = argv[i + 1];
    if (std::strcmp(argv[i], "--auto") == 0) choices = true;
  }
  Catalogue catalogue(RICOCHET_PLUGIN_DIR, {}, {});
  Registry registry;
  catalogue.open_all(registry);
  if (choices) {
    compare_choices(std::max(1, rounds), only, registry);
    return 0;
  }
  for (const Scene& scene : scenes()) {
    if (scene.name.find(only) == std::string::npos) continue;
    const int alone = scene.every_step ? flown_alone : std::max(1, flown_alone);
    for (int k = 0; k < alone; ++k) {
      const Outcome one = march(scene, MarchWay::flights, registry);
      if (!one.refusal.empty()) fmt::print("{:<24} {}\n", scene.name, one.refusal);
      fmt::print("{:<24} {:>11} steps {:>8} visited {:>9} in contact {:>9.1f} ms flown, energy {:.6f} J\n", scene.name,
                 one.steps, one.visited, one.contact_steps, one.nanoseconds / 1e6, one.energy);
    }
    if (alone > 0) continue;
    std::vector<double> ratios;
    Outcome every, flown;
    for (int round = 0; round < rounds; ++round) {
      every = march(scene, MarchWay::every_step, registry);
      flown = march(scene, MarchWay::flights, registry);
      if (!flown.refusal.empty()) break;
      ratios.push_back(every.nanoseconds / flown.nanoseconds);
    }
    if (!flown.refusal.empty()) {
      fmt::print("{:<28} {}\n", scene.name, flown.refusal);
      continue;
    }
    std::sort(ratios.begin(), ratios.end());
    fmt::print(
        "{:<24} {:>11} steps {:>8} visited {:>9} in contact {:>9.1f} ms flown, every step {:.2f} µs; ratio {:.1f} "
        "({:.1f} to {:.1f})\n",
        scene.name, flown.steps, flown.visited, flown.contact_steps, flown.nanoseconds / 1e6,
        every.nanoseconds / 1e3 / static_cast<double>(every.steps), ratios[ratios.size() / 2], ratios.front(),
        ratios.back());
    fmt::print(
        "    ends apart {:.1e} m of {:.1e}; energy {:.10g} | {:.10g}; damping {:.8g} | {:.8g}; loads {:.8g} | "
        "{:.8g}; impulse {:.10g} | {:.10g}; residual {:.1e} | {:.1e}; impacts {} | {}\n",
        (every.end - flown.end).lpNorm<Eigen::Infinity>(), every.end.lpNorm<Eigen::Infinity>(), every.energy,
        flown.energy, every.damping, flown.damping, every.loads, flown.loads, every.impulse, flown.impulse,
        every.residual, flown.residual, every.impacts, flown.impacts);
  }
}
