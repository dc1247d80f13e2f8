#include "lumped_diagonal.hpp"

namespace {

using namespace ricochet;

class Hrz : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    return diagonal_inertia(lumped_diagonal(space, true));
  }
};

void register_hrz(Registry& registry) {
  PluginManual manual;
  manual.name = "hrz";
  manual.words = "HRZ";
  manual.summary = "diagonal mass: the consistent diagonal scaled to the element's mass";
  manual.text = "The name under which many look for the lumped mass with scaled rotations: it is that of lumped.";
  manual.source =
      R"(Hinton, Rock, Zienkiewicz 1976, A note on mass lumping and related processes in the finite element method,
          Earthquake Eng. Struct. Dyn. 4, 245-249)";
  registry.add_mass(std::move(manual), [](const Parameters&) { return std::make_unique<Hrz>(); });
}

}  // namespace

RICOCHET_PLUGIN(mass, hrz, register_hrz)
