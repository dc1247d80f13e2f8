#include "lumped_diagonal.hpp"
#include "without_inertia.hpp"

namespace {

using namespace ricochet;

class Lumped : public MassStrategy {
 public:
  explicit Lumped(bool rotations) : rotations_(rotations) {}

  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (auto refusal = refuse_rotary_inertia(space); refusal && !rotations_) return *refusal;
    return diagonal_inertia(lumped_diagonal(space, rotations_));
  }

 private:
  bool rotations_;
};

void register_lumped(Registry& registry) {
  PluginManual manual;
  manual.name = "lumped";
  manual.summary = "diagonal mass: half of each element at its ends";
  manual.text =
      R"(Hermite elements: the consistent diagonal scaled to the element's mass, ρSℓ/2 per translation and ρSℓ³/78 per
          rotation; rotation = none leaves rotations without inertia, a singular mass whose kernel is the rotations
          (its contact nodes still carry inertia, unlike the singular method). Linear elements: row sums, ρSℓ/2.
          Frequencies converge with order 2 in the element length.)";
  manual.source =
      R"(Hinton, Rock, Zienkiewicz 1976, A note on mass lumping and related processes in the finite element method,
          Earthquake Eng. Struct. Dyn. 4, 245-249)";
  manual.parameters = {word_parameter("rotation", {"scaled", "none"}, "scaled",
                                      "inertia of the rotations: ρSℓ³/78 per element end, or none (singular mass)")};
  registry.add_mass(std::move(manual), [](const Parameters& parameters) {
    return std::make_unique<Lumped>(parameters.word("rotation") == "scaled");
  });
}

}  // namespace

RICOCHET_PLUGIN(mass, lumped, register_lumped)
