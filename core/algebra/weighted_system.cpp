#include <cmath>
#include <ricochet/algebra/weighted_system.hpp>

namespace ricochet {

QuasiDefinite weighted_system(double k, const SparseMatrix& stiffness, double m, const Inertia& inertia) {
  QuasiDefinite matrix;
  matrix.A = k * stiffness;
  if (inertia.assembled()) {
    matrix.A += m * inertia.mass;
  } else if (m != 0) {
    const MassFactors factors = mass_factors(inertia);
    matrix.G = std::sqrt(m) * factors.coupling;
    matrix.Cv = factors.velocity_mass;
    matrix.border_first = inertia.inverted();
  }
  return matrix;
}

}  // namespace ricochet
