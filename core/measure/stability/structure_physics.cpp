#include <algorithm>
#include <numbers>
#include <ricochet/measure/stability/no_contact.hpp>
#include <ricochet/measure/stability/structure_modes.hpp>
#include <ricochet/measure/stability/structure_physics.hpp>

namespace ricochet {
namespace {

// Beyond, a dense eigenvalue problem takes longer than a person waits for a plan (0.1 s); the first frequencies have
// converged long before.
constexpr int most_elements = 120;

struct Numbers {
  std::vector<PhysicalNumber> operator()(const BeamSpec& beam) const {
    const SectionProperties section = section_properties(beam.section, beam.young, beam.density);
    return {{"EI", section.EI, "N m²"}, {"ρS", section.rhoS, "kg/m"}, {"length", beam.length, "m"}};
  }
  std::vector<PhysicalNumber> operator()(const OscillatorSpec& oscillator) const {
    return {{"k", oscillator.stiffness, "N/m"}, {"m", oscillator.mass, "kg"}};
  }
  std::vector<PhysicalNumber> operator()(const BarSpec& bar) const {
    return {{"EA", bar.EA, "N"}, {"ρA", bar.rhoA, "kg/m"}, {"length", bar.length, "m"}};
  }
};

}  // namespace

std::optional<double> StructurePhysics::damping_ratio(std::size_t mode) const {
  const double pulsation = pulsations.at(mode);
  if (pulsation == 0 || (damping.stiffness == 0 && damping.mass == 0)) return std::nullopt;
  return (damping.stiffness * pulsation + damping.mass / pulsation) / 2;
}

int StructurePhysics::resolved(double h, double steps_per_period) const {
  return static_cast<int>(std::count_if(pulsations.begin(), pulsations.end(), [&](double pulsation) {
    return pulsation * h * steps_per_period <= 2 * std::numbers::pi;
  }));
}

std::variant<StructurePhysics, Refusal> structure_physics(const SceneSpec& scene, int elements,
                                                          const MassStrategy& mass) {
  StructurePhysics out;
  out.elements = std::min(elements, most_elements);
  // Nor where the structure begins.
  NoContact nothing;
  const Parameters none;
  const auto made = discretise(scene, out.elements, mass, &nothing, &none);
  if (const auto* refusal = std::get_if<Refusal>(&made)) return *refusal;
  const SemiDiscrete& problem = std::get<SemiDiscrete>(made);
  out.damping = problem.damping;
  out.structure = problem.space.structure;
  out.numbers = std::visit(Numbers{}, scene.structure);
  if (out.damping.stiffness != 0) out.numbers.push_back({"α", out.damping.stiffness, "s"});
  if (out.damping.mass != 0) out.numbers.push_back({"η", out.damping.mass, "1/s"});
  const StructureModes modes = open_modes(problem);
  for (int i = 0; i < modes.regular; ++i) out.pulsations.push_back(modes.pulsation(i));
  return out;
}

}  // namespace ricochet
