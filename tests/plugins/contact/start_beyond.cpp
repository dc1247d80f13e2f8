// A compliant stop lets a scene begin beyond it: the law's force is there at t = 0, and what is at rest stays at rest.
#include <fmt/format.h>

#include <ricochet/scene/checks.hpp>

#include "tests/plugins/contact/impacts.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

const std::vector<std::string> evaluations_of_laws = {"implicit", "averaged", "explicit",
                                                      "midpoint", "hybrid",   "conserving"};

/// Every compliant law of one point that lets it pass, with parameters of one order.
std::vector<Choice> compliant_laws() {
  const std::map<std::string, std::map<std::string, ParameterValue>> values = {
      {"penalty", {{"stiffness", 1e5}}},
      {"hertz", {{"stiffness", 1e7}}},
      {"layer", {{"stiffness", 1e5}, {"thickness", 2e-5}}},
      {"exponential", {{"force", 5.0}, {"length", 1e-4}, {"reach", 5.0}}},
      {"hunt-crossley", {{"stiffness", 1e7}, {"damping", 0.05}}},
      {"kelvin-voigt", {{"stiffness", 1e5}, {"viscosity", 3.0}}},
      {"lankarani-nikravesh", {{"stiffness", 1e7}, {"restitution", 0.95}}},
      {"elasto-plastic", {{"stiffness", 1e5}, {"yield_force", 5.0}, {"hardening", 0.2}}},
      {"table",
       {{"depth_force", ParameterTable{{0, 0}, {5e-5, 3}, {2e-4, 30}}},
        {"unloading", ParameterTable{{0, 0}, {1e-4, 5}, {2e-4, 30}}}}}};
  std::vector<Choice> laws;
  for (const auto& [name, parameters] : values)
    for (const std::string& evaluation : evaluations_of_laws) {
      Choice choice{name, parameters};
      choice.values["evaluation"] = evaluation;
      laws.push_back(choice);
    }
  return laws;
}

class NoColumns final : public DelassusColumns {
 public:
  const double* column(int) override { return &one_; }

 private:
  double one_ = 1;
};

/// Of the law at rest, so deep beyond a stop, N.
double force_at(const Choice& choice, double depth) {
  const auto* entry = registry().contact(choice.name);
  const auto law = make(entry, choice);
  const Parameters parameters = complete(entry->manual.parameters, choice.values);
  law->prepare(1, {&parameters, 1});
  NoColumns columns;
  const double free = -depth, lower = law->layer(0), upper = INFINITY, rate = 0;
  double effort = 0;
  std::vector<double> memory(static_cast<std::size_t>(std::max(1, law->memory_per_point())), 0.0);
  LaneOutcome outcome;
  const int lane = 0;
  ReducedProblem problem;
  problem.points = problem.lanes = 1;
  problem.delassus = &columns;
  problem.free = problem.before = &free;
  problem.lower = &lower;
  problem.upper = &upper;
  problem.rate_free = &rate;
  problem.memory = memory.data();
  problem.effort = &effort;
  problem.touched = {&lane, 1};
  problem.outcome = &outcome;
  law->solve(problem);
  return effort;
}

}  // namespace

TEST_CASE("a mass at rest on a compliant stop under its weight stays there: every scheme, law and evaluation") {
  // The load is the law's own force at that depth: equilibrium to the last digit.
  constexpr double depth = 9e-5, h = 1e-4;
  const double side = GENERATE(1.0, -1.0);  // of the stop: below or above
  const double stiffness = GENERATE(0.0, 1000.0);
  int marched = 0;
  for (const Choice& law : compliant_laws()) {
    const double force = force_at(law, depth);
    REQUIRE(force > 0);
    SceneSpec scene;
    scene.structure = OscillatorSpec{1, stiffness, 0, {}};
    (side > 0 ? scene.stops.lower : scene.stops.upper) = Formula(0.0);
    scene.stops.place = StopsSpec::Place::tip;
    scene.initial.displacement = Formula(-side * depth);
    scene.load = Formula(-side * (force + stiffness * depth));
    const auto problem = problem_of(scene, 1, {"consistent"}, law);
    for (const std::string& name : registry().names(Role::time))
      for (const char* start : {"", "first-order", "second-order"}) {
        Choice time{name};
        const auto& specs = registry().time(name)->manual.parameters;
        const bool starts =
            std::any_of(specs.begin(), specs.end(), [](const auto& spec) { return spec.key == "start"; });
        if (starts != (*start != 0)) continue;
        if (starts) time.values["start"] = std::string(start);
        INFO(name << ' ' << start << ", " << law.name << ", " << std::get<std::string>(law.values.at("evaluation"))
                  << ", k = " << stiffness << ", side " << side);
        auto program = compiled(problem, {{"consistent"}, law, time}, h);
        if (std::holds_alternative<Refusal>(program)) continue;
        Marcher mass(std::move(std::get<Program>(program)));
        EnergyAudit audit(mass);
        mass.start(&audit);
        double worst = 0;
        for (int step = 0; step < 200; ++step) {
          mass.march(1, &audit);
          worst = std::max(worst, std::abs(mass.tip(0) + side * depth));
        }
        REQUIRE(mass.status(0).running);
        ++marched;
        // Forces are known to their round-off: 1e-16 of 10 to 100 N moves 1 kg by 2e-18 m in 0.02 s.
        CHECK(worst <= 1e-12 * depth);
        CHECK(audit.contact(0).impacts == 0);
        CHECK(audit.contact(0).spells == 1);
        CHECK(audit.contact(0).impulse == Approx(force * 200 * h).epsilon(0.02));
        CHECK(audit.totals(0).first.contact > 0);
        CHECK(audit.totals(0).brought_in() >= audit.totals(0).first.contact);
        CHECK(audit.totals(0).largest_step_gain <= 1e-12 * (audit.totals(0).first.common() + force * depth));
      }
  }
  CHECK(marched > 300);
}

TEST_CASE("a beam that leans on its spring at rest stays there") {
  const auto mass = GENERATE(Choice{"consistent"}, Choice{"singular"});
  const auto evaluation = GENERATE(std::string("implicit"), std::string("averaged"), std::string("conserving"));
  const auto time = GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"newmark"}, Choice{"midpoint"},
                             Choice{"generalised-alpha"}, Choice{"bathe"});
  // The tip, pushed up by R, is R/κ below its stop: a cubic, which the elements hold exactly.
  constexpr double EI = 1, L = 1, kappa = 100, lift = 0.02;
  const double reaction = lift / (1 / kappa + L * L * L / (3 * EI));
  SceneSpec scene = unit_beam();
  beam_of(scene).damping.stiffness = 0.01;
  scene.support = {};
  scene.stops = {};
  scene.stops.lower = Formula(lift);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement =
      Formula(fmt::format("{:.17g}*x^2*(3-x)/6", reaction), "/scene/initial/displacement", "x");
  const Choice law{"penalty", {{"stiffness", kappa}, {"evaluation", evaluation}}};
  INFO(mass.name << ", " << time.name << ", " << evaluation);
  auto program = compiled(problem_of(scene, 6, mass, law), {mass, law, time}, 1e-3);
  if (std::holds_alternative<Refusal>(program)) return;
  Marcher beam(std::move(std::get<Program>(program)));
  const EnergyAudit audit = audited(beam, 0.2);
  CHECK(beam.tip(0) == Approx(lift - reaction / kappa).epsilon(1e-9));
  CHECK(audit.contact(0).impacts == 0);
  CHECK(audit.contact(0).force == Approx(reaction).epsilon(1e-8));
}

TEST_CASE("a spring that a scene starts pressed into gives back what it holds") {
  // Let go from 0.01 m inside a stop of 1e5 N/m: a free mass leaves with ½mv² = ½κδ².
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 0, 0, {}};
  scene.stops.lower = Formula(0.01);
  scene.stops.place = StopsSpec::Place::tip;
  const Choice law{"penalty", {{"stiffness", 1e5}, {"evaluation", std::string("conserving")}}};
  Marcher mass = marcher(scene, 1, {{"consistent"}, law, {"midpoint"}}, 1e-5);
  const EnergyAudit audit = audited(mass, 0.02);
  const double stored = 0.5 * 1e5 * 1e-4;
  CHECK(audit.totals(0).first.common() == Approx(stored).epsilon(1e-14));
  CHECK(audit.totals(0).brought_in() == Approx(stored).epsilon(1e-14));
  CHECK(audit.tip_velocity(0) == Approx(std::sqrt(2 * stored)).epsilon(1e-6));
  CHECK(audit.lost_at_stops(0) == Approx(0).margin(1e-9));
  CHECK(audit.contact(0).impacts == 0);
}

TEST_CASE("stops that pass each other hold a mass between two springs") {
  // lower 0.002 above upper −0.001: at rest in the middle, on springs of κ each.
  const auto name = GENERATE(std::string("penalty"), std::string("hertz"), std::string("kelvin-voigt"));
  const auto evaluation =
      GENERATE(std::string("implicit"), std::string("averaged"), std::string("explicit"), std::string("conserving"));
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 0, 0, {}};
  scene.stops.lower = Formula(0.002);
  scene.stops.upper = Formula(-0.001);
  scene.stops.place = StopsSpec::Place::tip;
  constexpr double middle = 0.0005, moved = 1e-4;
  scene.initial.displacement = Formula(middle + moved);
  Choice law{name, {{"stiffness", 1e5}, {"evaluation", evaluation}}};
  if (name == "kelvin-voigt") law.values["viscosity"] = 0.0;
  INFO(name << ", " << evaluation);
  constexpr double h = 1e-5;
  Marcher mass = marcher(scene, 1, {{"consistent"}, law, {"newmark-dumont-paoli"}}, h);
  const EnergyAudit audit = audited(mass, 0.05);
  REQUIRE(mass.status(0).running);
  if (name == "hertz") {
    CHECK(std::abs(mass.tip(0) - middle) <= moved * 1.001);
    return;
  }
  // Both push: x'' = −2κ x about the middle; taken at the end of a step alone, that damps by e^{−κ h t}, 5 %.
  CHECK(mass.tip(0) == Approx(middle + moved * std::cos(std::sqrt(2e5) * 0.05)).margin(0.06 * moved));
  CHECK(audit.totals(0).first.contact ==
        Approx(0.5 * 1e5 * (std::pow(0.0014, 2) + std::pow(0.0016, 2))).epsilon(1e-12));
}

TEST_CASE("laws without a force there refuse, and say which laws have one") {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 1000, 0, {}};
  scene.stops.lower = Formula(0.01);
  scene.stops.place = StopsSpec::Place::tip;
  const auto outcome = [&](const Choice& choice) {
    const auto* entry = registry().contact(choice.name);
    const auto law = make(entry, choice);
    const Parameters parameters = complete(entry->manual.parameters, choice.values);
    const auto built =
        discretise(scene, 1, *make(registry().mass("consistent"), Choice{"consistent"}), law.get(), &parameters);
    const auto* refusal = std::get_if<Refusal>(&built);
    return refusal ? refusal->sentence.text : std::string();
  };
  for (const Choice& rigid : {Choice{"signorini"}, Choice{"perturbed-lagrangian", {{"stiffness", 1e5}}},
                              Choice{"augmented-lagrangian", {{"augmentation", 1e5}}},
                              Choice{"barrier", {{"stiffness", 1e3}, {"thickness", 0.03}}}}) {
    INFO(rigid.name);
    CHECK_THAT(outcome(rigid), Contains("beyond the lower stop at 0.01 m") && Contains("a compliant law"));
  }
  CHECK(outcome({"penalty", {{"stiffness", 1e5}}}).empty());
  CHECK(outcome({"none"}).empty());
  scene.stops.upper = Formula(-0.01);
  CHECK_THAT(outcome({"signorini"}), Contains("is above the upper stop") && Contains("a compliant law"));
  CHECK_THAT(outcome({"barrier", {{"stiffness", 1e3}, {"thickness", 0.03}}}), Contains("a compliant law"));
  CHECK(outcome({"penalty", {{"stiffness", 1e5}}}).empty());
  // Without a law, the rule of rigid ones.
  CHECK_THAT(input_error([&] { check_scene(scene, 1); }), Contains("/scene/stops/lower: "));
}
