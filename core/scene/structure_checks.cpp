#include <fmt/format.h>

#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/planes.hpp>

namespace ricochet {

void require_positive(double value, const char* key, const char* what, const char* unit) {
  if (std::isfinite(value) && value > 0) return;
  throw InputError(fmt::format("/scene/structure/{}", key),
                   fmt::format("{} is {:.6g} {}; expected a finite number above 0", what, value, unit));
}

namespace {

/// At /scene/structure/`key`.
void demand(bool holds, const std::string& key, const std::string& message) {
  if (!holds) throw InputError("/scene/structure/" + key, message);
}

void demand_not_negative(double value, const std::string& key, const char* what, const char* unit) {
  demand(std::isfinite(value) && value >= 0, key,
         fmt::format("{} is {:.6g} {}; expected a finite number, 0 or above", what, value, unit));
}

void demand_inside(const BeamSpec& beam, double x, const std::string& key) {
  demand(std::isfinite(x) && x >= -one_place * beam.length && x <= (1 + one_place) * beam.length, key,
         fmt::format("{:.6g} m; expected 0 to L = {:.6g}", x, beam.length));
}

void check_supports(const BeamSpec& beam) {
  if (!beam.supports) return;
  const std::vector<BeamSupport>& supports = *beam.supports;
  for (std::size_t i = 0; i < supports.size(); ++i) {
    const BeamSupport& support = supports[i];
    const std::string key = fmt::format("supports/{}", i);
    demand_inside(beam, support.x, key + "/x");
    demand(!support.name.empty(), key + "/name", "an empty name; expected letters, digits, '-' or '_'");
    demand_not_negative(support.stiffness, key + "/stiffness", "the stiffness of the support", "N/m");
    demand_not_negative(support.rotation, key + "/rotation", "the stiffness of the support against rotation",
                        "N m/rad");
    demand(support.type != BeamSupport::Type::elastic || support.stiffness > 0 || support.rotation > 0,
           key + "/stiffness", "an elastic support without springs; expected stiffness or rotation above 0");
    for (std::size_t j = 0; j < i; ++j) {
      demand(std::abs(support.x - supports[j].x) > one_place * beam.length, key + "/x",
             fmt::format("two supports at x = {:.6g} m; expected different places", support.x));
      demand(support.name != supports[j].name, key + "/name",
             fmt::format("two supports are called \"{}\"; expected different names", support.name));
    }
  }
}

void check_sections(const BeamSpec& beam) {
  double before = 0;
  for (std::size_t i = 0; i < beam.sections.size(); ++i) {
    const double to = beam.sections[i].to;
    const std::string key = fmt::format("sections/{}/to", i);
    demand_inside(beam, to, key);
    demand(to > before + one_place * beam.length, key,
           fmt::format("{:.6g} m; expected more than {:.6g}, where the section begins", to, before));
    const bool last = i + 1 == beam.sections.size();
    demand(!last || std::abs(to - beam.length) <= one_place * beam.length, key,
           fmt::format("the last section ends at {:.6g} m; expected L = {:.6g}", to, beam.length));
    before = to;
  }
}

void check_masses(const BeamSpec& beam) {
  for (std::size_t i = 0; i < beam.masses.size(); ++i) {
    const std::string key = fmt::format("masses/{}", i);
    demand_inside(beam, beam.masses[i].x, key + "/x");
    demand_not_negative(beam.masses[i].mass, key + "/mass", "the point mass", "kg");
    demand_not_negative(beam.masses[i].inertia, key + "/inertia", "the inertia against rotation", "kg m²");
  }
}

void check_tension(const BeamSpec& beam, int elements) {
  demand(std::isfinite(beam.tension), "tension", "the tension is not finite");
  if (beam.tension >= 0) return;
  const double limit = buckling_load(beam, elements);
  demand(limit > 0, "tension",
         fmt::format("the tension {:.6g} N compresses a beam that nothing keeps from turning; expected 0 or above",
                     beam.tension));
  demand(-beam.tension < limit, "tension",
         fmt::format("the tension {:.6g} N is beyond the first buckling load, {:.6g} N; expected a tension above that",
                     beam.tension, -limit));
}

void check_planes(const BeamSpec& beam) {
  demand(beam.planes == 1 || beam.planes == 2, "planes", fmt::format("{} planes; expected 1 or 2", beam.planes));
  if (beam.planes == 2) return;
  const auto one_plane = [](const Section& section, const std::string& key) {
    demand(section.EI_z == 0, key + "/EI_z", "a beam of one plane bends with EI alone; expected planes 2");
  };
  one_plane(beam.section, "section");
  for (std::size_t i = 0; i < beam.sections.size(); ++i)
    one_plane(beam.sections[i].section, fmt::format("sections/{}/section", i));
  for (std::size_t i = 0; beam.supports && i < beam.supports->size(); ++i)
    demand((*beam.supports)[i].in_plane == std::array<bool, 2>{true, true}, fmt::format("supports/{}/components", i),
           "a beam of one plane moves along uy alone; expected planes 2");
}

void check_shear(const BeamSpec& beam) {
  if (!beam.shear) return;
  const double poisson = beam.shear->poisson;
  demand(poisson > -1 && poisson <= 0.5, "shear/poisson",
         fmt::format("Poisson's ratio is {:.6g}; expected a number in ]-1, 0.5]", poisson));
  const double factor = beam.shear->factor.value_or(1);
  demand(std::isfinite(factor) && factor > 0, "shear/factor",
         fmt::format("the shear factor is {:.6g}; expected a finite number above 0", factor));
}

}  // namespace

void check_beam(const BeamSpec& beam, int elements) {
  check_planes(beam);
  check_supports(beam);
  check_sections(beam);
  check_masses(beam);
  demand_not_negative(beam.added_mass, "added_mass", "the added mass", "kg/m");
  demand_not_negative(beam.foundation, "foundation", "the stiffness of the foundation", "N/m²");
  check_shear(beam);
  uniform_parts(beam);
  check_tension(beam, elements);
  demand(beam_space(beam, elements).dofs > 0, "supports",
         "the supports hold every dof of this mesh; expected more elements, or fewer supports");
}

namespace {

// Squares of coefficients are numbers too: norms, energies and pulsations are made of them.
constexpr double smallest = 1e-150, largest = 1e150;

void representable(double value, const std::string& pointer, const char* what, const char* unit) {
  const double size = std::abs(value);
  if (value == 0 || (size >= smallest && size <= largest)) return;
  throw InputError(pointer, fmt::format("{} comes out as {:.6g} {}; expected a size between {:g} and {:g}", what, value,
                                        unit, smallest, largest));
}

// As representable(), and not zero: a product of positive numbers that has none left is no number of the scene's.
void not_zero(double value, const std::string& pointer, const char* what, const char* unit) {
  if (value == 0)
    throw InputError(pointer, fmt::format("{} comes out as 0 {}; expected a size between {:g} and {:g}", what, unit,
                                          smallest, largest));
  representable(value, pointer, what, unit);
}

void check_damping(const Damping& damping, double stiffness, double mass) {
  representable(damping.stiffness * stiffness, "/scene/structure/damping/stiffness", "the damping of an element α·k",
                "N s/m");
  representable(damping.mass * mass, "/scene/structure/damping/mass", "the damping of an element η·m", "N s/m");
}

// An element's stiffness and mass, and the pulsation of the one on the other.
void check_element(const Damping& damping, double stiffness, double mass) {
  const std::string length = "/scene/structure/length";
  not_zero(stiffness, length, "the stiffness of an element", "N/m");
  not_zero(mass, length, "the mass of an element", "kg");
  not_zero(stiffness / mass, length, "the squared pulsation of an element", "1/s²");
  check_damping(damping, stiffness, mass);
}

void check(const BeamSpec& beam, const SectionProperties& section, double length) {
  not_zero(section.EI, "/scene/structure/section", "the bending stiffness EI", "N m²");
  not_zero(section.rhoS, "/scene/structure/section", "the line density ρS", "kg/m");
  not_zero(section.EI / length, "/scene/structure/length", "the rotational stiffness of an element", "N m");
  not_zero(section.rhoS * length * length * length, "/scene/structure/length", "the rotational inertia of an element",
           "kg m²");
  check_element(beam.damping, section.EI / length / length / length, section.rhoS * length);
}

void check(const BeamSpec& beam, int elements) {
  if (beam.planes == 2) {
    for (const int plane : {0, 1}) check(in_plane(beam, plane), elements);
    return;
  }
  const std::vector<UniformPart> parts = uniform_parts(beam);
  for (const BeamInterval& interval : beam_intervals(beam, elements)) {
    const double length = interval.length / interval.elements;
    check(beam, part_at(parts, interval.from + interval.length / 2).section, length);
    representable(beam.tension / length, "/scene/structure/tension", "the stiffness of an element by tension", "N/m");
    representable(beam.foundation * length, "/scene/structure/foundation", "the foundation under an element", "N/m");
  }
  for (const BeamSupport& support : supports_of(beam)) {
    representable(support.stiffness, "/scene/structure/supports", "the stiffness of a support", "N/m");
    representable(support.rotation, "/scene/structure/supports", "the stiffness of a support", "N m/rad");
  }
  for (const BeamMass& mass : beam.masses) {
    representable(mass.mass, "/scene/structure/masses", "a point mass", "kg");
    representable(mass.inertia, "/scene/structure/masses", "the inertia of a point mass", "kg m²");
  }
}

void check(const BarSpec& bar, int elements) {
  const double length = bar.length / elements;
  check_element(bar.damping, bar.EA / length, bar.rhoA * length);
}

void check(const AssembledSpec&, int) {}

void check(const OscillatorSpec& oscillator, int) {
  not_zero(oscillator.mass, "/scene/structure/mass", "the mass", "kg");
  representable(oscillator.stiffness, "/scene/structure/stiffness", "the stiffness", "N/m");
  representable(oscillator.stiffness / oscillator.mass, "/scene/structure/stiffness", "the squared pulsation k/m",
                "1/s²");
  representable(oscillator.damping / oscillator.mass, "/scene/structure/damping", "the rate of damping c/m", "1/s");
}

}  // namespace

void check_magnitudes(const SceneSpec& scene, int elements) {
  std::visit([&](const auto& structure) { check(structure, elements); }, scene.structure);
  const double w = scene.support.pulsation;
  representable(scene.support.amplitude, "/scene/support/amplitude", "the amplitude of the support", "m");
  representable(w, "/scene/support/pulsation", "the pulsation of the support", "rad/s");
  representable(scene.support.amplitude * w * w, "/scene/support/pulsation", "the acceleration of the support", "m/s²");
}

}  // namespace ricochet
