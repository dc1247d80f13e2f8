#pragma once
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// What descriptions in modes do not say of a scene, a sentence each. A force at point a moves point b by (R_ba + Σ_k
/// Φ_bk Φ_ak / K_kk) F at rest, and R is known where both points have a row of the residual flexibility. Told are loads
/// and supports that move, whose static part at the stops is not known. The same for stops and points that are shown,
/// which do not follow forces beyond the modes. With a load stands what its fastest mode gives of its static
/// displacement at the stop where that is most. Empty where no structure is in modes.
std::vector<std::string> missing_residuals(const SceneSpec& scene, const FiniteElementSpace& space);

}  // namespace ricochet
