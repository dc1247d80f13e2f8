#include <algorithm>
#include <cmath>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/whole_load.hpp>

namespace ricochet {

std::vector<HarmonicForce> harmonic_forces(const SceneSpec& scene) {
  if (const auto* one = std::get_if<OscillatorSpec>(&scene.structure))
    return {{one->force, "", "/scene/structure/force"}};
  std::vector<HarmonicForce> forces;
  const auto* spec = std::get_if<AssembledSpec>(&scene.structure);
  if (!spec || !spec->bodies) return forces;
  for (const Body& body : spec->bodies->all)
    if (const auto* one = std::get_if<OscillatorSpec>(&body.structure))
      forces.push_back({one->force, body.name, "/scene/bodies/" + body.name + "/force"});
  return forces;
}

LoadSpec whole_load(const SceneSpec& scene) {
  LoadSpec load = scene.load;
  for (const auto& [force, body, pointer] : harmonic_forces(scene)) {
    if (force.amplitude == 0) continue;
    const double at_start = force.amplitude * std::cos(force.phase);
    if (force.pulsation == 0 && body.empty() && !load.formula.uses_t()) {
      load.formula = Formula(load.formula(0) + at_start);
      continue;
    }
    LoadTerm& term = load.terms.emplace_back();
    term.force = true;
    term.history = force.pulsation == 0 ? Formula(at_start) : Formula(force, pointer);
    if (body.empty()) continue;
    term.place.emplace();
    term.place->body = body;
  }
  return load;
}

bool is_driven(const SceneSpec& scene) {
  if (!scene.load.is_zero() || scene.support.amplitude != 0 || moves_by_histories(scene)) return true;
  const std::vector<HarmonicForce> forces = harmonic_forces(scene);
  return std::any_of(forces.begin(), forces.end(), [](const HarmonicForce& one) { return one.force.amplitude != 0; });
}

}  // namespace ricochet
