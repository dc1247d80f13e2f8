#pragma once
#include <string>

#include "runners/kinds/sweep/orbit_exponents.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"

namespace ricochet {

/// Marched orbits as bytes and back, bit for bit, so that an interrupted sweep goes on as if it had not stopped. The
/// lane of an orbit is not kept: its task knows it. Bytes that to_bytes() did not write throw std::runtime_error.
std::string to_bytes(const MarchedOrbits& marched);
MarchedOrbits marched_orbits(const std::string& bytes);

/// The same for the exponents of a batch of orbits.
std::string to_bytes(const std::vector<OrbitExponents>& batch);
std::vector<OrbitExponents> orbit_exponents(const std::string& bytes);

/// Of what a point consists, for whoever stores points.
template <class Archive>
void serialize(Archive& archive, SectionPoint& point) {
  archive(point.displacement, point.velocity, point.opposite_displacement, point.opposite_velocity);
}

}  // namespace ricochet
