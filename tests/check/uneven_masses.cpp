// Masses that are right on equal elements of one section, and nowhere else.
#include <catch2/catch.hpp>

#include "runners/check/mass_checks.hpp"
#include "tests/check/sound_schemes.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using checking::CheckResult;
using checking::Finding;

namespace uneven_masses {
namespace {

using SpaceChange = std::function<void(FiniteElementSpace&)>;

/// The consistent mass of another space than the one that is given.
class Misread final : public MassStrategy {
 public:
  explicit Misread(SpaceChange change) : change_(std::move(change)) {}
  InertiaOrRefusal build(const FiniteElementSpace& given) const override {
    if (given.elements.empty()) return Refusal{"an oscillator has no elements: use another mass"};
    FiniteElementSpace space = given;
    change_(space);
    Inertia inertia;
    inertia.mass = consistent_mass(space);
    return inertia;
  }

 private:
  SpaceChange change_;
};

void caught(const SpaceChange& change, const std::string& check, const std::string& words) {
  Entry<MassStrategy> entry{full_manual("made-here"), {}, ""};
  entry.make = [change](const Parameters&) { return std::make_unique<Misread>(change); };
  const CheckResult result = one_check(checking::mass_checks(), entry, check);
  INFO(text_of({result}));
  CHECK(result.finding == Finding::fails);
  REQUIRE_FALSE(result.sentences.empty());
  CHECK_THAT(result.sentences.front(), Contains(words));
}

}  // namespace

TEST_CASE("check: a mass that takes one element for all is caught") {
  const std::string where = "unequal elements";
  caught(
      [](FiniteElementSpace& s) {
        for (auto& e : s.elements) e.line_density = s.elements.front().line_density;
      },
      "total mass", where);
  caught(
      [](FiniteElementSpace& s) {
        for (auto& e : s.elements) e.line_density = s.elements.back().line_density;
      },
      "total mass", where);
  caught(
      [](FiniteElementSpace& s) {
        for (auto& e : s.elements) e.length = s.elements.front().length;
      },
      "total mass", where);
  // The whole mass is right, its places are not.
  caught(
      [](FiniteElementSpace& s) {
        const double mean = checking::mass_of(s);  // over a length of 1 m
        for (auto& e : s.elements) e.line_density = mean;
      },
      "frequencies", "of unequal elements and two sections");
}

TEST_CASE("check: inertias against rotation that are lost, too large or on the wrong dof are caught") {
  caught(
      [](FiniteElementSpace& s) {
        for (auto& e : s.elements) e.rotary *= 1000;
      },
      "rotations", "the sections add");
  caught(
      [](FiniteElementSpace& s) {
        for (auto& e : s.elements) e.rotary *= -1;
      },
      "rotations", "the sections add");
  caught([](FiniteElementSpace& s) { std::erase_if(s.point_masses, [](const auto& p) { return p.rotation; }); },
         "rotations", "a point inertia of 0.05 kg m² adds 0 ");
  caught(
      [](FiniteElementSpace& s) {
        for (auto& p : s.point_masses)
          if (p.rotation) --p.dof;
      },
      "rotations", "a point inertia of 0.05 kg m² adds");
}

}  // namespace uneven_masses
