#include <cmath>
#include <ricochet/measure/stability/contact_compliance.hpp>

namespace ricochet {

std::optional<double> contact_compliance(ContactLaw& law, const Parameters& parameters, double depth) {
  if (law.absent() || !law.reads()) return 0;
  law.prepare(1, std::span<const Parameters>(&parameters, 1));
  if (const auto stiffness = constant_stiffness(law)) return 1 / *stiffness;
  const double secant = 0.5 * depth * depth / law.potential(depth, 0);
  return secant > 0 && std::isfinite(secant) ? std::optional(secant) : std::nullopt;
}

}  // namespace ricochet
