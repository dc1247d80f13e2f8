// Nanoseconds per lane-step of the reference scene: N = 50, α = 1e-4, forced, contact happening; stops at all nodes for
// each mass and operator, and at the tip. Medians of interleaved rounds with their spread, beside the FMA peak of the
// core in the same run. What the cost model says of each row stands beside it, and is to lie within a factor of three.
//
//     bench_march [--rounds N] [--rows TEXT] [--lanes T]      those rows alone whose name holds TEXT, of T lanes
//     bench_march --schemes [--rounds N]   each time scheme on a lumped beam of 10 elements, against the three-level
//     one bench_march --calibrate      the rates of core/engine/cost_model.cpp: nanoseconds per multiply-add of each
//     kernel
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/measure/motion/motion_sampler.hpp>

#include "tests/benchmarks/fma_peak.hpp"
#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

struct Case {
  std::string name;
  StopsSpec::Place place;
  std::string mass, velocity;
  OperatorKind kind;
  int lanes;
  std::vector<double> nanoseconds;
  std::unique_ptr<Marcher> marcher;
  std::unique_ptr<EnergyAudit> audit;
  std::unique_ptr<ImpactRecorder> recorder;
  std::unique_ptr<MotionSampler> sampler;  ///< reads the motion every `steps_per_sample` steps, contact at each
  long long contact_steps = 0;
  Observers observers() const { return {audit.get(), recorder.get()}; }
};

// What looks at the integration: nothing, the energy audit at every step, or the audit behind a recorder of impacts. Or
// samples as a comparing study takes them.
enum class Watch { nothing, energy, impacts, samples };
constexpr int steps_per_sample = 500;
// Factor between the cost that is predicted and the one that is measured; beyond it the program ends with 1.
constexpr double within = 3;

// Time of one call, as the fastest of several batches: what a cost model should compare is the machine at rest.
template <class Call>
double fastest(Call call) {
  double best = 1e300;
  for (int batch = 0; batch < 20; ++batch) {
    const double start = thread_nanoseconds();
    for (int k = 0; k < 400; ++k) call();
    best = std::min(best, (thread_nanoseconds() - start) / 400);
  }
  return best;
}

void calibrate() {
  constexpr int rows = 100, width = 3, points = 10;
  fmt::print("nanoseconds per multiply-add and lane, 100 rows, half-bandwidth 3, {}\n", lane_instruction_set());
  fmt::print("{:>5} {:>10} {:>14} {:>12} {:>10} {:>10}\n", "lanes", "product", "substitution", "elementwise",
             "diagonal", "measure");
  for (const int lanes : {1, 2, 4, 8, 16, 32}) {
    const LaneKernels& kernels = lane_kernels(lanes);
    Block k(rows, lanes, width), b(rows, lanes), z(rows, lanes, width), q(rows, lanes), d(rows, lanes);
    const std::vector<double> band(rows * (2 * width + 1) + 8, 1e-3), factor(rows * (2 * width + 1), 1e-3);
    BandStep step;
    step.rows = step.solve_rows = rows;
    step.product_width = width;
    step.K = band.data();
    step.k = k.data();
    step.b = b.data();
    step.z = z.data();
    const double product = fastest([&] { kernels.band_step(step); });
    step.solve_width = width;
    step.factor = factor.data();
    const double whole = fastest([&] { kernels.band_step(step); });
    double* slots[] = {q.data(), d.data()};
    const double weights[] = {1, 0.5, 0.5, 0, 1, 0.5}, next[] = {1, 2};
    const double update =
        fastest([&] { kernels.update(static_cast<long>(q.size()), 2, slots, z.data(), weights, next, k.data()); });
    // A modal step: one coefficient per slot and mode; and H on modes, which has no zeros.
    const std::vector<double> coefficient(3 * rows, 1e-3), value(points * rows, 1e-3), terms(3, 0.5);
    std::vector<int> start, index;
    for (int i = 0; i <= points; ++i) start.push_back(i * rows);
    for (int e = 0; e < points * rows; ++e) index.push_back(e % rows);
    const LaneRows matrix{points, start.data(), index.data(), value.data()};
    const double* read[] = {q.data(), d.data(), z.data()};
    Block scale(1, lanes), y(points, lanes);
    const double diagonal =
        fastest([&] { kernels.diagonal_step(rows, 2, coefficient.data(), read, scale.data(), b.data()); });
    const double measure = fastest([&] { kernels.measure(matrix, 3, read, terms.data(), nullptr, y.data()); });
    fmt::print("{:>5} {:>10.3f} {:>14.3f} {:>12.3f} {:>10.3f} {:>10.3f}\n", lanes, product / (rows * 7 * lanes),
               (whole - product) / (rows * 7 * lanes), update / (rows * 8 * lanes), diagonal / (rows * 3 * lanes),
               measure / (points * rows * 4 * lanes));
  }
}

// Interleaved rounds of all cases; returns the FMA peak of the same time.
double measure_rounds(std::vector<Case>& cases, int rounds) {
  double peak = 0;
  for (int round = 0; round < rounds; ++round) {
    peak = std::max(peak, fma_peak());
    for (Case& one : cases) {
      const long long steps = std::max(1500, 6000 / one.lanes * 2);
      const double start = thread_nanoseconds();
      if (one.sampler)
        for (int k = 0; k < steps / steps_per_sample; ++k) one.sampler->next();
      else
        one.marcher->march(steps, one.observers());
      const double elapsed = thread_nanoseconds() - start;
      one.nanoseconds.push_back(elapsed / static_cast<double>(steps) / one.lanes);
    }
  }
  return peak;
}

constexpr const char* measure_of_schemes = "newmark-dumont-paoli";

// Every time scheme with its defaults on one scene that explicit ones march too: lumped, h ω = 0.3 at the most.
void add_schemes(const Registry& registry, std::vector<Case>& cases) {
  const auto* mass = registry.mass("lumped");
  const auto problem = std::make_shared<const SemiDiscrete>(std::get<SemiDiscrete>(
      discretise(reference_beam(StopsSpec::Place::nodes), 10, *mass->make(defaults(mass->manual, {})))));
  for (const std::string& name : registry.names(Role::time)) {
    const auto* time = registry.time(name);
    auto law = registry.contact("signorini")->make({});
    constexpr double h = 2e-5;
    auto plan = time->make(defaults(time->manual, {}))->plan(h, problem_facts(*problem, *law));
    if (const auto* refusal = std::get_if<Refusal>(&plan)) {
      fmt::print("{}: refused: {}\n", name, refusal->sentence.text);
      continue;
    }
    LaneSpec lane = scene_lane(*problem, {});
    lane.amplitude = 0.088;
    CompileOptions options;
    options.kind = OperatorKind::band;
    auto program = compile(problem, std::get<StepPlan>(plan), h, std::move(law), {lane}, options);
    if (const auto* refusal = std::get_if<Refusal>(&program)) {
      fmt::print("{}: refused: {}\n", name, refusal->sentence.text);
      continue;
    }
    Case one{name, StopsSpec::Place::nodes, "lumped", "", options.kind, 1, {}, nullptr, nullptr, nullptr, nullptr, 0};
    one.marcher = std::make_unique<Marcher>(std::move(std::get<Program>(program)));
    one.marcher->start();
    one.marcher->march(40000);  // into the impacting regime
    cases.push_back(std::move(one));
  }
}

void print_schemes(std::vector<Case>& cases) {
  const auto median = [](Case& one) {
    std::sort(one.nanoseconds.begin(), one.nanoseconds.end());
    return one.nanoseconds[one.nanoseconds.size() / 2];
  };
  const auto first =
      std::find_if(cases.begin(), cases.end(), [](const Case& one) { return one.name == measure_of_schemes; });
  const double measure = median(*first);
  fmt::print("{:<32} {:>7} {:>12} {:>22} {:>8}\n", "time scheme", "stages", "ns/step", "spread", "ratio");
  for (Case& one : cases) {
    const double middle = median(one);
    fmt::print("{:<32} {:>7} {:>12.1f} {:>22} {:>8.2f}{}\n", one.name, one.marcher->program().stages.size(), middle,
               fmt::format("[{:.1f}, {:.1f}]", one.nanoseconds.front(), one.nanoseconds.back()), middle / measure,
               one.marcher->any_running() ? "" : "  stopped: " + text(one.marcher->status(0).end));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--calibrate") == 0) {
    calibrate();
    return 0;
  }
  const bool schemes = argc > 1 && std::strcmp(argv[1], "--schemes") == 0;
  const int next = schemes ? 2 : 1;
  int rounds = 7, only_lanes = 0;
  std::string rows;
  for (int k = next; k + 1 < argc; k += 2) {
    if (std::strcmp(argv[k], "--rounds") == 0) rounds = std::max(1, std::atoi(argv[k + 1]));
    if (std::strcmp(argv[k], "--rows") == 0) rows = argv[k + 1];
    if (std::strcmp(argv[k], "--lanes") == 0) only_lanes = std::atoi(argv[k + 1]);
  }
  Catalogue catalogue = Catalogue::standard();
  Registry registry;
  catalogue.open_all(registry);
  if (!registry.time("newmark-dumont-paoli") || !registry.contact("signorini")) {
    fmt::print(stderr, "bench_march: plugins not found beside the program\n");
    return 4;
  }
  std::vector<Case> cases;
  if (schemes) {
    add_schemes(registry, cases);
    measure_rounds(cases, rounds);
    print_schemes(cases);
    return 0;
  }
  const auto add = [&](std::string name, StopsSpec::Place place, std::string mass, std::string velocity,
                       OperatorKind kind, Watch watch = Watch::nothing) {
    if (name.find(rows) == std::string::npos) return;
    for (const int lanes : {1, 8, 16, 32}) {
      if (watch != Watch::nothing && lanes > 1) continue;
      if (only_lanes != 0 && lanes != only_lanes) continue;
      Case one{name, place, mass, velocity, kind, lanes, {}, nullptr, nullptr, nullptr, nullptr, 0};
      const auto* mass_entry = registry.mass(mass);
      std::map<std::string, ParameterValue> values;
      if (!velocity.empty()) values["velocity"] = velocity;
      auto problem = std::make_shared<const SemiDiscrete>(std::get<SemiDiscrete>(
          discretise(reference_beam(place), 50, *mass_entry->make(defaults(mass_entry->manual, values)))));
      auto law = registry.contact("signorini")->make({});
      const auto* time = registry.time("newmark-dumont-paoli");
      const double h = 2 * 3.14159265358979324 / 10 / 6000;
      auto plan = time->make(defaults(time->manual, {{"beta", 0.5}}))->plan(h, problem_facts(*problem, *law));
      std::vector<LaneSpec> specs;
      for (int k = 0; k < lanes; ++k) {
        specs.push_back(scene_lane(*problem, {}));
        specs.back().amplitude = 0.088 + 0.0005 * k;
      }
      CompileOptions options;
      options.kind = kind;
      auto program = compile(problem, std::get<StepPlan>(plan), h, std::move(law), specs, options);
      one.name += fmt::format(" ({})", operator_name(std::get<Program>(program).kind));
      one.marcher = std::make_unique<Marcher>(std::move(std::get<Program>(program)));
      if (watch == Watch::samples) {
        SampleGrid grid;
        for (int k = 0; k < 4000; ++k) grid.times.push_back(k * steps_per_sample * h);
        sample_places(1.501, 64, grid);
        one.sampler = std::make_unique<MotionSampler>(*one.marcher, grid);
        for (int k = 0; k < 24000 / steps_per_sample; ++k) one.sampler->next();
      } else {
        if (watch != Watch::nothing) one.audit = std::make_unique<EnergyAudit>(*one.marcher, SamplingMode::seldom);
        if (watch == Watch::impacts) one.recorder = std::make_unique<ImpactRecorder>(*one.marcher);
        one.marcher->start(one.observers());
        one.marcher->march(24000, one.observers());  // into the impacting regime
      }
      cases.push_back(std::move(one));
    }
  };
  const auto nodes = StopsSpec::Place::nodes, tip = StopsSpec::Place::tip;
  add("consistent, all nodes", nodes, "consistent", "", OperatorKind::band);
  add("lumped, all nodes", nodes, "lumped", "", OperatorKind::band);
  add("singular P0, all nodes", nodes, "singular", "P0", OperatorKind::band);
  add("singular P1, all nodes", nodes, "singular", "P1", OperatorKind::band);
  add("singular P1, tip", tip, "singular", "P1", OperatorKind::automatic);
  add("consistent, tip", tip, "consistent", "", OperatorKind::automatic);
  add("consistent, tip, band", tip, "consistent", "", OperatorKind::band);
  add("consistent, all nodes, energy audit", nodes, "consistent", "", OperatorKind::band, Watch::energy);
  add("consistent, all nodes, audit and impacts", nodes, "consistent", "", OperatorKind::band, Watch::impacts);
  add("consistent, tip, energy audit", tip, "consistent", "", OperatorKind::automatic, Watch::energy);
  add("consistent, tip, audit and impacts", tip, "consistent", "", OperatorKind::automatic, Watch::impacts);
  add("consistent, all nodes, sampled", nodes, "consistent", "", OperatorKind::band, Watch::samples);
  add("consistent, sparse", nodes, "consistent", "", OperatorKind::sparse);

  const double peak = measure_rounds(cases, rounds);
  fmt::print("reference scene: N = 50, alpha = 1e-4, forced at 10 rad/s, 6000 steps per period, Signorini\n");
  fmt::print("kernels: {}; FMA peak {:.1f} per ns; {} interleaved rounds, median [fastest, slowest]\n\n",
             lane_instruction_set(), peak, rounds);
  fmt::print("{:<44} {:>5} {:>12} {:>22} {:>10} {:>16} {:>10}\n", "case", "lanes", "ns/lane-step", "spread",
             "predicted", "at peak, 2000 FMA", "ratio");
  int wrong = 0;
  for (Case& one : cases) {
    std::sort(one.nanoseconds.begin(), one.nanoseconds.end());
    const double median = one.nanoseconds[one.nanoseconds.size() / 2];
    // Multiply-adds of one band step at n = 100: product 7, substitution 7, combination and update 7 per row, rounded.
    const double ideal = peak > 0 ? 2000 / peak : 0;
    const double predicted = 1e9 * one.marcher->program().predicted_step_seconds / one.lanes;
    const bool far = predicted > within * median || within * predicted < median;
    wrong += far;
    fmt::print("{:<44} {:>5} {:>12.1f} {:>22} {:>10.1f} {:>16.1f} {:>10.2f}{}\n", one.name, one.lanes, median,
               fmt::format("[{:.1f}, {:.1f}]", one.nanoseconds.front(), one.nanoseconds.back()), predicted, ideal,
               ideal > 0 ? median / ideal : 0, far ? "  predicted wrongly" : "");
    for (int lane = 0; lane < one.lanes; ++lane)
      if (!one.marcher->status(lane).running)
        fmt::print("  lane {} stopped: {}\n", lane, text(one.marcher->status(lane).end));
  }
  fmt::print("\n{} of {} predictions are further than × {:g} from what was measured\n", wrong, cases.size(), within);
  return wrong > 0 ? 1 : 0;
}
