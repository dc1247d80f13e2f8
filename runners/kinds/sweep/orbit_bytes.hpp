#pragma once
#include <string>

#include "runners/kinds/sweep/orbit_scheduler.hpp"

namespace ricochet {

/// Marched orbits as bytes and back, bit for bit, so that an interrupted sweep goes on as if it had not stopped. The
/// lane of an orbit is not kept: its task knows it. Bytes that to_bytes() did not write throw std::runtime_error.
std::string to_bytes(const MarchedOrbits& marched);
MarchedOrbits marched_orbits(const std::string& bytes);

}  // namespace ricochet
