#include <fmt/format.h>

#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/require_positive.hpp>

namespace ricochet {

void require_positive(double value, const char* key, const char* what, const char* unit) {
  if (std::isfinite(value) && value > 0) return;
  throw InputError(fmt::format("/scene/structure/{}", key),
                   fmt::format("{} is {:.6g} {}; expected a finite number above 0", what, value, unit));
}

}  // namespace ricochet
