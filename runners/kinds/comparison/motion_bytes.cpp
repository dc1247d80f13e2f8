#include "runners/kinds/comparison/motion_bytes.hpp"

#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

// The vectors of a motion, in the order in which they are stored.
template <class Motion, class Act>
void each_series(Motion& motion, Act act) {
  for (auto* series : {&motion.tip, &motion.tip_velocity, &motion.energy, &motion.impulse, &motion.displacement,
                       &motion.strain, &motion.velocity})
    act(*series);
}

void write(ByteWriter& writer, const SampledMotion& motion) {
  each_series(motion, [&](const std::vector<double>& series) { writer(series); });
  writer(static_cast<std::uint64_t>(motion.events.size()));
  for (const ContactEvent& event : motion.events)
    for (const double value : {event.time, static_cast<double>(event.side), event.begins ? 1.0 : 0.0, event.velocity})
      writer(value);
}

SampledMotion read(ByteReader& reader) {
  SampledMotion motion;
  each_series(motion, [&](std::vector<double>& series) { reader(series); });
  motion.events.resize(reader.count(4 * sizeof(double)));
  for (ContactEvent& event : motion.events) {
    double side = 0, begins = 0;
    for (double* value : {&event.time, &side, &begins, &event.velocity}) reader(*value);
    event.side = side < 0 ? -1 : 1;
    event.begins = begins != 0;
  }
  return motion;
}

}  // namespace

std::string to_bytes(const ReferenceMotion& motion) {
  ByteWriter writer;
  write(writer, motion.motion);
  write(writer, motion.coarser);
  writer(motion.how);
  writer(static_cast<std::uint64_t>(motion.notes.size()));
  for (const std::string& note : motion.notes) writer(note);
  return writer.bytes;
}

ReferenceMotion motion_from_bytes(const std::string& bytes) {
  ByteReader reader(bytes);
  ReferenceMotion motion;
  motion.motion = read(reader);
  motion.coarser = read(reader);
  reader(motion.how);
  motion.notes.resize(reader.count(sizeof(double)));
  for (std::string& note : motion.notes) reader(note);
  return motion;
}

}  // namespace ricochet
