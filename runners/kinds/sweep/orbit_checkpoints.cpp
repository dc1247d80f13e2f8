#include "runners/kinds/sweep/orbit_checkpoints.hpp"

#include <fmt/format.h>

#include <iterator>

#include "runners/kinds/sweep/orbit_bytes.hpp"

namespace ricochet {

std::string OrbitCheckpoints::part(int number) const {
  return fmt::format("orbits/{}/{}", key_, number < 0 ? "now" : std::to_string(number));
}

MarchedOrbits OrbitCheckpoints::find() {
  MarchedOrbits all;
  if (!shelf_.find) return all;
  for (std::string bytes = shelf_.find(part(parts_)); !bytes.empty(); bytes = shelf_.find(part(parts_))) {
    MarchedOrbits some = marched_orbits(bytes);
    std::move(some.finished.begin(), some.finished.end(), std::back_inserter(all.finished));
    ++parts_;
  }
  if (const std::string bytes = shelf_.find(part(-1)); !bytes.empty()) all.running = marched_orbits(bytes).running;
  return all;
}

void OrbitCheckpoints::save(const MarchedOrbits& marched) {
  if (!shelf_.keep) return;
  if (!marched.finished.empty()) shelf_.keep(part(parts_++), to_bytes({marched.finished, {}}));
  shelf_.keep(part(-1), to_bytes({{}, marched.running}));
}

void OrbitCheckpoints::forget() {
  if (!shelf_.keep) return;
  for (int i = 0; i < parts_; ++i) shelf_.keep(part(i), "");
  shelf_.keep(part(-1), "");
}

}  // namespace ricochet
