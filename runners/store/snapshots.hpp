#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/table/number_table.hpp"

namespace ricochet {

/// The motion of one case at a bounded number of places and instants, to be looked at. Displacements and forces are
/// kept as 16-bit counts of a unit of their own: the largest is 32767 of them. They are drawn, not measured.
struct Snapshots {
  std::string of;                          ///< the orbit that it is of, in words; "": the motion of the case
  bool along = false;                      ///< displacements are along the structure (a bar), not across it
  std::vector<double> t;                   ///< s, whole steps, the first is 0
  std::vector<double> clamp;               ///< φ at these times, m
  std::vector<double> x;                   ///< m, at most most_places; of a structure without length one, 0
  double metres = 0;                       ///< of one count
  std::vector<std::int16_t> displacement;  ///< absolute, times × places
  /// Contact points, at most most_places; of more than that, neighbours are one, with the gap of the closest.
  std::vector<double> point, lower, upper;  ///< place and stops, m; ±∞ where there is no stop
  double newtons = 0;                       ///< of one count
  /// Entries of times × points with a force, in order, and the force there, positive upwards. The force is what the
  /// efforts gave since the snapshot before, over the time between. Of neighbours the largest.
  std::vector<std::uint32_t> pushed;
  std::vector<std::int16_t> force;

  /// A stop of a contact point. Places count from 0; 2.25 is a quarter of the way from the third to the fourth.
  struct Stop {
    double at = -1, to = -1;            ///< −1: none that is drawn, the ground
    std::array<double, 2> direction{};  ///< of the displacement that it bounds; the first alone where there is one
    std::string name = {};              ///< where it has one
    bool operator==(const Stop&) const = default;
  };
  std::vector<Stop> stops;
  /// Nodes: x and y are their places on the plane of two axes (0 x, 1 y, 2 z). Each has two displacements along these.
  /// Axes 2, 1: structures along x, displaced along z and y. Else y is empty; with names, places are points without a
  /// place, one bar each.
  std::array<std::size_t, 2> axes{0, 1};
  std::vector<std::string> names;  ///< of the places; empty for one beam in one plane, bar or oscillator
  std::vector<double> y;
  std::vector<int> held;
  std::vector<std::pair<int, int>> links;
  std::vector<std::pair<std::string, int>> bodies;  ///< of several, name and first place

  /// Displacements at one instant.
  std::size_t values() const { return y.empty() ? x.size() : 2 * x.size(); }

  static constexpr int most_places = 65, most_nodes = 200, most_instants = 2000;
};

/// As a table of the case that is not exported. `series` of its columns are the bytes of the counts, four (pushed: two)
/// in each number. As a blob they are little-endian 16 (pushed: 32) bit integers, padded with zeros behind the last.
NumberTable table_of(const Snapshots& snapshots);
/// What table_of() was given; nothing for a table that is not whole.
std::optional<Snapshots> snapshots_of(const NumberTable& table);
/// The name of that table.
inline constexpr const char* snapshots_name = "snapshots";

}  // namespace ricochet
