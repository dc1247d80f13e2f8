// Orbits of a sweep beside what a loop over modes and lanes takes for them (fair_sweep.cpp): the reference beam in its
// modes, a stop on each side of its tip, consistent mass, Signorini, Newmark–Dumont–Paoli β = ½, e = 0. A chain is one
// lane, a block 8 to 32 of them. Ours with checks of energy; transient and kept periods (sections, impacts). ns per
// lane-step, processor time of one thread.
//
//     bench_sweep [--rounds N] [--periods P] [--elements N] [--steps N]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/orbits/section_march.hpp>

#include "tests/benchmarks/fair_sweep.hpp"
#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/shown_range.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

constexpr double pulsation = 10, gap = 0.1, viscosity = 1e-4;

struct Setting {
  int rounds = 5, periods = 20, elements = 20, steps = 0;
};

struct Sweep {
  const Registry& registry;
  int elements, steps_per_period;
  double from, to;  // amplitudes, m

  double h() const { return 2 * std::numbers::pi / pulsation / steps_per_period; }
  double amplitude(int lane, int lanes) const { return from + (to - from) * (lane + 0.5) / lanes; }

  Program program(int lanes) const {
    const SceneSpec scene = reference_beam(StopsSpec::Place::tip);
    const auto* mass = registry.mass("consistent");
    const auto* law = registry.contact("signorini");
    const auto* scheme = registry.time("newmark-dumont-paoli");
    const auto problem = std::make_shared<const SemiDiscrete>(
        std::get<SemiDiscrete>(discretise(scene, elements, *mass->make(defaults(mass->manual)))));
    auto made = law->make(defaults(law->manual));
    const auto plan = std::get<StepPlan>(scheme->make(defaults(scheme->manual, {{"beta", 0.5}, {"restitution", 0.0}}))
                                             ->plan(h(), problem_facts(*problem, *made)));
    std::vector<LaneSpec> block(static_cast<std::size_t>(lanes), scene_lane(*problem, defaults(law->manual)));
    for (int lane = 0; lane < lanes; ++lane) block[static_cast<std::size_t>(lane)].amplitude = amplitude(lane, lanes);
    CompileOptions options;
    options.kind = OperatorKind::modal;
    options.expected_steps = 100000000;
    return std::get<Program>(compile(problem, plan, h(), std::move(made), std::move(block), options));
  }

  // A block past its first periods, so that contact is what it is later on.
  std::unique_ptr<SectionMarch> block(int lanes, bool kept) const {
    SectionPlan plan;
    plan.pulsation = pulsation;
    plan.steps_per_period = steps_per_period;
    plan.transient = plan.at_most = kept ? 2 : 1000000;
    plan.keep = 1000000;
    plan.scale = gap;
    const StartedOrbits started = start_orbits(program(lanes), plan);
    auto march = std::make_unique<SectionMarch>(program(lanes), plan);
    for (int lane = 0; lane < lanes; ++lane) {
      Orbit orbit;
      orbit.lane = march->marcher().program().lanes[static_cast<std::size_t>(lane)];
      orbit.now = started.states[static_cast<std::size_t>(lane)];
      march->load(lane, orbit);
    }
    for (int n = 0; n < 4; ++n) march->period();
    return march;
  }
};

// The numbers that the fair program works with, from where a block stands now.
struct FairInput {
  std::vector<double> stiffness, mass, tip, shape, force, clamp, amplitude, place, before;
  FairModes scene;

  FairInput(const SectionMarch& march, const Sweep& sweep, int periods) {
    const Marcher& marcher = march.marcher();
    const Program& program = marcher.program();
    const MarchModel& model = *program.model;
    const int n = model.rows(), lanes = marcher.lanes();
    const Eigen::VectorXd K = model.stiffness().diagonal(), M = model.inertia().mass.diagonal();
    stiffness.assign(K.data(), K.data() + n);
    mass.assign(M.data(), M.data() + n);
    tip = model.tip().value;
    const Eigen::VectorXd& load = model.support_shape();
    shape.assign(load.data(), load.data() + n);
    const PhaseWeights &push = program.stages[0].load_phase, &lift = program.stages[0].measure_phase;
    for (int k = 0; k < sweep.steps_per_period; ++k) {
      const double t = pulsation * static_cast<double>(marcher.step() + k) * sweep.h();
      force.push_back(pulsation * pulsation * (push.along * std::sin(t) + push.across * std::cos(t)));
      clamp.push_back(lift.along * std::sin(t) + lift.across * std::cos(t));
    }
    for (int lane = 0; lane < lanes; ++lane) amplitude.push_back(sweep.amplitude(lane, lanes));
    for (int i = 0; i < n; ++i)
      for (int lane = 0; lane < lanes; ++lane) {
        const auto at = static_cast<std::ptrdiff_t>(i) * marcher.width() + lane;
        place.push_back(marcher.slot(0)[at]);
        before.push_back(marcher.slot(0)[at] - marcher.slot(1)[at]);
      }
    scene = {n,
             lanes,
             sweep.steps_per_period,
             periods,
             stiffness.data(),
             mass.data(),
             tip.data(),
             shape.data(),
             viscosity,
             sweep.h(),
             gap,
             force.data(),
             clamp.data(),
             amplitude.data(),
             place.data(),
             before.data()};
  }
};

void race(const Sweep& sweep, int lanes, const Setting& setting) {
  auto transient = sweep.block(lanes, false), kept = sweep.block(lanes, true);
  const double lane_steps = 1.0 * setting.periods * sweep.steps_per_period * lanes;
  const auto march = [&](SectionMarch& block) {
    const double begun = thread_nanoseconds();
    for (int n = 0; n < setting.periods; ++n) block.period();
    return 1e-9 * (thread_nanoseconds() - begun) / lane_steps;
  };
  std::vector<double> theirs, ours, watched, ratio, watched_ratio;
  FairSweep last;
  double end = 0;
  for (int round = 0; round < setting.rounds; ++round) {
    const FairInput input(*transient, sweep, setting.periods);
    last = ricochet_fair_sweep(input.scene);
    theirs.push_back(last.lane_step_seconds);
    ours.push_back(march(*transient));
    watched.push_back(march(*kept));
    ratio.push_back(ours.back() / theirs.back());
    watched_ratio.push_back(watched.back() / theirs.back());
    end = 0;
    const Marcher& marcher = transient->marcher();
    for (std::size_t i = 0; i < input.tip.size(); ++i)
      end += input.tip[i] * marcher.slot(0)[static_cast<std::ptrdiff_t>(i) * marcher.width() + lanes - 1];
  }
  fmt::print(
      "  {:2} lanes: beside {}, ours {}, kept {} ns; ratio {:.2f}, kept {:.2f}; {:.1f} % in contact; ends {:.9g}, "
      "{:.9g}\n",
      lanes, shown_range(theirs, 1e9), shown_range(ours, 1e9), shown_range(watched, 1e9), median(ratio),
      median(watched_ratio), 100.0 * static_cast<double>(last.pushed) / lane_steps, last.end, end);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Setting setting;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) setting.rounds = std::max(1, std::atoi(argv[i + 1]));
    if (std::strcmp(argv[i], "--periods") == 0) setting.periods = std::max(1, std::atoi(argv[i + 1]));
    if (std::strcmp(argv[i], "--elements") == 0) setting.elements = std::max(1, std::atoi(argv[i + 1]));
    if (std::strcmp(argv[i], "--steps") == 0) setting.steps = std::max(8, std::atoi(argv[i + 1]) / 2 * 2);
  }
  const FlushDenormals flush;
  Catalogue catalogue = Catalogue::standard();
  Registry registry;
  catalogue.open_all(registry);
  if (!registry.time("newmark-dumont-paoli") || !registry.contact("signorini") || !registry.mass("consistent")) {
    fmt::print(stderr, "bench_sweep: plugins not found beside the program\n");
    return 4;
  }
  fmt::print("kernels: {}\n", lane_instruction_set());
  for (const auto& [name, steps, from, to] :
       {std::tuple("a diagram", 6000, 0.0699, 0.0999), {"basins", 1000, 0.07, 0.07}}) {
    const int made = setting.steps > 0 ? setting.steps : steps;
    fmt::print("{}: {} modes, {} steps per period, amplitudes {} to {} m\n", name, 2 * setting.elements, made, from,
               to);
    for (const int lanes : {1, 8, 16, 32}) race({registry, setting.elements, made, from, to}, lanes, setting);
  }
}
