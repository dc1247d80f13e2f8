// A tube in 26 modes between eight two-sided stops beside what a page of C++ takes for it (fair_tube.cpp), µs per step:
// rigid stops and springs, pushed by a harmonic force. Newmark–Dumont–Paoli, β = ½, e = 0. Ours alone, and with the
// audit of energy and the recorder of impacts.
//
//     bench_tube [--rounds N] [--steps N]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "tests/benchmarks/fair_tube.hpp"
#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/shown_range.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

constexpr int modes = 26, points = 8;
constexpr double length = 8, bending = 1.5e4, density = 2.5, ratio = 0.01;  // m, N m², kg/m
constexpr double gap = 3e-4, force = 200, pulsation = 10 * std::numbers::pi, h = 2e-5;

struct Tube {
  SceneSpec scene;
  std::vector<double> squares, damping, shapes, load;

  Tube() {
    const double unit = std::sqrt(2 / (density * length));
    std::string table = "mode,frequency,mass,damping\n", rows = "point";
    const auto add = [&](const std::string& name, double x, std::vector<double>& out) {
      rows += "\n" + name;
      for (int k = 1; k <= modes; ++k) {
        out.push_back(unit * std::sin(k * std::numbers::pi * x));
        rows += fmt::format(",{:.17g}", out.back());
      }
    };
    for (int k = 1; k <= modes; ++k) {
      const double wave = k * std::numbers::pi / length, omega = wave * wave * std::sqrt(bending / density);
      squares.push_back(omega * omega);
      damping.push_back(2 * ratio * omega);
      table += fmt::format("{},{:.17g},1,{}\n", k, omega / (2 * std::numbers::pi), ratio);
      rows += fmt::format(",{}", k);
    }
    for (int i = 1; i <= points; ++i) add(fmt::format("p{}", i), i / (points + 1.0), shapes);
    add("force", 0.37, load);
    const ModalFiles files{read_csv(table, "modes.csv"), read_csv(rows + "\n", "shapes.csv"), std::nullopt,
                           std::nullopt, std::nullopt};
    AssembledSpec spec;
    std::vector<double> ratios;
    spec.structure = std::make_shared<const AssembledStructure>(modal_structure(files, ratios));
    spec.damping.ratios = ratios;
    scene.structure = spec;
    const auto place = [](const std::string& name) {
      Place at;
      at.point = name;
      return at;
    };
    for (int i = 1; i <= points; ++i)
      scene.stops.named.push_back({fmt::format("p{}", i), place(fmt::format("p{}", i)), {}, -gap, gap});
    scene.load.terms = {
        {true, {}, {}, Formula(fmt::format("{}*sin({}*t)", force, pulsation), "/scene/load", "t"), place("force")}};
  }
};

FairTubeResult ours(const Tube& tube, double stiffness, bool watched, Registry& registry, long long steps,
                    OperatorKind& kind) {
  const auto* mass = registry.mass("consistent");
  const auto problem = std::make_shared<const SemiDiscrete>(
      std::get<SemiDiscrete>(discretise(tube.scene, 1, *mass->make(defaults(mass->manual)))));
  const auto* contact = registry.contact(stiffness > 0 ? "penalty" : "signorini");
  std::map<std::string, ParameterValue> values;
  if (stiffness > 0) values = {{"stiffness", stiffness}, {"evaluation", std::string("implicit")}};
  const Parameters parameters = defaults(contact->manual, values);
  auto law = contact->make(parameters);
  const auto* time = registry.time("newmark-dumont-paoli");
  auto plan =
      time->make(defaults(time->manual, {{"beta", 0.5}, {"restitution", 0.0}}))->plan(h, problem_facts(*problem, *law));
  CompileOptions options;
  options.march = MarchWay::every_step;
  options.expected_steps = 100 * steps;
  Program program = std::get<Program>(
      compile(problem, std::get<StepPlan>(plan), h, std::move(law), {scene_lane(*problem, parameters)}, options));
  kind = program.kind;
  Marcher marcher(std::move(program));
  EnergyAudit audit(marcher, SamplingMode::seldom);
  ImpactRecorder recorder(marcher);
  Observers observers;
  if (watched) observers = {&audit, &recorder};
  FairTubeResult out;
  const double begun = thread_nanoseconds();
  marcher.start(observers);
  marcher.march(steps - marcher.step(), observers);
  out.step_seconds = 1e-9 * (thread_nanoseconds() - begun) / static_cast<double>(steps);
  if (watched) {
    out.pushed = audit.contact(0).contact_steps;
    out.impulse = audit.contact(0).impulse;
  }
  const Eigen::VectorXd u = marcher.position(0);
  for (int k = 0; k < modes; ++k) out.end += tube.shapes[static_cast<std::size_t>((points - 1) * modes + k)] * u[k];
  return out;
}

void race(const Tube& tube, double stiffness, int rounds, long long steps, Registry& registry) {
  const FairTube partner{modes,
                         points,
                         tube.squares.data(),
                         tube.damping.data(),
                         tube.shapes.data(),
                         tube.load.data(),
                         gap,
                         stiffness,
                         force,
                         pulsation,
                         h};
  std::vector<double> seconds[3], ratios[2];
  FairTubeResult last[3];
  OperatorKind kind{};
  for (int round = 0; round < rounds; ++round) {
    last[0] = ricochet_fair_tube(partner, steps);
    last[1] = ours(tube, stiffness, false, registry, steps, kind);
    last[2] = ours(tube, stiffness, true, registry, steps, kind);
    for (std::size_t k = 0; k < 3; ++k) seconds[k].push_back(last[k].step_seconds);
    for (std::size_t k = 0; k < 2; ++k) ratios[k].push_back(last[k + 1].step_seconds / last[0].step_seconds);
  }
  fmt::print("{}, {}: beside {}, ours {}, watched {} µs; ratio {:.2f}, watched {:.2f}\n",
             stiffness > 0 ? "springs" : "rigid", operator_name(kind), shown_range(seconds[0], 1e6),
             shown_range(seconds[1], 1e6), shown_range(seconds[2], 1e6), median(ratios[0]), median(ratios[1]));
  fmt::print("  steps in contact {}, {}; impulse {:.9g}, {:.9g} N s; end {:.9g}, {:.9g} m\n", last[0].pushed,
             last[2].pushed, last[0].impulse, last[2].impulse, last[0].end, last[2].end);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 5;
  long long steps = 200000;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::max(1, std::atoi(argv[i + 1]));
    if (std::strcmp(argv[i], "--steps") == 0) steps = std::max(1000, std::atoi(argv[i + 1]));
  }
  const FlushDenormals flush;
  Catalogue catalogue = Catalogue::standard();
  Registry registry;
  catalogue.open_all(registry);
  if (!registry.time("newmark-dumont-paoli") || !registry.contact("penalty") || !registry.contact("signorini")) {
    fmt::print(stderr, "bench_tube: plugins not found beside the program\n");
    return 4;
  }
  fmt::print("kernels: {}\n", lane_instruction_set());
  const Tube tube;
  for (const double stiffness : {0.0, 1e5}) race(tube, stiffness, rounds, steps, registry);
}
