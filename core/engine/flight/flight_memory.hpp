#pragma once
#include <cstddef>

namespace ricochet {

/// Powers of two steps that tables of an integration of so many steps hold.
int flight_powers(long long steps);
/// Bytes of the tables of one set of closed points, over so many modes and slots.
double flight_set_bytes(int modes, int slots, int powers);
/// Sets of closed points that are remembered: as many as a quarter of a gigabyte holds, 64 at most.
std::size_t most_flight_sets(double set_bytes);
/// Bytes that leaving out steps may take in all; `points`: contact points, 0: none.
double flight_bytes(int modes, int slots, int points, long long steps);

}  // namespace ricochet
