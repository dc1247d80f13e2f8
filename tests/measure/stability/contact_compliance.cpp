// What a contact law gives way follows from the law, not from the names of its parameters.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/measure/stability/linear_response.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

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
  double potential(double depth, int) const override {
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
