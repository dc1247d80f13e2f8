// What a spring behind a stop turns back.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/measure/stability/linear_response.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace contact_spring_tests {

TEST_CASE("a stiff spring behind the tip turns back the mass of the last node, where masses are lumped") {
  const SceneSpec scene = working_set();
  for (const int elements : {4, 10}) {
    const auto problem = problem_of(scene, elements, {"lumped"});
    const double end = dense_mass(problem->inertia).diagonal().maxCoeff() / 2;  // half of an inner node's
    CAPTURE(elements, end);
    for (const double stiffness : {1e9, 1e10, 1e12}) {
      const auto spring = contact_spring(*problem, stiffness);
      REQUIRE(spring);
      CHECK(spring->stiffness == stiffness);
      CHECK(spring->mass == Approx(end).epsilon(1e-3));
      // The structure behind it, 12 EI/ℓ³ of one element at most, is soft beside it.
      CHECK(spring->pulsation == Approx(std::sqrt(stiffness / end)).epsilon(1e-3));
    }
  }
}

TEST_CASE("a soft spring turns back what the first mode moves, and adds to its own stiffness") {
  const SceneSpec scene = working_set();
  const auto problem = problem_of(scene, 10, {"consistent"});
  const auto soft = contact_spring(*problem, 1e-3), stiffer = contact_spring(*problem, 2e-3);
  REQUIRE((soft && stiffer));
  // ω² = (k + κ)/m of one mode, k and m its own at the tip: ¼ of the beam's mass for a clamped beam (φ²(L) = 4 of the
  // normalised first mode).
  const auto& beam = std::get<BeamSpec>(scene.structure);
  const double mass = section_properties(beam.section, beam.young, beam.density).rhoS * beam.length / 4;
  const double rise = stiffer->pulsation * stiffer->pulsation - soft->pulsation * soft->pulsation;
  CHECK(1e-3 / rise == Approx(mass).epsilon(1e-3));
}

TEST_CASE("where the point has no mass, no mode is found on its spring") {
  const SceneSpec scene = working_set();
  const auto problem = problem_of(scene, 10, {"singular"});
  CHECK_FALSE(contact_spring(*problem, 1e12));
}

}  // namespace contact_spring_tests

// Where a motion without contact first touches a stop, along a parameter.

namespace grazing_tests {

namespace {

std::vector<double> evenly(double from, double to, int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k) out.push_back(from + (to - from) * k / (count - 1));
  return out;
}

}  // namespace

TEST_CASE("grazing: each zero of the overlap is found to round-off, with the side without contact") {
  // Contact outside ]1, √5[: opens at 1 from below, closes at √5.
  const auto found =
      find_grazings(evenly(0, 4, 33), [](double a) { return std::optional((a - 1) * (a - std::sqrt(5.0))); });
  REQUIRE(found.size() == 2);
  CHECK(found[0].value == Approx(1).epsilon(1e-11));
  CHECK_FALSE(found[0].opens_below);
  CHECK(found[1].value == Approx(std::sqrt(5.0)).epsilon(1e-11));
  CHECK(found[1].opens_below);
  for (const Grazing& one : found) {
    CHECK(one.low <= one.value);
    CHECK(one.value <= one.high);
    CHECK(one.high - one.low <= 1e-11);
    CHECK(one.steps > 20);
  }
}

TEST_CASE("grazing: no change of sign, or nothing known on one side of it, is none") {
  CHECK(find_grazings({}, [](double) { return std::optional(1.0); }).empty());
  CHECK(find_grazings({2}, [](double) { return std::optional(1.0); }).empty());
  CHECK(find_grazings(evenly(0, 1, 9), [](double a) { return std::optional(a + 1); }).empty());
  // Every second one of 34 values: the zero lies between the last two.
  const auto at_the_end = find_grazings(evenly(0, 33, 34), [](double a) { return std::optional(a - 32.5); });
  REQUIRE(at_the_end.size() == 1);
  CHECK(at_the_end[0].value == Approx(32.5).epsilon(1e-12));
  const auto unknown = [](double a) { return a < 0.5 ? std::nullopt : std::optional(a - 0.4); };
  CHECK(find_grazings(evenly(0, 1, 9), unknown).empty());
  // A gap in what is known ends the search where it meets it; what is bracketed by then is told.
  const auto holed = [](double a) { return std::abs(a - 0.55) < 0.01 ? std::nullopt : std::optional(a - 0.54); };
  const auto found = find_grazings(evenly(0, 1, 2), holed);
  REQUIRE(found.size() == 1);
  CHECK(found[0].low <= 0.54);
  CHECK(found[0].high >= 0.54);
}

}  // namespace grazing_tests

// What a contact law gives way follows from the law, not from the names of its parameters.

namespace contact_compliance_tests {

namespace {

/// F = c d^n on the lower side; its stiffness is called anything but that.
class Foam final : public ContactLaw {
 public:
  enum class Tells { constant, energy, nothing };
  Foam(Tells tells, double exponent) : tells_(tells), exponent_(exponent) {}
  std::optional<Evaluation> reads() const override { return Evaluation::explicit_start; }
  void prepare(int, std::span<const Parameters> lanes) override { hardness_ = lanes.front().real("hardness"); }
  void solve(ReducedProblem&) override {}
  double potential(const StopState& at) const override {
    const double depth = at.depth;
    if (tells_ == Tells::nothing) return 0;
    return depth > 0 ? hardness_ * std::pow(depth, exponent_ + 1) / (exponent_ + 1) : 0;
  }
  std::optional<ContactSlopes> linear_slopes(int) const override {
    return tells_ == Tells::constant ? std::optional(ContactSlopes{.stiffness = hardness_}) : std::nullopt;
  }

 private:
  Tells tells_;
  double exponent_, hardness_ = 0;
};

}  // namespace

TEST_CASE("compliance: declared, or the secant of what the law stores, or unknown") {
  const Parameters parameters({{"hardness", 2e6}});
  Foam linear(Foam::Tells::constant, 1), stored(Foam::Tells::energy, 1), stiffening(Foam::Tells::energy, 1.5),
      silent(Foam::Tells::nothing, 1);
  const auto compliance = [&](ContactLaw& law, double depth) { return contact_compliance(law, parameters, depth); };
  CHECK(compliance(linear, 1e-4) == 1 / 2e6);
  CHECK(compliance(stored, 1e-4).value() == Approx(1 / 2e6));
  // ½d²/(c d^2.5/2.5): softer the less it is pressed.
  CHECK(compliance(stiffening, 1e-4).value() == Approx(1.25 / (2e6 * std::sqrt(1e-4))));
  CHECK(compliance(stiffening, 1e-6).value() > compliance(stiffening, 1e-4).value());
  CHECK_FALSE(compliance(silent, 1e-4).has_value());
}

TEST_CASE("compliance: installed laws are ordered by it, rigid ones before all") {
  const auto compliance = [](const std::string& name, std::map<std::string, ParameterValue> set) {
    const auto* entry = registry().contact(name);
    REQUIRE(entry != nullptr);
    const Parameters parameters = complete(entry->manual.parameters, std::move(set));
    return contact_compliance(*entry->make(parameters), parameters, 1e-4).value();
  };
  CHECK(compliance("signorini", {}) == 0);
  CHECK(compliance("none", {}) == 0);
  CHECK(compliance("penalty", {{"stiffness", 1e8}}) == 1e-8);
  CHECK(compliance("penalty", {{"stiffness", 1e8}}) < compliance("penalty", {{"stiffness", 1e6}}));
  CHECK(compliance("hertz", {{"stiffness", 1e10}}) < compliance("hertz", {{"stiffness", 1e8}}));
}

}  // namespace contact_compliance_tests
