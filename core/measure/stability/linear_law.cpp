#include <ricochet/measure/stability/stability.hpp>
#include <ricochet/scene/stop_parameters.hpp>

namespace ricochet {

LinearLaw linear_law(ContactLaw& law, int points, const Parameters& parameters, const OwnParameters& stops) {
  LinearLaw out;
  out.absent = law.absent() || points == 0;
  if (out.absent) return out;
  prepare_law(law, points, std::span<const Parameters>(&parameters, 1), stops);
  out.evaluation = law.reads();
  out.stiffness = constant_stiffness(law);
  for (int i = 0; out.stiffness && sets_per_point(law, stops) && i < points; ++i) {
    const auto own = constant_stiffness(law, i);
    if (own)
      out.own.push_back(*own);
    else
      out.stiffness.reset();
  }
  return out;
}

}  // namespace ricochet
