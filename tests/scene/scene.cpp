#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <ricochet/scene/scene.hpp>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
using ricochet::testing::input_error;

namespace {
Section tube(double diameter, double wall) {
  Section section;
  section.type = Section::Type::tube;
  section.outer_diameter = diameter;
  section.wall = wall;
  return section;
}
std::string refused(const Section& section, double young = 1, double density = 1) {
  return input_error([&] { section_properties(section, young, density); });
}
}  // namespace

TEST_CASE("the working set has EI/ρS = 282.8125 m⁴/s²") {
  const auto properties = section_properties(tube(0.01, 0.0005), 2e11, 8000);
  // (E/ρ)(D² + d²)/16 with d = 9 mm: 2.5e7 · 181e-6/16. Differences of fourth powers leave a few ulps.
  CHECK(properties.EI / properties.rhoS == Approx(282.8125).epsilon(1e-14));
}

TEST_CASE("a tube whose wall is its radius is a circle, a circle lies between its squares") {
  Section circle;
  circle.type = Section::Type::circle;
  circle.diameter = 0.02;
  const auto disc = section_properties(circle, 3, 5), full = section_properties(tube(0.02, 0.01), 3, 5);
  CHECK(disc.EI == full.EI);
  CHECK(disc.rhoS == full.rhoS);
  CHECK(disc.EI == Approx(3 * std::numbers::pi * std::pow(0.02, 4) / 64).epsilon(1e-15));
  Section square;
  square.type = Section::Type::rectangle;
  square.width = square.height = 0.02;
  CHECK(section_properties(square, 3, 5).EI > disc.EI);
  CHECK(section_properties(square, 3, 5).rhoS == Approx(5 * 4e-4).epsilon(1e-15));
}

TEST_CASE("a rectangle bends across its height") {
  Section section;
  section.type = Section::Type::rectangle;
  section.width = 0.03;
  section.height = 0.01;
  CHECK(section_properties(section, 2e11, 8000).EI == Approx(2e11 * 0.03 * 1e-6 / 12).epsilon(1e-15));
}

TEST_CASE("given EI and ρS are taken as they are, young and density unread") {
  Section section;
  section.type = Section::Type::given;
  section.EI = 7;
  section.rhoS = 3;
  CHECK(section_properties(section, 0, 0).EI == 7);
  CHECK(section_properties(section, 0, 0).rhoS == 3);
}

TEST_CASE("a section that cannot exist is refused with its place, values and units") {
  CHECK(refused(tube(0.01, 0.006)) ==
        "/scene/structure/section/wall: the wall, 0.006 m, is thicker than the radius, 0.005 m; expected at most the "
        "radius");
  CHECK(refused(tube(-0.01, 0.001)) ==
        "/scene/structure/section/outer_diameter: the outer diameter is -0.01 m; expected a finite number above 0");
  CHECK_THAT(refused(tube(0.01, 0)), Contains("/scene/structure/section/wall: "));
  CHECK_THAT(refused(tube(0.01, 0.001), 0), Contains("/scene/structure/young: ") && Contains("Pa"));
  CHECK_THAT(refused(tube(0.01, 0.001), 1, -8000), Contains("/scene/structure/density: ") && Contains("-8000 kg/m³"));
  Section section;
  section.type = Section::Type::circle;
  CHECK_THAT(refused(section), Contains("/scene/structure/section/diameter: "));
  section.type = Section::Type::rectangle;
  CHECK_THAT(refused(section), Contains("/scene/structure/section/width: "));
  section.width = 1;
  CHECK_THAT(refused(section), Contains("/scene/structure/section/height: "));
  section.type = Section::Type::given;
  CHECK_THAT(refused(section), Contains("/scene/structure/section/EI: "));
  section.EI = 1;
  CHECK_THAT(refused(section), Contains("/scene/structure/section/rhoS: "));
}
