#pragma once
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>

#include "runners/kinds/sweep/orbit_bytes.hpp"

/// \file
/// Of what orbits and exponents consist, for those who write them as bytes.
namespace ricochet {

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
  archive(verdict.motion, verdict.period, verdict.evidence);
}

template <class Archive>
void serialize(Archive& archive, Orbit& orbit) {
  archive(orbit.task, orbit.stage, orbit.transient_periods, orbit.kept_periods, orbit.settled, orbit.end,
          orbit.end_words, orbit.stopped_period, orbit.settling, orbit.readings, orbit.strobed, orbit.points,
          orbit.impacts, orbit.impact_counts, orbit.contact_steps, orbit.most_on_a_side, orbit.closed, orbit.pushed,
          orbit.arrived, orbit.rests, orbit.rebounds, orbit.rebounds_so_far, orbit.brief, orbit.verdict, orbit.entry,
          orbit.now);
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
  archive(exponents.values, exponents.twin, exponents.method, exponents.blind, exponents.saturated,
          exponents.superstable, exponents.outlived, exponents.untold);
}

}  // namespace ricochet
