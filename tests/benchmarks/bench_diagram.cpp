// The reference bifurcation diagram in lane-steps per second: N = 20 elements, singular P1, Signorini at all nodes,
// newmark-dumont-paoli β = ½, α = 1e-4, 6000 steps per period, amplitudes 0.070 … 0.0999. Blocks of lanes on one and on
// two cores; where the time goes (march, contact, measure); what one tangent column costs with each operator. Medians
// of interleaved rounds, processor time; two cores in wall time, which is only worth what the machine has free.
//
//     bench_diagram [--rounds N] [--lanes T] [--periods P] [--tangents alone]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <numbers>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/orbits/section_march.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <thread>

#include "tests/benchmarks/reference_beam.hpp"
#include "tests/benchmarks/thread_clock.hpp"

using namespace ricochet;
using namespace ricochet::benchmarks;

namespace {

constexpr int steps_per_period = 6000, elements = 20;
constexpr double pulsation = 10, diagram = 500.0 * 600.0 * steps_per_period;

struct Setting {
  int lanes = 8, periods = 40, rounds = 9;
};

const Registry& registry() {
  static Catalogue catalogue(RICOCHET_PLUGIN_DIR, {}, {});
  static const Registry all = [] {
    Registry opened;
    catalogue.open_all(opened);
    return opened;
  }();
  return all;
}

struct Kind {
  StopsSpec::Place place;
  std::string mass = "singular";
  OperatorKind kind = OperatorKind::automatic;
};

Program program(const std::string& law_name, int lanes, int tangents, const Kind& kind) {
  const SceneSpec scene = reference_beam(kind.place);
  const auto* mass = registry().mass(kind.mass);
  std::map<std::string, ParameterValue> values;
  if (kind.mass == "singular") values["velocity"] = std::string("P1");
  const auto* law = registry().contact(law_name);
  const auto* scheme = registry().time("newmark-dumont-paoli");
  const auto problem = std::make_shared<const SemiDiscrete>(
      std::get<SemiDiscrete>(discretise(scene, elements, *mass->make(defaults(mass->manual, values)))));
  auto made = law->make(defaults(law->manual));
  const double h = 2 * std::numbers::pi / pulsation / steps_per_period;
  const auto plan = std::get<StepPlan>(scheme->make(defaults(scheme->manual))->plan(h, problem_facts(*problem, *made)));
  std::vector<LaneSpec> block(static_cast<std::size_t>(lanes), scene_lane(*problem, defaults(law->manual)));
  for (int k = 0; k < lanes; ++k) block[static_cast<std::size_t>(k)].amplitude = 0.070 + 0.0299 * k / lanes;
  CompileOptions options;
  options.tangents = tangents;
  options.kind = kind.kind;
  options.expected_steps = 100000000;
  return std::get<Program>(compile(problem, plan, h, std::move(made), std::move(block), options));
}

double wall(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double processor(const std::function<void()>& work) {
  const double begin = thread_nanoseconds();
  work();
  return 1e-9 * (thread_nanoseconds() - begin);
}

// A block past its first periods, so that contact is what it is on the diagram.
std::unique_ptr<SectionMarch> block(const std::string& law, const Setting& setting, bool kept, const Kind& place) {
  SectionPlan plan;
  plan.pulsation = pulsation;
  plan.steps_per_period = steps_per_period;
  plan.transient = kept ? 2 : 1000000;
  plan.at_most = plan.transient;
  plan.keep = 1000000;
  plan.scale = 0.1;
  const StartedOrbits started = start_orbits(program(law, setting.lanes, 0, place), plan);
  auto march = std::make_unique<SectionMarch>(program(law, setting.lanes, 0, place), plan);
  for (int lane = 0; lane < setting.lanes; ++lane) {
    Orbit orbit;
    orbit.lane = march->marcher().program().lanes[static_cast<std::size_t>(lane)];
    orbit.now = started.states[static_cast<std::size_t>(lane)];
    march->load(lane, orbit);
  }
  for (int n = 0; n < 4; ++n) march->period();
  return march;
}

struct Row {
  std::string name;
  double lane_steps;
  std::function<void()> work;
  bool several_cores = false;
  std::vector<double> seconds = {};  // of each round
  double typical() const { return median(seconds); }
};

// The median over the rounds of how much longer the one took than the other: neighbours in time share their noise.
double ratio(const Row& one, const Row& other) {
  std::vector<double> ratios;
  for (std::size_t round = 0; round < one.seconds.size(); ++round)
    ratios.push_back(one.seconds[round] / other.seconds[round]);
  return median(ratios);
}

void measure(const Setting& setting, const Kind& place) {
  const double steps = static_cast<double>(setting.periods) * steps_per_period;
  const double lane_steps = steps * setting.lanes;
  auto free = block("none", setting, false, place);
  auto contact = block("signorini", setting, false, place);
  auto kept = block("signorini", setting, true, place);
  auto other = block("signorini", setting, false, place);
  const auto go = [&](SectionMarch& march) {
    for (int n = 0; n < setting.periods; ++n) march.period();
  };
  std::vector<Row> rows;
  rows.push_back({"march, no contact law", lane_steps, [&] { go(*free); }});
  rows.push_back({"with contact", lane_steps, [&] { go(*contact); }});
  rows.push_back({"with contact, kept periods (watched)", lane_steps, [&] { go(*kept); }});
  rows.push_back({"two blocks on two cores", 2 * lane_steps,
                  [&] {
                    std::jthread second([&] { go(*other); });
                    go(*contact);
                  },
                  true});
  for (int round = 0; round < setting.rounds; ++round)
    for (Row& row : rows) row.seconds.push_back(row.several_cores ? wall(row.work) : processor(row.work));
  fmt::print("{} lanes, stops at {}, {} operator\n", setting.lanes,
             place.place == StopsSpec::Place::nodes ? "all nodes" : "the tip",
             operator_name(contact->marcher().program().kind));
  for (const Row& row : rows) {
    const auto [least, most] = std::minmax_element(row.seconds.begin(), row.seconds.end());
    fmt::print("  {:<40} {:8.3g} ns per lane-step  {:8.3g} million lane-steps/s   [{:.3g} … {:.3g} s]\n", row.name,
               1e9 * row.typical() / row.lane_steps, 1e-6 * row.lane_steps / row.typical(), *least, *most);
  }
  const double open = ratio(rows[0], rows[2]), closed = ratio(rows[1], rows[2]);
  fmt::print("  shares while periods are kept: march {:.0f} %, contact {:.0f} %, measure {:.0f} %\n", 100 * open,
             100 * (closed - open), 100 * (1 - closed));
  fmt::print("  reference diagram, 500 amplitudes × 600 periods × 6000 steps: {:.0f} s on one core, {:.0f} s on two\n",
             diagram * (rows[1].typical() + rows[2].typical()) / 2 / lane_steps,
             diagram * rows[3].typical() / rows[3].lane_steps);
}

// Lanes with a tangent column each against as many without, in blocks that hold either.
void measure_tangents(const Setting& setting) {
  const int half = std::max(1, setting.lanes / 2);
  const auto made = [&](const Kind& kind, int tangents) {
    auto marcher = std::make_shared<Marcher>(program("signorini", half, tangents, kind));
    marcher->start();
    marcher->march(4 * steps_per_period);
    for (int lane = 0; lane < half; ++lane)
      for (int k = 0; k < tangents; ++k) {
        LaneState state = marcher->lane_state(lane);
        std::fill(state.efforts.begin(), state.efforts.end(), 0.0);
        marcher->set_tangent(lane, k, state);
      }
    return marcher;
  };
  const auto nodes = StopsSpec::Place::nodes, tip = StopsSpec::Place::tip;
  const std::vector<Kind> kinds = {
      {nodes, "singular", OperatorKind::band},    {nodes, "consistent", OperatorKind::band},
      {nodes, "consistent", OperatorKind::modal}, {tip, "singular", OperatorKind::band},
      {tip, "consistent", OperatorKind::band},    {tip, "singular", OperatorKind::modal},
      {tip, "consistent", OperatorKind::modal},   {tip, "consistent", OperatorKind::sparse}};
  const long long steps = static_cast<long long>(setting.periods) * steps_per_period;
  std::vector<Row> plain, with;
  for (const Kind& kind : kinds)
    for (const int tangents : {0, 1})
      (tangents == 0 ? plain : with)
          .push_back({fmt::format("{}, {}, {}", kind.mass, kind.place == nodes ? "all nodes" : "tip",
                                  operator_name(kind.kind)),
                      static_cast<double>(steps) * half,
                      [march = made(kind, tangents), steps] { march->march(steps); }});
  for (int round = 0; round < setting.rounds; ++round)
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      plain[k].seconds.push_back(processor(plain[k].work));
      with[k].seconds.push_back(processor(with[k].work));
    }
  fmt::print("{} lanes with a tangent column each, against {} lanes\n", half, half);
  for (std::size_t k = 0; k < kinds.size(); ++k)
    fmt::print("  {:<32} {:8.3g} ns per lane-step, {:.3g} without: a column costs {:.2f} of a lane\n", plain[k].name,
               1e9 * with[k].typical() / with[k].lane_steps, 1e9 * plain[k].typical() / plain[k].lane_steps,
               ratio(with[k], plain[k]) - 1);
}

}  // namespace

int main(int argc, char** argv) {
  Setting setting;
  bool tangents_alone = false;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (!std::strcmp(argv[i], "--tangents")) tangents_alone = true;
    if (!std::strcmp(argv[i], "--rounds")) setting.rounds = std::max(1, std::atoi(argv[i + 1]));
    if (!std::strcmp(argv[i], "--lanes")) setting.lanes = std::clamp(std::atoi(argv[i + 1]), 2, 32);
    if (!std::strcmp(argv[i], "--periods")) setting.periods = std::max(1, std::atoi(argv[i + 1]));
  }
  if (!tangents_alone) {
    measure(setting, {StopsSpec::Place::nodes});
    measure(setting, {StopsSpec::Place::tip});
  }
  measure_tangents(setting);
}
