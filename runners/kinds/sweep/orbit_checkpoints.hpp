#pragma once
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <mutex>
#include <set>
#include <string>

#include "runners/kinds/sweep/orbit_exponents.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"
#include "runners/march/case_context.hpp"

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

// Of what orbits and exponents consist, for those who write them as bytes. Large ones name all members in their order,
// so that a new one is not forgotten: it does not compile.

template <class Archive>
void serialize(Archive& archive, LaneState& state) {
  archive(state.slots, state.efforts, state.fastest, state.memory);
}

template <class Archive>
void serialize(Archive& archive, LaneEnd& end) {
  archive(end.cause, end.value, end.bound, end.factor, end.count);
}

template <class Archive>
void serialize(Archive& archive, Settling& settling) {
  archive(settling.scale, settling.tolerance, settling.longest, settling.ring, settling.repeats, settling.periods);
}

template <class Archive>
void serialize(Archive& archive, SectionSeries& series) {
  archive(series.width, series.values);
}

template <class Archive>
void serialize(Archive& archive, ImpactPoint& impact) {
  archive(impact.phase, impact.side, impact.speed, impact.point, impact.time);
}

template <class Archive>
void serialize(Archive& archive, BriefContact& contact) {
  archive(contact.point, contact.steps, contact.before);
}

template <class Archive>
void serialize(Archive& archive, MotionClass& motion) {
  archive(motion.regime, motion.period);
}

template <class Archive>
void serialize(Archive& archive, RegimeVerdict& verdict) {
  archive(verdict.motion, verdict.period, verdict.evidence, verdict.open);
}

template <class Archive>
void serialize(Archive& archive, Orbit& orbit) {
  auto& [task, stage, transient_periods, kept_periods, settled, end, end_words, stopped_period, settling, readings,
         strobed, points, impacts, impact_counts, contact_steps, most_on_a_side, closed, pushed, arrived, rests,
         lasting, rebounds, rebounds_so_far, brief, verdict, lane, entry, now] = orbit;
  archive(task, stage, transient_periods, kept_periods, settled, end, end_words, stopped_period, settling, readings,
          strobed, points, impacts, impact_counts, contact_steps, most_on_a_side, closed, pushed, arrived, rests,
          lasting, rebounds, rebounds_so_far, brief, verdict, entry, now);
}

template <class Archive>
void serialize(Archive& archive, MarchedOrbits& marched) {
  archive(marched.finished, marched.running);
}

template <class Archive>
void serialize(Archive& archive, Interval& interval) {
  archive(interval.value, interval.low, interval.high);
}

template <class Archive>
void serialize(Archive& archive, OrbitExponents& exponents) {
  auto& [values, twin, method, blind, saturated, superstable, outlived, untold] = exponents;
  archive(values, twin, method, blind, saturated, superstable, outlived, untold);
}

/// What an interrupted set of orbits had marched, in a checkpoint store. Parts with finished orbits are written once;
/// orbits on their way are written anew each time. Without a store nothing is kept.
class OrbitCheckpoints {
 public:
  /// `key` tells this set of orbits from every other.
  OrbitCheckpoints(const CheckpointStore& checkpoints, std::string key)
      : checkpoints_(checkpoints), key_(std::move(key)) {}

  /// Everything that was saved; further parts follow it. Call it first.
  MarchedOrbits find();
  void save(const MarchedOrbits& marched);
  void forget();

 private:
  std::string part(int number) const;

  const CheckpointStore& checkpoints_;
  std::string key_;
  int parts_ = 0;
};

/// Batches of exponents that a killed run had measured, read when they are asked for and forgotten at the end.
class ExponentCheckpoints {
 public:
  ExponentCheckpoints(const CheckpointStore& checkpoints, std::string key)
      : checkpoints_(checkpoints), key_(std::move(key)) {}
  /// Lets the task keep its batches here, and find them.
  void serve(ExponentTask& task);
  void forget();

 private:
  std::string part(std::size_t batch) const;
  void note(std::size_t batch);

  const CheckpointStore& checkpoints_;
  std::string key_;
  std::mutex mutex_;
  std::set<std::size_t> kept_;
};

}  // namespace ricochet
