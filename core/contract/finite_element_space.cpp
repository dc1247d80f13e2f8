#include <ricochet/contract/finite_element_space.hpp>

namespace ricochet {

std::array<double, 4> shape_values(FiniteElementSpace::Basis basis, double length, double xi) {
  if (basis == FiniteElementSpace::Basis::linear) return {1 - xi, xi, 0, 0};
  // Factored so that the values at ξ = 0 and ξ = 1 are exactly 0 or 1: a stop on a node then gives the nodal row.
  const double eta = 1 - xi;
  return {eta * eta * (1 + 2 * xi), length * xi * eta * eta, xi * xi * (3 - 2 * xi), -length * xi * xi * eta};
}

std::array<double, 4> shape_strains(FiniteElementSpace::Basis basis, double length, double xi) {
  if (basis == FiniteElementSpace::Basis::linear) return {-1 / length, 1 / length, 0, 0};
  const double curvature = (12 * xi - 6) / (length * length);
  return {curvature, (6 * xi - 4) / length, -curvature, (6 * xi - 2) / length};
}

const std::array<GaussPoint, 4>& gauss_points() {
  // ½(1 ± √(3/7 ∓ (2/7)√(6/5))) with weights ¼ ± √30/72 (Abramowitz and Stegun 1964, table 25.4, n = 4).
  static constexpr std::array<GaussPoint, 4> points{{{0.06943184420297371239, 0.17392742256872692869},
                                                     {0.33000947820757186760, 0.32607257743127307131},
                                                     {0.66999052179242813240, 0.32607257743127307131},
                                                     {0.93056815579702628761, 0.17392742256872692869}}};
  return points;
}

}  // namespace ricochet
