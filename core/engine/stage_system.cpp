#include <cmath>
#include <ricochet/engine/stage_system.hpp>

namespace ricochet {

QuasiDefinite stage_system(const MarchModel& model, const FoldedStage& stage) {
  QuasiDefinite matrix;
  matrix.A = stage.stiffness * model.stiffness();
  const Inertia& inertia = model.inertia();
  if (inertia.assembled()) {
    matrix.A += stage.mass * inertia.mass;
  } else if (stage.mass != 0) {
    const MassFactors factors = mass_factors(inertia);
    matrix.G = std::sqrt(stage.mass) * factors.coupling;
    matrix.Cv = factors.velocity_mass;
    matrix.border_first = inertia.inverted();
  }
  return matrix;
}

}  // namespace ricochet
