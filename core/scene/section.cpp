#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/scene.hpp>

namespace ricochet {
namespace {

constexpr double pi = std::numbers::pi;

/// Second moment of area I (m⁴) and area S (m²).
struct Moments {
  double inertia = 0, area = 0;
};

Moments disc(double diameter) {
  const double square = diameter * diameter;
  return {pi * square * square / 64, pi * square / 4};
}

Moments tube(const Section& section) {
  require_positive(section.outer_diameter, "section/outer_diameter", "the outer diameter", "m");
  require_positive(section.wall, "section/wall", "the wall", "m");
  if (section.wall > section.outer_diameter / 2)
    throw InputError(
        "/scene/structure/section/wall",
        fmt::format("the wall, {:.6g} m, is thicker than the radius, {:.6g} m; expected at most the radius",
                    section.wall, section.outer_diameter / 2));
  const Moments outer = disc(section.outer_diameter), inner = disc(section.outer_diameter - 2 * section.wall);
  return {outer.inertia - inner.inertia, outer.area - inner.area};
}

Moments circle(const Section& section) {
  require_positive(section.diameter, "section/diameter", "the diameter", "m");
  return disc(section.diameter);
}

Moments rectangle(const Section& section) {
  require_positive(section.width, "section/width", "the width", "m");
  require_positive(section.height, "section/height", "the height", "m");
  return {section.width * std::pow(section.height, 3) / 12, section.width * section.height};
}

}  // namespace

SectionProperties section_properties(const Section& section, double young, double density) {
  if (section.type == Section::Type::given) {
    require_positive(section.EI, "section/EI", "the bending stiffness EI", "N m²");
    require_positive(section.rhoS, "section/rhoS", "the line density ρS", "kg/m");
    return {section.EI, section.rhoS};
  }
  require_positive(young, "young", "Young's modulus", "Pa");
  require_positive(density, "density", "the density", "kg/m³");
  const Moments moments = section.type == Section::Type::tube     ? tube(section)
                          : section.type == Section::Type::circle ? circle(section)
                                                                  : rectangle(section);
  return {young * moments.inertia, density * moments.area};
}

}  // namespace ricochet
