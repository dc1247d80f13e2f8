// Moreau–Jean (θ = ½, e = 0) on the reference beam, 50 elements, consistent mass: the time per step of Siconos beside
// that of this marcher with energy audit and recorder of impacts, in one run. First both march the same steps, and how
// far apart they are is printed; then interleaved rounds, medians with their range.
//
//     bench_siconos [--rounds N] [--only WORD]
//
// Built where Siconos is found: Debian packages libsiconos-kernel-dev and libsiconos-numerics-dev (4.4; with them
// libopenblas0). It marches without plugins, residuals or Newton iterations, as Debian builds it, that is with its
// assertions. Its linear algebra runs on one thread. Denormal numbers are zero for both.
//
// What the comparison leaves out: Siconos is general. The same step also marches nonlinear bodies in space with
// friction, and relations that come and go. It stores what that needs, and asks every relation in every step. Here it
// is asked for one linear beam, in each form that it has for such. It audits nothing; the works, energies and impacts
// of this marcher are in its time.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <optional>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <ricochet/scene/semi_discrete.hpp>

#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/shaken_beam.hpp"
#include "tests/benchmarks/siconos_beam.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

constexpr long long study_steps = 100000;  // of an integration of this marcher
constexpr long long common_steps = 12000;  // that both march first
constexpr long long siconos_steps = 3000;  // of a round: half a period

struct Scene {
  std::string name;
  SceneSpec scene;
  double h = 0;
};

std::vector<Scene> scenes() {
  std::vector<Scene> list;
  for (const auto place : {StopsSpec::Place::nodes, StopsSpec::Place::tip}) {
    const char* where = place == StopsSpec::Place::nodes ? "stops at all nodes" : "stops at the tip";
    list.push_back({fmt::format("forced, {}", where), reference_beam(place), 2 * std::numbers::pi / 10 / 6000});
    Scene swing{fmt::format("free swing, {}", where), reference_beam(place), 1e-5};
    swing.scene.support.amplitude = 0;
    swing.scene.initial.displacement = Formula("0.04*x^2", "/scene/initial/displacement", "x");
    swing.scene.initial.velocity = Formula("-2*x", "/scene/initial/velocity", "x");
    list.push_back(swing);
  }
  return list;
}

std::shared_ptr<const SemiDiscrete> problem_of(const Scene& scene, Registry& registry) {
  const auto* mass = registry.mass("consistent");
  return std::make_shared<const SemiDiscrete>(
      std::get<SemiDiscrete>(discretise(scene.scene, 50, *mass->make(defaults(mass->manual)))));
}

// An integration of this marcher with its audit and its recorder of impacts.
struct Audited {
  Marcher marcher;
  EnergyAudit audit;
  ImpactRecorder recorder;
  Audited(const std::shared_ptr<const SemiDiscrete>& problem, double h, MarchWay way, Registry& registry)
      : marcher(program(problem, h, way, registry)), audit(marcher, SamplingMode::seldom), recorder(marcher) {
    marcher.start({&audit, &recorder});
  }
  void march(long long until) { marcher.march(until - marcher.step(), {&audit, &recorder}); }

  static Program program(const std::shared_ptr<const SemiDiscrete>& problem, double h, MarchWay way,
                         Registry& registry) {
    auto law = registry.contact("signorini")->make({});
    const auto* time = registry.time("moreau-jean");
    auto plan = time->make(defaults(time->manual, {{"theta", 0.5}, {"restitution", 0.0}}))
                    ->plan(h, problem_facts(*problem, *law));
    CompileOptions options;
    options.march = way;
    options.expected_steps = study_steps;
    return std::get<Program>(
        compile(problem, std::get<StepPlan>(plan), h, std::move(law), {scene_lane(*problem, {})}, options));
  }
};

struct Contestant {
  std::string name;
  std::optional<SiconosBeam> siconos;
  MarchWay way = MarchWay::every_step;
  std::vector<double> microseconds = {};
};

// Both march the same steps from the same state; what is printed is how far their tips are apart.
void compare(const std::string& name, SiconosBeam& siconos, const std::shared_ptr<const SemiDiscrete>& problem,
             double h, Registry& registry) {
  Audited ours(problem, h, MarchWay::every_step, registry);
  double apart = 0, early = 0, largest = 0, impulse = 0;
  long long contact = 0, points = 0, parted = 0, our_points = 0;
  for (long long k = 1; k <= common_steps; ++k) {
    siconos.step();
    ours.march(k);
    const double distance = std::abs(siconos.tip() - ours.marcher.tip(0));
    apart = std::max(apart, distance);
    if (k <= common_steps / 2) early = apart;
    if (parted == 0 && distance > 1e-6) parted = k;
    largest = std::max(largest, std::abs(ours.marcher.tip(0)));
    const int pushed = siconos.pushed();
    contact += pushed > 0;
    points += pushed;
    impulse += siconos.impulse();
    our_points += ours.audit.contact(0).active;
  }
  const ContactTotals& totals = ours.audit.contact(0);
  fmt::print("  {:<34} {:.1e} m, {:.1e} m in the first half, tip up to {:.3f} m{}\n", name, apart, early, largest,
             parted > 0 ? fmt::format("; parted by 1e-6 m at step {}", parted) : "");
  fmt::print("  {:<34} steps in contact {} and {}, points pushed {} and {}, impulse {:.9g} and {:.9g} N s\n", "",
             contact, totals.contact_steps, points, our_points, impulse, totals.impulse);
}

std::string range(const std::vector<double>& values, const char* format) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return fmt::format(fmt::runtime(std::string("[") + format + ", " + format + "]"), *low, *high);
}

void race(const Scene& scene, int rounds, Registry& registry) {
  const auto problem = problem_of(scene, registry);
  const ShakenBeam beam = shaken_beam(*problem);
  using Form = SiconosBeam::Form;
  using Leaving = SiconosBeam::Leaving;
  using Solver = SiconosBeam::Solver;
  const long long steps = common_steps + siconos_steps * rounds;
  const auto made = [&](Form form, Leaving leaving, Solver solver) {
    return SiconosBeam(beam, scene.h, steps, form, leaving, solver);
  };
  fmt::print("{}: h = {:.6g} s, {} dofs, {} relations\n", scene.name, scene.h, problem->dofs(), 2 * problem->points());
  fmt::print(" tips apart over {} steps (Siconos and this marcher):\n", common_steps);
  std::vector<Contestant> all;
  all.push_back({"Siconos, dense, Lemke", made(Form::dense, Leaving::passing, Solver::lemke)});
  all.push_back({"Siconos, sparse, Lemke", made(Form::sparse, Leaving::passing, Solver::lemke)});
  all.push_back({"Siconos, modes, Lemke", made(Form::modes, Leaving::passing, Solver::lemke)});
  all.push_back({"Siconos, modes, PGS", made(Form::modes, Leaving::passing, Solver::pgs)});
  all.push_back({"Siconos, modes, Lemke, own rule", made(Form::modes, Leaving::stopped, Solver::lemke)});
  for (Contestant& one : all) compare(one.name, *one.siconos, problem, scene.h, registry);
  const std::size_t others = all.size();
  all.push_back({"every step", std::nullopt, MarchWay::every_step});
  all.push_back({"flights", std::nullopt, MarchWay::flights});
  long long visited = 0;
  for (int round = 0; round < rounds; ++round)
    for (Contestant& one : all) {
      const double start = thread_nanoseconds();
      if (one.siconos) {
        for (long long k = 0; k < siconos_steps; ++k) one.siconos->step();
        one.microseconds.push_back((thread_nanoseconds() - start) / 1e3 / siconos_steps);
      } else {
        // Set-up is paid by the integration: it is what a study pays.
        Audited march(problem, scene.h, one.way, registry);
        march.march(study_steps);
        march.recorder.finish(march.marcher);
        one.microseconds.push_back((thread_nanoseconds() - start) / 1e3 / study_steps);
        if (one.way == MarchWay::flights) visited = march.marcher.steps_visited();
      }
    }
  const Program chosen = Audited::program(problem, scene.h, MarchWay::automatic, registry);
  fmt::print(" `auto` chooses {} for {} steps; flights visit {} of them\n", chosen.flight ? "flights" : "every step",
             study_steps, visited);
  fmt::print(" {:<34} {:>8} {:>12} {:>18} {:>22} {:>22}\n", "µs per step", "steps", "median", "range", "/ every step",
             "/ flights");
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Contestant& one = all[k];
    std::vector<double> ratios[2];
    for (std::size_t round = 0; round < one.microseconds.size(); ++round)
      for (std::size_t ours = 0; ours < 2; ++ours)
        ratios[ours].push_back(one.microseconds[round] / all[others + ours].microseconds[round]);
    fmt::print(" {:<34} {:>8} {:>12.4g} {:>18}", one.name, one.siconos ? siconos_steps : study_steps,
               median(one.microseconds), range(one.microseconds, "{:.4g}"));
    for (const auto& ratio : ratios)
      fmt::print(" {:>22}", k < others ? fmt::format("{:.0f} {}", median(ratio), range(ratio, "{:.0f}")) : "");
    fmt::print("\n");
  }
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  // Read by the library of linear algebra when it begins: a program that has not been told starts itself again.
  if (!std::getenv("OPENBLAS_NUM_THREADS")) {
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    execv("/proc/self/exe", argv);
  }
  int rounds = 5;
  std::string only;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::max(1, std::atoi(argv[i + 1]));
    if (std::strcmp(argv[i], "--only") == 0) only = argv[i + 1];
  }
  const FlushDenormals flush;
  Catalogue catalogue = Catalogue::standard();
  Registry registry;
  catalogue.open_all(registry);
  if (!registry.time("moreau-jean") || !registry.contact("signorini") || !registry.mass("consistent")) {
    fmt::print(stderr, "bench_siconos: plugins not found beside the program\n");
    return 4;
  }
  fmt::print(
      "reference beam, 50 elements, consistent mass, alpha = 1e-4; Moreau-Jean, theta = 1/2, e = 0; {} rounds; "
      "OPENBLAS_NUM_THREADS = {}\n",
      rounds, std::getenv("OPENBLAS_NUM_THREADS"));
  fmt::print(
      "left out: Siconos is general (nonlinear bodies in space, friction, relations that come and go), and pays for it "
      "here;\nit audits nothing, energies and impacts of this marcher are in its time; Debian builds it with "
      "assertions\n\n");
  for (const Scene& scene : scenes())
    if (scene.name.find(only) != std::string::npos) race(scene, rounds, registry);
}
