#include "runners/kinds/sweep/orbit_bytes.hpp"

#include "runners/kinds/sweep/orbit_archive.hpp"
#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

constexpr const char* orbits_mark = "orbits 8";
constexpr const char* exponents_mark = "exponents 4";

}  // namespace

std::string to_bytes(const MarchedOrbits& marched) {
  return to_bytes(marched, orbits_mark);
}

MarchedOrbits marched_orbits(const std::string& bytes) {
  return from_bytes<MarchedOrbits>(bytes, orbits_mark);
}

std::string to_bytes(const std::vector<OrbitExponents>& batch) {
  return to_bytes(batch, exponents_mark);
}

std::vector<OrbitExponents> orbit_exponents(const std::string& bytes) {
  return from_bytes<std::vector<OrbitExponents>>(bytes, exponents_mark);
}

}  // namespace ricochet
