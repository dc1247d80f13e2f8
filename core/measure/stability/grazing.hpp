#pragma once
#include <functional>
#include <optional>
#include <vector>

namespace ricochet {

/// A value of a parameter at which the periodic motion without contact touches a stop for the first time.
struct Grazing {
  bool opens_below = false;  ///< whether the motion is without contact below the value
  double value = 0, low = 0, high = 0;
  int steps = 0;  ///< halvings made
};

/// Zeros of the overlap of a motion with its stops along a parameter. `overlap` (< 0: no contact, see
/// linear_response.hpp; nothing where it is not known) is looked at in about 17 of the values (ascending); where its
/// sign changes from one to the next, the zero is bisected to 1e-12 of its size, at most 60 times. Two zeros between
/// two of these values are not seen.
std::vector<Grazing> find_grazings(const std::vector<double>& values,
                                   const std::function<std::optional<double>(double value)>& overlap);

}  // namespace ricochet
