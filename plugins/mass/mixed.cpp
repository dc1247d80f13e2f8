#include "lumped_diagonal.hpp"

namespace {

using namespace ricochet;

/// M = (1−r) M_consistent + r M_lumped.
class Mixed : public MassStrategy {
 public:
  explicit Mixed(double lumped) : r_(lumped) {}

  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    const Inertia lumped = diagonal_inertia(lumped_diagonal(space, true));
    Inertia inertia;
    inertia.mass = (1 - r_) * consistent_mass(space) + r_ * lumped.mass;
    inertia.kernel_dimension = lumped.kernel_dimension;
    return inertia;
  }

 private:
  double r_;
};

void register_mixed(Registry& registry) {
  PluginManual manual;
  manual.name = "mixed";
  manual.summary = "between the consistent and the lumped mass: (1−r) M_c + r M_l";
  manual.text =
      R"(The consistent matrix gives frequencies that are too high, the lumped one frequencies that are too low: on a
          uniform bar r = ½ cancels the leading errors of both, and frequencies converge with order 4 in the element
          length. On a beam of Hermite elements nothing cancels, and r > 0 leaves order 2. r = 0 is consistent, r = 1
          lumped.)";
  manual.source =
      R"(Goudreau and Taylor 1973, Evaluation of numerical integration methods in elastodynamics, Comput. Methods
          Appl. Mech. Eng. 2, 69-97)";
  manual.parameters = {real_parameter("r", "1", 0.5, {.low = 0, .high = 1}, "r, share of the lumped mass")};
  registry.add_mass(std::move(manual), [](const Parameters& p) { return std::make_unique<Mixed>(p.real("r")); });
}

}  // namespace

RICOCHET_PLUGIN(mass, mixed, register_mixed)
