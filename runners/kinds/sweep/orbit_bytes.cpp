#include "runners/kinds/sweep/orbit_bytes.hpp"

#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

// One description of an orbit serves both ways.
template <class Archive, class State>
void describe_state(Archive& archive, State& state) {
  archive(state.slots);
  archive(state.efforts);
  archive(state.fastest);
  archive(state.memory);
}

template <class Archive, class End>
void describe_end(Archive& archive, End& end) {
  archive(end.cause);
  archive(end.value);
  archive(end.bound);
  archive(end.factor);
  archive(end.count);
}

template <class Archive, class One>
void describe_orbit(Archive& archive, One& orbit) {
  archive(orbit.task);
  archive(orbit.stage);
  archive(orbit.transient_periods);
  archive(orbit.kept_periods);
  archive(orbit.settled);
  describe_end(archive, orbit.end);
  archive(orbit.stopped_period);
  archive(orbit.settling.scale);
  archive(orbit.settling.tolerance);
  archive(orbit.settling.longest);
  archive(orbit.settling.ring);
  archive(orbit.settling.repeats);
  archive(orbit.settling.periods);
  archive(orbit.readings.width);
  archive(orbit.readings.values);
  archive(orbit.strobed);
  archive(orbit.points);
  archive(orbit.impacts);
  archive(orbit.impact_counts);
  archive(orbit.contact_steps);
  archive(orbit.most_on_a_side);
  archive(orbit.closed[0]);
  archive(orbit.closed[1]);
  describe_state(archive, orbit.entry);
  describe_state(archive, orbit.now);
}

constexpr std::uint64_t mark = 0x3174696272'0002;  // what the bytes are, and their version

}  // namespace

std::string to_bytes(const MarchedOrbits& marched) {
  ByteWriter writer;
  writer(mark);
  for (const auto* orbits : {&marched.finished, &marched.running}) {
    writer(static_cast<std::uint64_t>(orbits->size()));
    for (const Orbit& orbit : *orbits) describe_orbit(writer, orbit);
  }
  return std::move(writer.bytes);
}

MarchedOrbits marched_orbits(const std::string& bytes) {
  ByteReader reader(bytes);
  std::uint64_t found = 0;
  reader(found);
  if (found != mark) throw std::runtime_error("stored orbits are of another version");
  MarchedOrbits marched;
  for (auto* orbits : {&marched.finished, &marched.running}) {
    std::uint64_t count = 0;
    reader(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      orbits->emplace_back();
      describe_orbit(reader, orbits->back());
    }
  }
  return marched;
}

}  // namespace ricochet
