// Leaving out steps changes nothing: every scheme, law and mass matrix, and random scenes, against the same march of
// every step. How far round-off may carry two equal motions apart a twin says that begins 1e-12 beside, and the same
// march with another operator.
#include <random>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

struct Ending {
  Eigen::VectorXd position;
  long long contact_steps = 0, impacts = 0, visited = 0;
  double impulse = 0, loads = 0, damping = 0, scheme = 0;
  bool running = false;
  std::vector<Impact> rows;
};

Ending march(Program program, long long steps) {
  Marcher marcher(std::move(program));
  EnergyAudit audit(marcher);
  ImpactRecorder recorder(marcher, &audit);
  marcher.start(&recorder);
  marcher.march(steps - marcher.step(), &recorder);
  recorder.finish(marcher);
  Ending ending;
  ending.position = marcher.position(0);
  ending.contact_steps = audit.contact(0).contact_steps;
  ending.impacts = recorder.count(0);
  ending.visited = marcher.steps_visited();
  ending.impulse = audit.contact(0).impulse;
  ending.loads = audit.totals(0).work_of_loads;
  ending.damping = audit.totals(0).work_of_damping;
  ending.scheme = audit.totals(0).work_of_scheme;
  ending.running = marcher.status(0).running;
  ending.rows = recorder.impacts(0);
  return ending;
}

CompileOptions options(MarchWay way, long long steps) {
  CompileOptions chosen;
  chosen.kind = OperatorKind::modal;
  chosen.march = way;
  chosen.expected_steps = steps;
  return chosen;
}

// Of a parameter without a default, something that suits most.
Choice with_values(const PluginManual& manual) {
  Choice choice{manual.name, {}};
  for (const ParameterSpec& spec : manual.parameters) {
    if (spec.fallback || spec.type != ParameterSpec::Type::real) continue;
    choice.values[spec.key] = spec.range.high < 10 ? 0.5 : 1e4;
  }
  return choice;
}

struct Compared {
  bool flew = false, alike = true;
  std::string cause, apart;
  long long steps = 0, visited = 0, contact_steps = 0;
};

// `spoil`: what the flights are told of the stops, moved away by so much (m): a march that misses contacts.
Compared compare(const SceneSpec& scene, int elements, const Methods& methods, double h, long long steps,
                 double spoil = 0) {
  Compared result;
  const auto law = make(registry().contact(methods.contact.name), methods.contact);
  auto discrete = discretise(scene, elements, *make(registry().mass(methods.mass.name), methods.mass), law.get());
  if (const auto* refusal = std::get_if<Refusal>(&discrete)) {
    result.cause = refusal->sentence;
    return result;
  }
  const auto problem = std::make_shared<const SemiDiscrete>(std::move(std::get<SemiDiscrete>(discrete)));
  auto flown = compiled(problem, methods, h, options(MarchWay::flights, steps));
  if (const auto* refusal = std::get_if<Refusal>(&flown)) {
    result.cause = refusal->sentence;
    return result;
  }
  result.flew = true;
  Program& program = std::get<Program>(flown);
  if (spoil != 0) {
    const LaneSpec lane = program.lanes.front();
    program.lanes.front().lower.array() -= spoil;
    program.lanes.front().upper.array() += spoil;
    program.flight = std::make_shared<Flight>(program, 0, steps);
    program.lanes.front() = lane;
  }
  const Ending one = march(std::move(program), steps);
  auto every = compiled(problem, methods, h, options(MarchWay::every_step, steps));
  const Ending other = march(std::move(std::get<Program>(every)), steps);
  const auto beside = [](const LaneSpec& lane) {
    LaneSpec twin = lane;
    twin.position *= 1 + 1e-12;
    twin.velocity *= 1 + 1e-12;
    twin.amplitude *= 1 + 1e-12;
    return std::vector<LaneSpec>{twin};
  };
  auto second = compiled(problem, methods, h, options(MarchWay::every_step, steps), beside);
  const Ending twin = march(std::move(std::get<Program>(second)), steps);
  result.steps = steps;
  result.visited = one.visited;
  result.contact_steps = one.contact_steps;
  const double size = other.position.lpNorm<Eigen::Infinity>();
  // The same march with the round-off of another operator.
  CompileOptions band = options(MarchWay::every_step, steps);
  band.kind = OperatorKind::band;
  auto third = compiled(problem, methods, h, band);
  const Ending rounded = march(std::move(std::get<Program>(third)), steps);
  const double open = std::max((twin.position - other.position).lpNorm<Eigen::Infinity>(),
                               (rounded.position - other.position).lpNorm<Eigen::Infinity>());
  const double apart = (one.position - other.position).lpNorm<Eigen::Infinity>();
  const auto differ = [&](const std::string& what, double a, double b) {
    result.alike = false;
    result.apart += fmt::format("{}: {:.10g} flown, {:.10g} marched; ", what, a, b);
  };
  if (one.running != other.running) differ("running", one.running, other.running);
  // Where the twin is far the motion has forgotten its start: then nothing is to be compared.
  if (open > 1e-4 * size || !other.running) return result;
  if (apart > 30 * open + 1e-11 * size) differ("end", apart, open);
  if (twin.contact_steps == other.contact_steps && rounded.contact_steps == other.contact_steps) {
    if (one.contact_steps != other.contact_steps)
      differ("contact steps", static_cast<double>(one.contact_steps), static_cast<double>(other.contact_steps));
    if (one.impacts != other.impacts)
      differ("impacts", static_cast<double>(one.impacts), static_cast<double>(other.impacts));
  }
  const auto same = [&](const char* what, double Ending::*value, double scale) {
    const double floor =
        30 * std::max(std::abs(twin.*value - other.*value), std::abs(rounded.*value - other.*value)) + 1e-9 * scale;
    if (std::abs(one.*value - other.*value) > floor) differ(what, one.*value, other.*value);
  };
  const double energies = std::abs(other.loads) + std::abs(other.damping) + std::abs(other.scheme);
  same("impulse", &Ending::impulse, std::abs(other.impulse));
  same("work of loads", &Ending::loads, energies);
  same("work of damping", &Ending::damping, energies);
  same("work of the scheme", &Ending::scheme, energies);
  for (std::size_t i = 0; i < std::min(one.rows.size(), other.rows.size()) && result.alike && i < 5; ++i) {
    if (i >= rounded.rows.size()) break;
    const Impact &a = one.rows[i], &b = other.rows[i], &c = rounded.rows[i];
    const auto near = [&](double Impact::*value) {
      const double x = a.*value, y = b.*value, floor = 30 * std::abs(c.*value - y);
      return (std::isnan(x) && std::isnan(y)) || std::isnan(floor) ||
             std::abs(x - y) <= 1e-5 * (1e-3 + std::abs(y)) + floor;
    };
    bool equal = a.point == b.point;
    for (double Impact::*value : {&Impact::time, &Impact::speed_in, &Impact::speed_out, &Impact::impulse,
                                  &Impact::peak_force, &Impact::duration})
      equal = equal && near(value);
    if (!equal) differ(fmt::format("impact {}", i), a.impulse, b.impulse);
  }
  return result;
}

SceneSpec shaken() {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops.place = StopsSpec::Place::nodes;
  scene.support.amplitude = 0.03;
  return scene;
}

}  // namespace

TEST_CASE("a march that leaves out steps is the march of every step, whatever the scheme, the law and the mass") {
  int flew = 0, left_out = 0;
  std::map<std::string, int> by_scheme, by_law;
  for (const std::string& mass : registry().names(Role::mass))
    for (const std::string& law : registry().names(Role::contact))
      for (const std::string& time : registry().names(Role::time)) {
        // All schemes with one law and one mass, all laws with one scheme, all masses: and those that cross.
        const bool crossed = time == "newmark-dumont-paoli" ||
                             (law == "signorini" && (mass == "consistent" || mass == "singular")) ||
                             (law == "penalty" && mass == "lumped");
        if (!crossed) continue;
        const Methods methods{with_values(registry().mass(mass)->manual), with_values(registry().contact(law)->manual),
                              with_values(registry().time(time)->manual)};
        SceneSpec scene = shaken();
        Compared result;
        try {
          result = compare(scene, 4, methods, 4e-5, 4000);
        } catch (const std::exception& error) {
          result.cause = error.what();
        }
        INFO(mass << " × " << law << " × " << time << ": " << result.apart);
        CHECK(result.alike);
        flew += result.flew;
        left_out += result.flew && 2 * result.visited < result.steps;
        by_scheme[time] += result.flew;
        by_law[law] += result.flew;
      }
  CHECK(flew > 100);
  CHECK(left_out > flew / 2);
  for (const auto& [law, times] : by_law) {
    INFO(law);
    CHECK(times > 0);
  }
  for (const auto& [scheme, times] : by_scheme) {
    INFO(scheme);
    CHECK(times > 0);
  }
}

TEST_CASE("leaving out steps changes nothing in random scenes") {
  std::mt19937 random(20);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto one_of = [&](const auto& list) {
    return list[std::uniform_int_distribution<std::size_t>(0, list.size() - 1)(random)];
  };
  const std::vector<Choice> masses = {{"consistent"},
                                      {"lumped"},
                                      {"singular", {{"velocity", std::string("P1")}}},
                                      {"singular", {{"velocity", std::string("P0")}}}};
  const std::vector<Choice> laws = {{"signorini"}, {"signorini"}, {"penalty", {{"stiffness", 1e5}}}};
  const std::vector<Choice> times = {{"newmark-dumont-paoli", {{"restitution", 0.5}}},
                                     {"newmark-dumont-paoli", {{"beta", 0.5}}},
                                     {"newmark-dumont-paoli", {{"beta", 0.3}}},
                                     {"moreau-jean", {{"theta", 0.6}}},
                                     {"midpoint"},
                                     {"bathe"},
                                     {"generalised-alpha", {{"rho_inf", 0.8}}}};
  int flew = 0, held = 0;
  for (int k = 0; k < 240; ++k) {
    SceneSpec scene = working_set();
    beam_of(scene).damping.stiffness = one_of(std::vector<double>{0, 1e-5, 1e-3});
    beam_of(scene).damping.mass = one_of(std::vector<double>{0, 0, 5});
    scene.stops.place = one_of(std::vector{StopsSpec::Place::nodes, StopsSpec::Place::tip});
    scene.stops.lower = Formula(-between(0.02, 0.1));
    scene.stops.upper = Formula(between(0.02, 0.1));
    scene.support = {one_of(std::vector<double>{0, 0.01, 0.05}), between(2, 60), between(0, 6)};
    // The clamp stays between the stops.
    scene.support.amplitude = std::min(scene.support.amplitude, 0.015);
    if (k % 5 == 0) scene.load = Formula(fmt::format("{}*x", between(-3, 3)), "/scene/load");
    scene.initial.displacement =
        Formula(fmt::format("{}*x^2", between(-0.008, 0.008)), "/scene/initial/displacement", "x");
    scene.initial.velocity = Formula(fmt::format("{}*x", between(-2, 2)), "/scene/initial/velocity", "x");
    const Methods methods{one_of(masses), one_of(laws), one_of(times)};
    const double h = std::pow(10, -between(4, 5));
    const Compared result = compare(scene, 2 + k % 5, methods, h, 4000);
    INFO(k << ": " << methods.mass.name << " × " << methods.contact.name << " × " << methods.time.name << ", h = " << h
           << ": " << result.apart << result.cause);
    CHECK(result.alike);
    flew += result.flew && result.visited < result.steps;
    held += result.flew && result.visited < result.contact_steps;
  }
  CHECK(flew > 150);
  // Some rest at a stop long enough that closed contact is left out too.
  CHECK(held > 10);
}

TEST_CASE("a flight that looks for the stops where they are not is found out") {
  const Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.5}}}};
  const SceneSpec scene = shaken();
  CHECK(compare(scene, 4, methods, 4e-5, 4000).alike);
  CHECK_FALSE(compare(scene, 4, methods, 4e-5, 4000, 0.02).alike);
}

TEST_CASE("the balance of a march that leaves out steps closes as well as that of every step") {
  // Where closed contact is left, round-off of the constraint (1e-17 m a step) is a velocity of 1e-9 m/s at h = 1e-7:
  // taken off along what moves the whole structure it gave or took 1e-11 J each time.
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  const Methods methods{
      {"lumped"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.5}, {"start", std::string("first-order")}}}};
  CompileOptions flown;
  flown.march = MarchWay::flights;
  flown.expected_steps = 1500000;
  Marcher beam = marcher(scene, 20, methods, 1e-7, flown);
  const EnergyAudit audit = audited(beam, 0.15);
  CHECK(beam.steps_visited() < 50000);
  CHECK(audit.contact(0).contact_steps > 1000);
  CHECK(std::abs(audit.totals(0).balance_residual()) < 1e-11 * audit.totals(0).first.common());
}
