#include "lumped_diagonal.hpp"

namespace {

using namespace ricochet;

class Hrz : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (!space.given) return diagonal_inertia(lumped_diagonal(space, true));
    auto found = given_diagonal(*space.given);
    if (auto* refusal = std::get_if<Refusal>(&found)) return *refusal;
    return diagonal_inertia(std::get<Eigen::VectorXd>(found));
  }
  bool takes_given() const override { return true; }
};

void register_hrz(Registry& registry) {
  PluginManual manual;
  manual.name = "hrz";
  manual.words = "HRZ";
  manual.summary = "diagonal mass: the consistent diagonal scaled to the element's mass";
  manual.text =
      R"(The name under which many look for the lumped mass with scaled rotations: it is that of lumped. Of an assembled
          structure, the diagonal of its mass matrix, scaled in each of the directions x, y, z to the mass that a
          translation of all dofs moves, held ones included; rotations as the directions that the matrix couples with
          them. Point masses in that matrix are scaled, too.)";
  manual.source =
      R"(Hinton, Rock, Zienkiewicz 1976, A note on mass lumping and related processes in the finite element method,
          Earthquake Eng. Struct. Dyn. 4, 245-249)";
  registry.add_mass(std::move(manual), [](const Parameters&) { return std::make_unique<Hrz>(); });
}

}  // namespace

RICOCHET_PLUGIN(mass, hrz, register_hrz)
