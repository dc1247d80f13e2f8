#include <algorithm>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/supports.hpp>

namespace ricochet {
namespace {

// Of several sections, the stiffest says how stiff the beam is.
void add_stiffness(const BeamSpec& beam, SemiDiscrete& problem) {
  for (const UniformPart& part : uniform_parts(beam)) problem.rigidity = std::max(problem.rigidity, part.section.EI);
  problem.stiffness = beam_stiffness(beam, problem.space);
}
void add_stiffness(const BarSpec& bar, SemiDiscrete& problem) {
  problem.rigidity = bar.EA;
  problem.stiffness = axial_stiffness(problem.space, bar.EA);
}
void add_stiffness(const OscillatorSpec& oscillator, SemiDiscrete& problem) {
  problem.rigidity = oscillator.stiffness;
  problem.stiffness.resize(1, 1);
  problem.stiffness.insert(0, 0) = oscillator.stiffness;
  problem.stiffness.makeCompressed();
}

void add_stiffness(const AssembledSpec& spec, SemiDiscrete& problem) {
  const AssembledStructure& structure = *spec.structure;
  problem.stiffness = structure.stiffness;
  problem.notes = structure.notes;
}

}  // namespace

SemiDiscrete structure_alone(const StructureSpec& structure, int elements) {
  SemiDiscrete problem;
  problem.space = make_space(structure, elements);
  std::visit([&](const auto& spec) { add_stiffness(spec, problem); }, structure);
  problem.damping = damping_of(structure);
  problem.support_shape = rigid_motion_load(problem.space);
  hold_by_supports(structure, elements, problem);
  return problem;
}

}  // namespace ricochet
