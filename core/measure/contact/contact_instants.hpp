#pragma once
#include <array>
#include <cstddef>
#include <limits>

namespace ricochet {

enum class StopSide { lower, upper };

/// One instant at which a contact point is pushed; what Ω, I and F are, impact_recorder.hpp says.
struct ContactInstant {
  int point = 0;
  StopSide side = StopSide::lower;
  double time = 0;      ///< of the effort, s
  double lasts = 0;     ///< Ω, s
  double given = 0;     ///< I, N s
  double force = 0;     ///< F, N
  bool closes = false;  ///< whether the point was open before; contact from the start was not
  double speed_in = 0;  ///< towards the stop when the point last closed, m/s
  /// Its row in the list of impacts; above any row where it has none.
  std::size_t impact = std::numeric_limits<std::size_t>::max();
  std::array<double, 2> normal = {0, 0};  ///< of a clearance, the direction in which it is met
};

/// Is told of the instants of lane 0, those of steps that were left out too, in order of time.
class ContactListener {
 public:
  virtual ~ContactListener() = default;
  virtual void instant(const ContactInstant& one) = 0;
  /// After those of one time, also of a time at which what was closed is not pushed.
  virtual void over(double /*time*/) {}
};

}  // namespace ricochet
