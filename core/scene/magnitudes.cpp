#include <fmt/format.h>

#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/planes.hpp>

namespace ricochet {

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
