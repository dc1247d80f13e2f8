// Contact that lasts: the same integration of every step, whatever the linear law, the scheme, the mass and the load.
#include "tests/engine/flight/compare_marches.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// Pressed onto a stop, thrown off it, and at rest there in the end.
SceneSpec pressed(StopsSpec::Place place, double viscosity) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = viscosity;
  scene.stops.place = place;
  scene.stops.lower = Formula(-0.02);
  scene.stops.upper = Formula(0.02);
  scene.support = {0.004, 20, 0.3};
  scene.load = Formula("6*x", "/scene/load");
  scene.initial.displacement = Formula("0.005*x^2", "/scene/initial/displacement", "x");
  scene.initial.velocity = Formula("0.5*x", "/scene/initial/velocity", "x");
  return scene;
}

std::vector<Choice> linear_laws() {
  std::vector<Choice> laws;
  for (const char* evaluation : {"implicit", "averaged", "midpoint", "conserving", "hybrid"}) {
    laws.push_back({"penalty", {{"stiffness", 2e4}, {"evaluation", std::string(evaluation)}}});
    laws.push_back({"kelvin-voigt", {{"stiffness", 2e4}, {"viscosity", 3.0}, {"evaluation", std::string(evaluation)}}});
  }
  laws.push_back({"penalty", {{"stiffness", 2e2}, {"evaluation", std::string("explicit")}}});
  return laws;
}

}  // namespace

TEST_CASE("while springs push, steps without a search are those of every step") {
  int flew = 0, left_out = 0;
  for (const Choice& law : linear_laws())
    for (const char* time : {"newmark-dumont-paoli", "midpoint", "newmark", "hht-alpha", "generalised-alpha",
                             "contact-stabilised-newmark", "bathe", "noh-bathe", "sdirk", "wbz-alpha", "kane"})
      for (const char* mass : {"consistent", "lumped", "singular"}) {
        // A massless point slides along the edge of a dashpot, on either side of it by round-off.
        if (law.name == "kelvin-voigt" && mass[0] == 's') continue;
        const Methods methods{{mass}, law, with_values(registry().time(time)->manual)};
        const auto place = mass[0] == 'l' ? StopsSpec::Place::tip : StopsSpec::Place::nodes;
        Compared result;
        try {
          result = compare(pressed(place, mass[0] == 'c' ? 0 : 1e-4), 4, methods, 4e-5, 8000);
        } catch (const std::exception& error) {
          result.cause = error.what();
        }
        INFO(law.name << " " << std::get<std::string>(law.values.at("evaluation")) << " × " << time << " × " << mass
                      << ": " << result.apart);
        CHECK(result.alike);
        flew += result.flew;
        left_out += result.flew && 3 * result.visited < result.contact_steps;
      }
  CHECK(flew > 120);
  CHECK(left_out > flew / 3);
}

TEST_CASE("while stops hold, by one stage or several, steps without a search are those of every step") {
  int left_out = 0;
  for (const char* time : {"newmark-dumont-paoli", "bathe", "noh-bathe", "sdirk", "newmark", "hht-alpha", "wbz-alpha",
                           "generalised-alpha", "contact-stabilised-newmark", "laursen-chawla"})
    for (const char* law : {"signorini", "augmented-lagrangian"})
      for (const char* mass : {"singular", "consistent"}) {
        Choice choice{law, {}};
        if (law[0] == 'a') choice.values = {{"augmentation", 1e9}};
        const Methods methods{{mass}, choice, with_values(registry().time(time)->manual)};
        Compared result;
        try {
          result = compare(pressed(StopsSpec::Place::nodes, 1e-3), 4, methods, 4e-5, 12000);
        } catch (const std::exception& error) {
          result.cause = error.what();
        }
        INFO(time << " × " << law << " × " << mass << ": " << result.apart << result.cause);
        CHECK(result.alike);
        left_out += result.flew && 3 * result.visited < result.contact_steps;
      }
  CHECK(left_out > 10);
}

TEST_CASE("while stops of their own stiffness and damping push, steps without a search are those of every step") {
  // A twelfth as stiff, as the law says, four times as stiff; what damps stands beside what does not.
  SceneSpec scene = pressed(StopsSpec::Place::tip, 1e-4);
  scene.stops = {};
  for (const auto& [x, gap, stiffness, damping] : {std::tuple(0.5, 0.002, std::optional(8e2), std::optional<double>()),
                                                   {1.0, 0.008, std::nullopt, 3.0},
                                                   {1.501, 0.02, 4e4, 0.0}}) {
    Place place;
    place.x = x;
    NamedStop stop{.name = fmt::format("at{:.0f}", 10 * x), .at = place, .to = {}, .lower = -gap, .upper = gap};
    stop.own = {.stiffness = stiffness, .damping = damping};
    scene.stops.named.push_back(stop);
  }
  for (const Choice& law :
       {Choice{"penalty", {{"stiffness", 1e4}}}, Choice{"kelvin-voigt", {{"stiffness", 1e4}, {"viscosity", 1.0}}}})
    for (const char* time : {"newmark-dumont-paoli", "midpoint", "bathe"}) {
      const Methods methods{{"consistent"}, law, with_values(registry().time(time)->manual)};
      const Compared result = compare(scene, 4, methods, 4e-5, 8000);
      INFO(law.name << " × " << time << ": " << result.apart << result.cause);
      CHECK(result.alike);
      CHECK(result.flew);
      CHECK(3 * result.visited < result.contact_steps);
    }
}

TEST_CASE("a point that closes beside those that are held is not missed") {
  // All nodes, soft springs: the beam lays itself down point by point.
  const Methods methods{{"consistent"}, {"penalty", {{"stiffness", 2e3}}}, {"newmark-dumont-paoli"}};
  const SceneSpec scene = pressed(StopsSpec::Place::nodes, 1e-4);
  const Compared right = compare(scene, 6, methods, 2e-5, 8000);
  INFO(right.apart);
  CHECK(right.alike);
  CHECK(3 * right.visited < right.contact_steps);
  CHECK_FALSE(compare(scene, 6, methods, 2e-5, 8000, 0.02).alike);
}

TEST_CASE("sums of efforts over steps that are left out are those of the efforts told one by one") {
  // Pressed onto a stop by a load, shaken there: the beam rests for most of the time.
  class Sums final : public StepObserver {
   public:
    Sums() { asks_.next_shown = never; }
    long long told = 0, longest = 0;
    double sum = 0, squares = 0, most = 0, last = 0;  // worst relative differences
    void stage_solved(const Marcher&, const StageView&) override {}
    void step_done(Marcher&) override {}
    void interval(Marcher&, const StepInterval& steps) override {
      if (!steps.flight || steps.closed.empty()) return;
      const auto pushed = steps.pushed();
      if (pushed.empty()) return;
      REQUIRE(pushed.size() == steps.closed.size());
      std::vector<Flight::Pushed> read(pushed.size());
      steps.each_stage([&](int, std::span<const double> efforts, std::span<const double>) {
        for (std::size_t i = 0; i < efforts.size(); ++i) {
          const double p = std::abs(efforts[i]);
          read[i].sum += p;
          read[i].squares += p * p;
          read[i].most = std::max(read[i].most, p);
          read[i].last = p;
        }
      });
      for (std::size_t i = 0; i < pushed.size(); ++i) {
        const auto worse = [](double& worst, double a, double b, double scale) {
          worst = std::max(worst, std::abs(a - b) / scale);
        };
        worse(sum, pushed[i].sum, read[i].sum, read[i].sum);
        worse(squares, pushed[i].squares, read[i].squares, read[i].squares);
        worse(most, pushed[i].most, read[i].most, read[i].most);
        worse(last, pushed[i].last, read[i].last, read[i].most);
      }
      ++told;
      longest = std::max(longest, steps.steps);
    }
  };
  const double viscosity = GENERATE(0.0, 1e-3), amplitude = GENERATE(0.0, 0.004);
  const bool upper = GENERATE(false, true);
  SceneSpec scene = pressed(StopsSpec::Place::nodes, viscosity);
  scene.support.amplitude = amplitude;
  if (upper) scene.load = Formula("-6*x", "/scene/load");
  const Methods methods{{"singular"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.5}}}};
  CompileOptions flown;
  flown.march = MarchWay::flights;
  flown.expected_steps = 6000000;
  // Without damping contact is short, and sums are asked for late: the tables of few modes are made sooner.
  const int elements = viscosity > 0 ? 6 : 2;
  const long long steps = viscosity > 0 ? 600000 : 6000000;
  Marcher beam = marcher(scene, elements, methods, viscosity > 0 ? 1e-6 : 2e-7, flown);
  Sums sums;
  beam.start(&sums);
  beam.march(steps - beam.step(), &sums);
  INFO("viscosity " << viscosity << ", amplitude " << amplitude << ", upper " << upper << ": " << sums.told
                    << " flights, the longest of " << sums.longest << " steps; " << sums.sum << " " << sums.squares
                    << " " << sums.most << " " << sums.last);
  CHECK(sums.told > 0);
  // Of N sums by doubling and one by one, N a thousand or more: round-off of either.
  CHECK(sums.sum < 1e-12);
  CHECK(sums.squares < 1e-12);
  CHECK(sums.most < 1e-12);
  CHECK(sums.last < 1e-12);
}
