#include <algorithm>
#include <bit>
#include <ricochet/engine/flight/flight_memory.hpp>
#include <ricochet/engine/flight/flight_set.hpp>

namespace ricochet {
namespace {

constexpr int most_powers = 40;
constexpr double read_points = 16;  // of a set, of which tables are made to read them step by step

double reading_bytes(int modes, int slots, double points) {
  return 8 * points * (StepReadings::block + 1) * slots * modes;
}

}  // namespace

int flight_powers(long long steps) {
  return std::clamp(static_cast<int>(std::bit_width(static_cast<unsigned long long>(steps))), 4, most_powers);
}

double flight_set_bytes(int modes, int slots, int powers) {
  const double n = modes, width = slots + 3;
  return 8 * (2 * n * n + n * powers * (slots * width + 2 * width * (width + 1))) +
         reading_bytes(modes, slots, read_points);
}

std::size_t most_flight_sets(double set_bytes) {
  return static_cast<std::size_t>(std::clamp(0.25e9 / set_bytes, 1.0, 64.0));
}

// The motion without contact, the sets, the modes themselves, and rows of points over them for measures and bounds.
double flight_bytes(int modes, int slots, int points, long long steps) {
  const double set = flight_set_bytes(modes, slots, flight_powers(steps)), n = modes;
  const double sets = points > 0 ? static_cast<double>(most_flight_sets(set)) : 0;
  return set * (1 + sets) + reading_bytes(modes, slots, points) + 8 * n * (4 * n + 6.0 * points);
}

}  // namespace ricochet
