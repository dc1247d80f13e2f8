#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "runners/table/number_table.hpp"

namespace ricochet {

/// The motion of one case at a bounded number of places and instants, to be looked at. Displacements and forces are
/// kept as 16-bit counts of a unit of their own, so that the largest is 32767 of them: what is drawn, not what is
/// measured.
struct Snapshots {
  bool along = false;                      ///< displacements are along the structure (a bar), not across it
  std::vector<double> t;                   ///< s, whole steps, the first is 0
  std::vector<double> clamp;               ///< φ at these times, m
  std::vector<double> x;                   ///< m, at most most_places; of a structure without length one, 0
  double metres = 0;                       ///< of one count
  std::vector<std::int16_t> displacement;  ///< absolute, times × places
  /// Contact points, at most most_places; of more than that, neighbours are one, with the gap of the closest.
  std::vector<double> point, lower, upper;  ///< place and stops, m; ±∞ where there is no stop
  double newtons = 0;                       ///< of one count
  /// Entries of times × points with a force, in order, and the force there: what the efforts gave since the snapshot
  /// before, over the time between, positive upwards. Of neighbours the largest.
  std::vector<std::uint32_t> pushed;
  std::vector<std::int16_t> force;

  static constexpr int most_places = 65, most_instants = 2000;
};

/// As a table of the case that is not exported: `series` of its columns are the bytes of the counts, four in each
/// number; as a blob they are little-endian 16 (pushed: 32) bit integers, padded with zeros behind the last.
NumberTable table_of(const Snapshots& snapshots);
/// What table_of() was given; nothing for a table that is not whole.
std::optional<Snapshots> snapshots_of(const NumberTable& table);
/// The name of that table.
inline constexpr const char* snapshots_name = "snapshots";

}  // namespace ricochet
