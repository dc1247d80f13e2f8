#include "runners/kinds/continuation/stored_orbit.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "runners/kinds/kind.hpp"
#include "runners/kinds/stored_study.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/store.hpp"

namespace ricochet {

LaneState stored_orbit(const WantedOrbit& orbit, Program program, int steps_per_period) {
  StudyResults results;
  try {
    results = read_store(orbit.study);
  } catch (const StoreError& error) {
    throw PointRefused(error.what());
  }
  if (results.kind != "bifurcation")
    throw PointRefused(fmt::format("{} holds a study of kind {}; expected bifurcation", orbit.study, results.kind));
  const CaseRecord& record = find_case(results, orbit.case_id);
  const auto entry = find_entry(record, orbit.parameter.value_or(orbit.at), orbit.start);
  if (!entry)
    throw PointRefused(fmt::format("the case {} of {} keeps no orbit from \"{}\" at {:g}", record.id, orbit.study,
                                   orbit.start, orbit.parameter.value_or(orbit.at)));
  const auto steps = axis(record, "steps_per_period").number();
  Marcher marcher(std::move(program));
  const LaneState like = marcher.lane_state(0);
  if (!steps || *steps != steps_per_period || record.operator_name != operator_name(marcher.program().kind) ||
      entry->slots.size() != like.slots.size() || entry->efforts.size() != like.efforts.size())
    throw PointRefused(
        fmt::format("the orbit of case {} has another step, mesh or operator; expected {} steps per "
                    "period and the operator {}",
                    record.id, steps_per_period, operator_name(marcher.program().kind)));
  const double turns = results.study.value("phase", 0.0) / (2 * std::numbers::pi);
  const auto strobe = std::llround((turns - std::floor(turns)) * steps_per_period) % steps_per_period;
  marcher.set_clock(strobe + 1);
  marcher.set_lane(0, LaneSpec(marcher.program().lanes[0]), *entry);
  marcher.march(steps_per_period - strobe - 1);
  return marcher.lane_state(0);
}

}  // namespace ricochet
