// Matrices of a program of finite elements beside what sixty lines of Eigen and CHOLMOD take for them (fair_plate.cpp):
// a plate clamped at one side, pushed at its tip, between stops at eight nodes. µs per step, set-up, memory, and the
// slowest modes. Ours with the audit of energy and the recorder of impacts. Newmark–Dumont–Paoli, β = ½, e = 0.
//
//     bench_plate [--rounds N] [--share S] [--modes N] [--only DOFS]
#include <fmt/format.h>
#include <unistd.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
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
#include <ricochet/scene/basis/modal_basis.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "tests/benchmarks/fair_plate.hpp"
#include "tests/benchmarks/held_bytes.hpp"
#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/shown_range.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

constexpr double h = 1e-4, gap = 2e-4, force = 300, pulsation = 60, viscosity = 1e-5;

using Element = Eigen::Matrix<double, 12, 12>;

// A rectangle a × b of a Kirchhoff plate with w and both slopes at its corners (Adini, Clough and Melosh).
std::array<Element, 2> element(double a, double b, double bending, double poisson, double mass) {
  constexpr std::array<std::array<int, 2>, 12> powers{
      {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}, {3, 1}, {1, 3}}};
  const auto derivative = [&](double x, double y, int along, int across) {
    Eigen::Matrix<double, 1, 12> out;
    for (int k = 0; k < 12; ++k) {
      const auto [p, q] = powers[static_cast<std::size_t>(k)];
      double value = p < along || q < across ? 0 : 1;
      for (int i = 0; i < along; ++i) value *= p - i;
      for (int i = 0; i < across; ++i) value *= q - i;
      out[k] = value == 0 ? 0 : value * std::pow(x, p - along) * std::pow(y, q - across);
    }
    return out;
  };
  Element values;
  int row = 0;
  for (const auto& [x, y] : {std::pair(0.0, 0.0), {a, 0.0}, {a, b}, {0.0, b}}) {
    values.row(row++) = derivative(x, y, 0, 0);
    values.row(row++) = derivative(x, y, 0, 1);
    values.row(row++) = -derivative(x, y, 1, 0);
  }
  const Element shapes = values.inverse();
  const Eigen::Matrix3d law{
      {bending, poisson * bending, 0}, {poisson * bending, bending, 0}, {0, 0, bending * (1 - poisson) / 2}};
  Element K = Element::Zero(), M = Element::Zero();
  for (const GaussPoint& i : gauss_points())
    for (const GaussPoint& j : gauss_points()) {
      const double x = a * i.xi, y = b * j.xi, weight = a * b * i.weight * j.weight;
      Eigen::Matrix<double, 3, 12> strain;
      strain << derivative(x, y, 2, 0), derivative(x, y, 0, 2), 2 * derivative(x, y, 1, 1);
      strain = (strain * shapes).eval();
      const Eigen::Matrix<double, 1, 12> at = derivative(x, y, 0, 0) * shapes;
      K += weight * strain.transpose() * law * strain;
      M += weight * mass * at.transpose() * at;
    }
  return {(K + K.transpose()) / 2, (M + M.transpose()) / 2};
}

struct Plate {
  int along, across;
  AssembledFiles files;
  int node(int i, int j) const { return i * (across + 1) + j; }
  std::string name(int i, int j) const { return fmt::format("N{}_{}", i, j); }
};

// A steel plate of a metre, 5 mm thick, clamped at x = 0.
Plate plate(int along, int across) {
  constexpr double young = 2e11, poisson = 0.3, density = 7800, thick = 5e-3;
  Plate out{along, across, {}};
  const double bending = young * thick * thick * thick / 12 / (1 - poisson * poisson);
  const auto [K, M] = element(1.0 / along, 1.0 / across, bending, poisson, density * thick);
  const int n = 3 * (along + 1) * (across + 1);
  std::vector<Eigen::Triplet<double>> stiff, heavy;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      const int corners[] = {out.node(i, j), out.node(i + 1, j), out.node(i + 1, j + 1), out.node(i, j + 1)};
      for (int p = 0; p < 12; ++p)
        for (int q = 0; q < 12; ++q) {
          const int row = 3 * corners[p / 3] + p % 3, column = 3 * corners[q / 3] + q % 3;
          stiff.emplace_back(row, column, K(p, q));
          heavy.emplace_back(row, column, M(p, q));
        }
    }
  out.files.stiffness_name = "K.mtx";
  out.files.mass_name = "M.mtx";
  std::string table = "dof,node,component,x,y,z,held\n";
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= across; ++j)
      for (int k = 0; k < 3; ++k)
        table += fmt::format("{},{},{},{:.9g},{:.9g},0,{}\n", 3 * out.node(i, j) + k + 1, out.name(i, j),
                             std::array{"uz", "rx", "ry"}[static_cast<std::size_t>(k)], 1.0 * i / along,
                             1.0 * j / across, i == 0 ? "fixed" : "");
  out.files.table = read_dof_table(table, "dofs.csv");
  for (const auto& [matrix, entries] :
       {std::pair(&out.files.stiffness.matrix, &stiff), {&out.files.mass.matrix, &heavy}}) {
    matrix->resize(n, n);
    matrix->setFromTriplets(entries->begin(), entries->end());
  }
  return out;
}

struct Scene {
  SceneSpec scene;
  std::shared_ptr<const AssembledStructure> structure;
  std::vector<int> points;
  int loaded = 0;
};

Scene scene_of(const Plate& plate) {
  Scene out;
  out.structure = std::make_shared<const AssembledStructure>(assemble_structure(plate.files));
  out.scene.structure = AssembledSpec{out.structure, {viscosity, 0}, {}};
  const auto place = [&](int i, int j) {
    Place at;
    at.node = plate.name(i, j);
    at.component = "uz";
    return at;
  };
  const auto row = [&](int i, int j) {
    return out.structure->where[static_cast<std::size_t>(3 * plate.node(i, j))].free;
  };
  const int a = plate.along, b = plate.across;
  for (const auto& [i, j] : {std::pair(3 * a / 8, b / 4),
                             {3 * a / 8, 3 * b / 4},
                             {a / 2, b / 3},
                             {5 * a / 8, b / 2},
                             {3 * a / 4, b / 4},
                             {3 * a / 4, 3 * b / 4},
                             {a, b / 4},
                             {a, 3 * b / 4}}) {
    out.scene.stops.named.push_back({plate.name(i, j), place(i, j), {}, -gap, gap});
    out.points.push_back(row(i, j));
  }
  out.scene.load.terms = {
      {true, {}, {}, Formula(fmt::format("{}*sin({}*t)", force, pulsation), "/scene/load", "t"), place(a, b / 2)}};
  out.loaded = row(a, b / 2);
  return out;
}

FairScene fair(const Scene& scene) {
  const AssembledStructure& from = *scene.structure;
  FairScene out;
  out.n = from.dofs();
  out.stiffness_start = from.stiffness.outerIndexPtr();
  out.stiffness_row = from.stiffness.innerIndexPtr();
  out.stiffness = from.stiffness.valuePtr();
  out.mass_start = from.mass.outerIndexPtr();
  out.mass_row = from.mass.innerIndexPtr();
  out.mass = from.mass.valuePtr();
  out.points = static_cast<int>(scene.points.size());
  out.point = scene.points.data();
  out.gap = gap;
  out.loaded = scene.loaded;
  out.force = force;
  out.pulsation = pulsation;
  out.h = h;
  out.damping = viscosity;
  return out;
}

FairResult ours(const Scene& scene, Registry& registry, long long steps, OperatorKind& kind) {
  FairResult out;
  const double held = held_bytes(), begun = thread_nanoseconds();
  const auto* mass = registry.mass("consistent");
  const auto problem = std::make_shared<const SemiDiscrete>(
      std::get<SemiDiscrete>(discretise(scene.scene, 1, *mass->make(defaults(mass->manual)))));
  auto law = registry.contact("signorini")->make({});
  const auto* time = registry.time("newmark-dumont-paoli");
  auto plan =
      time->make(defaults(time->manual, {{"beta", 0.5}, {"restitution", 0.0}}))->plan(h, problem_facts(*problem, *law));
  CompileOptions options;
  options.march = MarchWay::every_step;
  options.expected_steps = steps;
  Program program = std::get<Program>(
      compile(problem, std::get<StepPlan>(plan), h, std::move(law), {scene_lane(*problem, {})}, options));
  kind = program.kind;
  Marcher marcher(std::move(program));
  EnergyAudit audit(marcher, SamplingMode::seldom);
  ImpactRecorder recorder(marcher);
  out.setup_seconds = 1e-9 * (thread_nanoseconds() - begun);
  const double marched = thread_nanoseconds();
  marcher.start({&audit, &recorder});
  out.bytes = held_bytes() - held;
  marcher.march(steps - marcher.step(), {&audit, &recorder});
  out.step_seconds = 1e-9 * (thread_nanoseconds() - marched) / static_cast<double>(steps);
  out.pushed = audit.contact(0).contact_steps;
  out.impulse = audit.contact(0).impulse;
  out.end = marcher.position(0)[scene.loaded];
  return out;
}

void race(const Plate& made, int rounds, long long steps, int modes, Registry& registry) {
  const Scene scene = scene_of(made);
  const FairScene partner = fair(scene);
  fmt::print("plate, {} dofs, {} entries of K, {} steps, {} rounds\n", partner.n, partner.stiffness_start[partner.n],
             steps, rounds);
  constexpr FairFactor factors[] = {FairFactor::eigen, FairFactor::cholmod_simplicial, FairFactor::cholmod_supernodal};
  constexpr const char* names[] = {"Eigen", "CHOLMOD simplicial", "CHOLMOD supernodal"};
  std::vector<double> step[4], setup[4];
  FairResult last[4];
  OperatorKind kind{};
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < 3; ++k) last[k] = ricochet_fair_march(partner, factors[k], steps);
    last[3] = ours(scene, registry, steps, kind);
    for (std::size_t k = 0; k < 4; ++k) {
      step[k].push_back(last[k].step_seconds);
      setup[k].push_back(last[k].setup_seconds);
    }
  }
  std::size_t best = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (median(step[k]) < median(step[best])) best = k;
  for (std::size_t k = 0; k < 4; ++k)
    fmt::print("  {:<20} step {} µs, set-up {} ms, {:.1f} MB; {} steps in contact, impulse {:.9g}, end {:.9g}\n",
               k < 3 ? names[k] : operator_name(kind), shown_range(step[k], 1e6), shown_range(setup[k], 1e3),
               last[k].bytes / 1e6, last[k].pushed, last[k].impulse, last[k].end);
  fmt::print("  against the fastest ({}): step {:.2f}, set-up {:.2f}, memory {:.2f}\n", names[best],
             median(step[3]) / median(step[best]), median(setup[3]) / median(setup[best]),
             last[3].bytes / last[best].bytes);
  std::vector<double> theirs, own, squares(static_cast<std::size_t>(modes));
  double apart = 0;
  for (int round = 0; round < rounds && modes > 0; ++round) {
    theirs.push_back(ricochet_fair_modes(partner, modes, squares.data()));
    const double begun = thread_nanoseconds();
    const LowestModes found = lowest_modes(scene.structure->stiffness, scene.structure->mass, modes, true);
    own.push_back(1e-9 * (thread_nanoseconds() - begun));
    for (int k = 0; k < modes; ++k)
      apart = std::max(apart, std::abs(found.squares[k] / squares[static_cast<std::size_t>(k)] - 1));
  }
  if (modes > 0)
    fmt::print("  {} modes {} ms, Lanczos beside {} ms: {:.2f}; squares {:.1e} apart\n", modes, shown_range(own, 1e3),
               shown_range(theirs, 1e3), median(own) / median(theirs), apart);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (!std::getenv("OPENBLAS_NUM_THREADS")) {
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    execv("/proc/self/exe", argv);
  }
  int rounds = 5, modes = 20, only = 0;
  double share = 1;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::max(1, std::atoi(argv[i + 1]));
    if (std::strcmp(argv[i], "--share") == 0) share = std::atof(argv[i + 1]);
    if (std::strcmp(argv[i], "--modes") == 0) modes = std::max(0, std::atoi(argv[i + 1]));
    if (std::strcmp(argv[i], "--only") == 0) only = std::atoi(argv[i + 1]);
  }
  const FlushDenormals flush;
  Catalogue catalogue = Catalogue::standard();
  Registry registry;
  catalogue.open_all(registry);
  if (!registry.time("newmark-dumont-paoli") || !registry.contact("signorini") || !registry.mass("consistent")) {
    fmt::print(stderr, "bench_plate: plugins not found beside the program\n");
    return 4;
  }
  fmt::print("kernels: {}\n", lane_instruction_set());
  for (const auto& [along, across, steps] : {std::tuple(18, 17, 4000), {58, 57, 600}, {100, 99, 200}}) {
    if (only != 0 && only != 3 * along * (across + 1)) continue;
    race(plate(along, across), rounds, std::max(10LL, std::llround(share * steps)), modes, registry);
  }
}
