// Structures of their own, µs per step. One is a beam of 200 elements on twelve pins with forty named stops. The other
// is a net of 10^4 dofs given by its matrices with twenty stops. Both are marched once more in 60 modes. What contact,
// audit and recorder of impacts add to the linear step, by leaving them out. Where Siconos is found, the beam beside
// it, as bench_siconos does: Moreau–Jean, θ = ½, e = 0.
//
//     bench_own [--rounds N] [--steps N]
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "tests/benchmarks/reference_beam.hpp"
#ifdef RICOCHET_SICONOS
#include "tests/benchmarks/shaken_beam.hpp"
#include "tests/benchmarks/siconos_beam.hpp"
#endif
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

struct Scene {
  std::string name;
  SceneSpec scene;
  int elements = 1;
  double h = 0;
  std::vector<OperatorKind> kinds;
};

// Spans of 1 m, shaken near their first frequency, with four stops in each of ten.
Scene tube() {
  constexpr int pins = 12, spans = 10;
  BeamSpec beam;
  beam.length = pins - 1;
  beam.young = 2e11;
  beam.density = 8470;
  beam.section.outer_diameter = 0.01905;
  beam.section.wall = 0.00109;
  beam.damping.stiffness = 5e-5;
  beam.supports.emplace();
  for (int i = 0; i < pins; ++i)
    beam.supports->push_back({.name = fmt::format("pin{}", i), .x = 1.0 * i, .type = BeamSupport::Type::pinned});
  Scene one{"beam, 200 elements, 12 pins, 40 stops", {}, 200, 1e-5, {OperatorKind::band, OperatorKind::modal}};
  one.scene.structure = beam;
  one.scene.support = {2e-5, 2 * std::numbers::pi * 48, 0};
  for (int i = 0; i < spans; ++i)
    for (const double x : {0.2, 0.4, 0.6, 0.8}) {
      Place at;
      at.x = i + x;
      one.scene.stops.named.push_back({fmt::format("s{}-{:.0f}", i, 10 * x), at, {}, -5e-5, 5e-5});
    }
  return one;
}

// A square net of springs, held at its edge, pushed in its middle.
Scene net() {
  constexpr int side = 100, n = side * side;
  const auto dof = [](int i, int j) { return side * i + j; };
  AssembledFiles files;
  files.stiffness_name = "K.mtx";
  files.mass_name = "M.mtx";
  std::string table = "dof,node,component,x,y,z,held\n";
  std::vector<Eigen::Triplet<double>> K;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      table += fmt::format("{},{}-{},uz,{},{},0,\n", dof(i, j) + 1, i, j, i, j);
      K.emplace_back(dof(i, j), dof(i, j), 4e6);
      for (const auto& [a, b] : {std::pair(i + 1, j), {i, j + 1}})
        if (a < side && b < side) {
          K.emplace_back(dof(i, j), dof(a, b), -1e6);
          K.emplace_back(dof(a, b), dof(i, j), -1e6);
        }
    }
  files.table = read_dof_table(table, "dofs.csv");
  files.stiffness.matrix.resize(n, n);
  files.stiffness.matrix.setFromTriplets(K.begin(), K.end());
  files.mass.matrix.resize(n, n);
  files.mass.matrix.setIdentity();
  Scene one{"matrices, 10000 dofs, 20 stops", {}, 1, 1e-4, {OperatorKind::band, OperatorKind::sparse}};
  one.scene.structure =
      AssembledSpec{std::make_shared<const AssembledStructure>(assemble_structure(files)), {1e-6, 0}, {}};
  const auto node = [](int i, int j) {
    Place at;
    at.node = fmt::format("{}-{}", i, j);
    at.component = "uz";
    return at;
  };
  for (int k = 0; k < 20; ++k)
    one.scene.stops.named.push_back({fmt::format("s{}", k), node(30 + 2 * k, 50), {}, -1e-3, 1e-3});
  one.scene.load.terms = {{true, {}, {}, Formula("4e4*sin(60*t)", "/scene/load", "t"), node(50, 52)}};
  return one;
}

// The same scene in its slowest modes, and the static shapes of its stops.
Scene in_modes(Scene scene, int modes) {
  scene.name += fmt::format(", in {} modes and the residual of the stops", modes);
  scene.scene.basis = BasisSpec{modes, true};
  scene.kinds = {OperatorKind::modal};
  return scene;
}

// What an integration looks at.
enum class Observed { nothing, contact, all };

Program program(const std::shared_ptr<const SemiDiscrete>& problem, const Scene& scene, OperatorKind kind,
                Registry& registry, bool contact) {
  auto law = registry.contact(contact ? "signorini" : "none")->make({});
  const auto* time = registry.time("moreau-jean");
  auto plan = time->make(defaults(time->manual, {{"theta", 0.5}, {"restitution", 0.0}}))
                  ->plan(scene.h, problem_facts(*problem, *law));
  CompileOptions options;
  options.march = MarchWay::every_step;
  options.kind = kind;
  return std::get<Program>(
      compile(problem, std::get<StepPlan>(plan), scene.h, std::move(law), {scene_lane(*problem, {})}, options));
}

// µs per step; set-up apart. `pushed`: steps in contact.
double microseconds(const std::shared_ptr<const SemiDiscrete>& problem, const Scene& scene, OperatorKind kind,
                    Registry& registry, Observed observed, long long steps, double& pushed) {
  Marcher marcher(program(problem, scene, kind, registry, observed != Observed::nothing));
  EnergyAudit audit(marcher, SamplingMode::seldom);
  ImpactRecorder recorder(marcher);
  double start = 0;
  if (observed == Observed::all) {
    marcher.start({&audit, &recorder});
    start = thread_nanoseconds();
    marcher.march(steps, {&audit, &recorder});
    pushed = static_cast<double>(audit.contact(0).contact_steps) / static_cast<double>(steps);
  } else {
    marcher.start();
    start = thread_nanoseconds();
    marcher.march(steps);
  }
  return (thread_nanoseconds() - start) / 1e3 / static_cast<double>(steps);
}

std::string shown(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", median(values), *low, *high);
}

const char* name_of(OperatorKind kind) {
  return kind == OperatorKind::band ? "band" : kind == OperatorKind::modal ? "modal" : "CHOLMOD";
}

#ifdef RICOCHET_SICONOS
// Both march the same steps; then rounds of the partner alone, whose times follow each other.
void beside(const Scene& scene, const std::shared_ptr<const SemiDiscrete>& problem, int rounds, Registry& registry) {
  constexpr long long common = 4000, timed = 400;
  const std::pair<const char*, SiconosBeam::Form> forms[] = {{"Siconos, M, K, C dense", SiconosBeam::Form::dense},
                                                             {"Siconos, in modes", SiconosBeam::Form::modes}};
  for (const auto& [name, form] : forms) {
    SiconosBeam partner(shaken_beam(*problem), scene.h, common + timed * rounds, form, SiconosBeam::Leaving::passing,
                        SiconosBeam::Solver::lemke);
    Marcher ours(program(problem, scene, scene.kinds.front(), registry, true));
    ours.start();
    double apart = 0, largest = 0;
    for (long long k = 1; k <= common; ++k) {
      partner.step();
      if (ours.step() < k) ours.march(k - ours.step());
      apart = std::max(apart, std::abs(partner.tip() - ours.tip(0)));
      largest = std::max(largest, std::abs(ours.tip(0)));
    }
    std::vector<double> times;
    for (int round = 0; round < rounds; ++round) {
      const double start = thread_nanoseconds();
      for (long long k = 0; k < timed; ++k) partner.step();
      times.push_back((thread_nanoseconds() - start) / 1e3 / timed);
    }
    fmt::print("  {:<26} {}; over {} steps {:.1e} m apart, tip up to {:.1e} m\n", name, shown(times), common, apart,
               largest);
  }
}
#endif

void race(const Scene& scene, int rounds, long long steps, Registry& registry) {
  const auto* mass = registry.mass("consistent");
  const auto problem = std::make_shared<const SemiDiscrete>(
      std::get<SemiDiscrete>(discretise(scene.scene, scene.elements, *mass->make(defaults(mass->manual)))));
  fmt::print("{}: {} dofs, h = {:g} s, {} steps, {} rounds\n", scene.name, problem->dofs(), scene.h, steps, rounds);
  for (const OperatorKind kind : scene.kinds) {
    std::vector<double> times[3];
    double pushed = 0;
    for (int round = 0; round < rounds; ++round)
      for (const Observed observed : {Observed::nothing, Observed::contact, Observed::all})
        times[static_cast<std::size_t>(observed)].push_back(
            microseconds(problem, scene, kind, registry, observed, steps, pushed));
    const double linear = median(times[0]), contact = median(times[1]), all = median(times[2]);
    fmt::print("  {:<8} without stops {}; with stops {}; with audit and recorder {}\n", name_of(kind), shown(times[0]),
               shown(times[1]), shown(times[2]));
    fmt::print(
        "  {:<8} shares: linear {:.0f} %, contact {:.0f} %, audit and recorder {:.0f} %; {:.0f} % of the steps in "
        "contact\n",
        "", 100 * linear / all, 100 * (contact - linear) / all, 100 * (all - contact) / all, 100 * pushed);
  }
#ifdef RICOCHET_SICONOS
  if (!problem->space.given && !problem->basis) beside(scene, problem, rounds, registry);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  if (!std::getenv("OPENBLAS_NUM_THREADS")) {
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    execv("/proc/self/exe", argv);
  }
  int rounds = 5;
  long long steps = 20000;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::max(1, std::atoi(argv[i + 1]));
    if (std::strcmp(argv[i], "--steps") == 0) steps = std::max(1, std::atoi(argv[i + 1]));
  }
  const FlushDenormals flush;
  Catalogue catalogue = Catalogue::standard();
  Registry registry;
  catalogue.open_all(registry);
  if (!registry.time("moreau-jean") || !registry.contact("signorini") || !registry.mass("consistent")) {
    fmt::print(stderr, "bench_own: plugins not found beside the program\n");
    return 4;
  }
  race(tube(), rounds, steps, registry);
  race(net(), rounds, std::max(1LL, steps / 20), registry);
  race(in_modes(tube(), 60), rounds, steps, registry);
  race(in_modes(net(), 60), rounds, steps, registry);
}
