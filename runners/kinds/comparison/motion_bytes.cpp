#include "runners/kinds/comparison/motion_bytes.hpp"

#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

constexpr const char* motion_mark = "motion 2";

}  // namespace

template <class Archive>
void serialize(Archive& archive, ContactEvent& event) {
  archive(event.time, event.side, event.begins, event.velocity);
}

template <class Archive>
void serialize(Archive& archive, SampledMotion& motion) {
  archive(motion.tip, motion.tip_velocity, motion.energy, motion.impulse, motion.displacement, motion.strain,
          motion.velocity, motion.events);
}

template <class Archive>
void serialize(Archive& archive, ReferenceMotion& reference) {
  archive(reference.motion, reference.coarser, reference.how, reference.notes);
}

std::string to_bytes(const ReferenceMotion& motion) {
  return to_bytes(motion, motion_mark);
}

ReferenceMotion motion_from_bytes(const std::string& bytes) {
  return from_bytes<ReferenceMotion>(bytes, motion_mark);
}

}  // namespace ricochet
