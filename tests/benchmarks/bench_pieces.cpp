// Pieces of a branch per second of processor time: the shaken tube, singular P1, rigid stops at its tip,
// newmark-dumont-paoli β = ½, α = 1e-4, half map from 0.08 m upwards. What a piece costs with its multipliers and
// without; 5000 pieces at 10 elements and 4000 steps are to take at most 25 s.
//
//     bench_pieces [--elements N] [--steps n] [--pieces P]
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <numbers>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/orbits/branch.hpp>
#include <ricochet/measure/orbits/periodic_map.hpp>

#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

constexpr double pulsation = 10, start = 0.08;

struct Setting {
  int elements = 10, steps = 4000;
  long long pieces = 1000;
};

Program program(double amplitude, const Setting& setting) {
  static Catalogue catalogue(RICOCHET_PLUGIN_DIR, {}, {});
  static const Registry registry = [] {
    Registry opened;
    catalogue.open_all(opened);
    return opened;
  }();
  SceneSpec scene = reference_beam(StopsSpec::Place::tip);
  scene.support.amplitude = amplitude;
  scene.initial = {};
  const auto* mass = registry.mass("singular");
  const auto* law = registry.contact("signorini");
  const auto* scheme = registry.time("newmark-dumont-paoli");
  const auto problem = std::make_shared<const SemiDiscrete>(std::get<SemiDiscrete>(
      discretise(scene, setting.elements, *mass->make(defaults(mass->manual, {{"velocity", std::string("P1")}})))));
  auto made = law->make(defaults(law->manual));
  const double h = 2 * std::numbers::pi / pulsation / setting.steps;
  const auto plan = std::get<StepPlan>(scheme->make(defaults(scheme->manual))->plan(h, problem_facts(*problem, *made)));
  CompileOptions options;
  options.moving_support = true;
  options.expected_steps = 100000000;
  return std::get<Program>(
      compile(problem, plan, h, std::move(made), {scene_lane(*problem, defaults(law->manual))}, options));
}

}  // namespace

int main(int argc, char** argv) {
  Setting setting;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--elements") == 0) setting.elements = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--steps") == 0) setting.steps = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--pieces") == 0) setting.pieces = std::atoll(argv[i + 1]);
  }
  const Program low = program(0.05, setting), high = program(0.1, setting);
  PeriodicMap map(program(start, setting), *affine_lane(low.lanes[0], 0.05, high.lanes[0], 0.1),
                  {1.0, low.problem->support.pulsation});
  LaneEnd end;
  const auto state = settle(program(start, setting), setting.steps, 300, end);
  const MapClock clock{setting.steps, 1, true};
  const ShotOrbit orbit = shoot(map, map.vector().read(*state), start, clock, 1e-12);
  if (!orbit.found) {
    fmt::print("no symmetric orbit at {} m\n", start);
    return 1;
  }
  const BranchState begin = branch_start(orbit.x, start, orbit.sets, 1);
  constexpr double round_off = 1e-13;
  const auto timed = [&](const char* what, auto follow) {
    const double begun = thread_nanoseconds();
    const long long made = follow();
    const double each = 1e-6 * (thread_nanoseconds() - begun) / static_cast<double>(made);
    fmt::print("{:<18} {:6} pieces, {:.3f} ms each, 5000 in {:.1f} s\n", what, made, each, 5 * each);
  };
  fmt::print("{} unknowns, {} steps per period\n", map.size(), setting.steps);
  timed("lines alone", [&] {
    PieceFollower follower(map, clock, begin, round_off);
    for (long long piece = 0; piece < setting.pieces; ++piece) follower.go(follower.end_of_piece(0.05, 0.2));
    return follower.state().pieces;
  });
  timed("with multipliers", [&] {
    BranchRun run(map, clock, PieceFollower(map, clock, begin, round_off), {0.05, 0.2});
    run.advance(setting.pieces);
    return run.state().pieces;
  });
}
