// What marching costs once modes are dead: a beam let go with α = 1e-4 and marched in modal coordinates. Viscosity
// takes its high modes below the smallest normal number within milliseconds. Nanoseconds per step over the first 0.02
// s, 0.2 s and 1 s. Also the last over the first in the same integration: more than one where denormal numbers are
// computed with. Medians of interleaved rounds. What is predicted for the same program stands beside it.
//
//     bench_decay [--rounds N]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

constexpr double step = 1e-5;
constexpr int elements = 10;
constexpr std::array<long long, 3> ends = {2000, 20000, 100000};

struct Case {
  std::string scheme, law;
  double predicted = 0;
  std::array<std::vector<double>, ends.size()> nanoseconds = {};
  std::vector<double> ratio = {};
};

Marcher let_go(const Registry& registry, Case& one) {
  SceneSpec scene = reference_beam(StopsSpec::Place::nodes);
  scene.support.amplitude = 0;
  scene.initial.displacement = Formula("0.04*x^2", "/scene/initial/displacement", "x");
  scene.initial.velocity = Formula("-2*x", "/scene/initial/velocity", "x");
  const auto* mass = registry.mass("consistent");
  const auto* time = registry.time(one.scheme);
  const auto* contact = registry.contact(one.law);
  auto problem = std::make_shared<const SemiDiscrete>(
      std::get<SemiDiscrete>(discretise(scene, elements, *mass->make(defaults(mass->manual)))));
  auto law = contact->make(defaults(contact->manual));
  auto plan = std::get<StepPlan>(time->make(defaults(time->manual))->plan(step, problem_facts(*problem, *law)));
  CompileOptions options;
  options.kind = OperatorKind::modal;
  auto program = std::get<Program>(
      compile(problem, plan, step, std::move(law), {scene_lane(*problem, defaults(contact->manual))}, options));
  one.predicted = 1e9 * program.predicted_step_seconds;
  return Marcher(std::move(program));
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 7;
  if (argc == 3 && std::strcmp(argv[1], "--rounds") == 0) rounds = std::max(1, std::atoi(argv[2]));
  Catalogue catalogue = Catalogue::standard();
  Registry registry;
  catalogue.open_all(registry);
  std::vector<Case> cases;
  for (const char* law : {"none", "signorini"})
    for (const char* scheme : {"newmark", "newmark-dumont-paoli", "moreau-jean"}) {
      if (!registry.time(scheme) || !registry.contact(law)) {
        fmt::print(stderr, "bench_decay: plugins not found beside the program\n");
        return 4;
      }
      cases.push_back({scheme, law});
    }
  for (int round = 0; round < rounds; ++round)
    for (Case& one : cases) {
      Marcher beam = let_go(registry, one);
      beam.start();
      const double start = thread_nanoseconds();
      for (std::size_t k = 0; k < ends.size(); ++k) {
        beam.march(ends[k] - beam.step());
        one.nanoseconds[k].push_back((thread_nanoseconds() - start) / static_cast<double>(ends[k]));
      }
      one.ratio.push_back(one.nanoseconds.back().back() / one.nanoseconds.front().back());
    }
  fmt::print("consistent mass, N = {}, alpha = 1e-4, h = {:g} s, modal, one lane; {} rounds, medians\n\n", elements,
             step, rounds);
  fmt::print("{:<22} {:<10} {:>9} {:>9} {:>9} {:>11} {:>10}   ns/step\n", "scheme", "stops", "0.02 s", "0.2 s", "1 s",
             "1 s/0.02 s", "predicted");
  for (const Case& one : cases)
    fmt::print("{:<22} {:<10} {:>9.0f} {:>9.0f} {:>9.0f} {:>11.2f} {:>10.0f}\n", one.scheme,
               one.law == "none" ? "none" : "all nodes", median(one.nanoseconds[0]), median(one.nanoseconds[1]),
               median(one.nanoseconds[2]), median(one.ratio), one.predicted);
}
