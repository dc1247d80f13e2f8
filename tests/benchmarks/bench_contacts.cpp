// What steps with hundreds of contact points cost. The reference beam is upon a plane below all of its nodes: lying
// there under its load, or thrown flat at it. Milliseconds per step, held in the band (the band operator) and by
// columns of the Delassus operator alone (the sparse one). The latter has up to 300 elements: more take too long to
// wait for. Means over the steps, medians of interleaved rounds; the dearest step of the last round beside them.
//
//     bench_contacts [--rounds N]
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

constexpr int most_by_columns = 300, steps = 100;
constexpr double step = 1e-4;

struct Case {
  bool lying;
  const char* mass;
  const char* scheme;
  int elements;
  bool in_band;
  int most = 0;
  double dearest = 0;
  std::vector<double> milliseconds = {};
};

SceneSpec upon_a_plane(bool lying) {
  SceneSpec scene = reference_beam(StopsSpec::Place::nodes);
  scene.support.amplitude = 0;
  scene.stops.upper.reset();
  scene.stops.lower = Formula(lying ? 0.0 : -2e-4);
  scene.initial.displacement = Formula(0.0);
  scene.initial.velocity = lying ? Formula(0.0) : Formula("-0.5*x", "/scene/initial/velocity", "x");
  scene.load = Formula(-50.0);
  return scene;
}

Marcher made(const Registry& registry, const Case& one) {
  const auto* mass = registry.mass(one.mass);
  const auto* time = registry.time(one.scheme);
  const auto* contact = registry.contact("signorini");
  auto problem = std::make_shared<const SemiDiscrete>(
      std::get<SemiDiscrete>(discretise(upon_a_plane(one.lying), one.elements, *mass->make(defaults(mass->manual)))));
  auto law = contact->make(defaults(contact->manual));
  auto plan = std::get<StepPlan>(time->make(defaults(time->manual))->plan(step, problem_facts(*problem, *law)));
  CompileOptions options;
  options.kind = one.in_band ? OperatorKind::band : OperatorKind::sparse;
  return Marcher(std::get<Program>(
      compile(problem, plan, step, std::move(law), {scene_lane(*problem, defaults(contact->manual))}, options)));
}

/// How many points push at once.
struct Count final : StepObserver {
  void stage_solved(const Marcher& marcher, const StageView& view) override {
    if (view.starting || !view.effort) return;
    int pushing = 0;
    for (int i = 0; i < marcher.program().problem->points(); ++i) pushing += view.effort[0][i] != 0;
    most = std::max(most, pushing);
  }
  void step_done(Marcher&) override {}
  int most = 0;
};

void measure(const Registry& registry, Case& one) {
  Marcher beam = made(registry, one);
  Count count;
  beam.start();
  one.dearest = 0;
  const double begin = thread_nanoseconds();
  for (int n = 0; n < steps; ++n) {
    const double before = thread_nanoseconds();
    beam.march(1, &count);
    one.dearest = std::max(one.dearest, 1e-6 * (thread_nanoseconds() - before));
  }
  one.milliseconds.push_back(1e-6 * (thread_nanoseconds() - begin) / steps);
  one.most = count.most;
  if (!beam.status(0).running) one.most = -1;
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 3;
  if (argc == 3 && std::strcmp(argv[1], "--rounds") == 0) rounds = std::max(1, std::atoi(argv[2]));
  Catalogue catalogue(RICOCHET_PLUGIN_DIR, {}, {});
  Registry registry;
  catalogue.open_all(registry);
  std::vector<Case> cases;
  for (const bool lying : {true, false})
    for (const auto& [mass, scheme] : {std::pair{"consistent", "newmark-dumont-paoli"},
                                       {"singular", "newmark-dumont-paoli"},
                                       {"consistent", "moreau-jean"},
                                       {"lumped", "newmark-dumont-paoli"}})
      for (const int elements : {100, 300, 1000, 2000})
        for (const bool in_band : {true, false})
          if (in_band || elements <= most_by_columns) cases.push_back({lying, mass, scheme, elements, in_band});
  for (int round = 0; round < rounds; ++round)
    for (Case& one : cases) measure(registry, one);
  fmt::print("h = {:g} s, {} steps, one lane; {} rounds, medians; ms per step\n\n", step, steps, rounds);
  fmt::print(
      "| beam | mass, scheme | elements | most points at once | in the band | dearest step | by columns | ratio |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const Case& one = cases[k];
    if (!one.in_band) continue;
    const bool both = k + 1 < cases.size() && !cases[k + 1].in_band;
    const double band = median(one.milliseconds);
    fmt::print("| {} | {}, {} | {} | {} | {:.3f} | {:.2f} | {} | {} |\n", one.lying ? "lying" : "thrown", one.mass,
               one.scheme, one.elements, one.most, band, one.dearest,
               both ? fmt::format("{:.3f}", median(cases[k + 1].milliseconds)) : "",
               both ? fmt::format("{:.1f}", median(cases[k + 1].milliseconds) / band) : "");
  }
}
