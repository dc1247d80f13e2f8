#include "runners/kinds/basins/cell_ends.hpp"

#include <tuple>

#include "runners/kinds/sweep/orbit_archive.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

constexpr const char* ends_mark = "ends of cells 4";

}  // namespace

template <class Archive>
void serialize(Archive& archive, CellEnd& end) {
  archive(end.motion, end.period, end.periods, end.status, end.reason, end.lost, end.section, end.displacements);
}

CellEnd cell_end(const Orbit& orbit) {
  CellEnd end;
  std::tie(end.status, end.reason) = status_of(orbit);
  end.lost = orbit.end.cause == EndCause::process_ended;
  end.periods = orbit.transient_periods + orbit.kept_periods;
  if (orbit.stage != Orbit::Stage::complete) return end;
  end.motion = orbit.verdict.value().motion;
  end.period = orbit.verdict->period;
  end.section = orbit.strobed;
  end.displacements = orbit.readings.values;
  return end;
}

CellEnd refused_end(const std::string& sentence) {
  CellEnd end;
  end.status = "refused";
  end.reason = sentence;
  return end;
}

CellEnd no_start_end(const std::string& sentence) {
  CellEnd end;
  end.status = no_start;
  end.reason = sentence;
  return end;
}

std::string to_bytes(const std::vector<CellEnd>& ends) {
  return to_bytes(ends, ends_mark);
}

std::vector<CellEnd> cell_ends(const std::string& bytes) {
  return from_bytes<std::vector<CellEnd>>(bytes, ends_mark);
}

SettledSection settled_section(const CellEnd& end, const SectionPlan& plan) {
  // A motion without contact is the linear response, told by its class.
  if (end.motion.regime == Regime::no_contact) return {end.motion, true, {}};
  std::vector<CloudPoint> run, opposite;
  for (std::size_t i = 0; i < end.section.size(); ++i) {
    run.push_back({end.displacements[i], end.section[i].velocity});
    opposite.push_back({end.section[i].opposite_displacement, end.section[i].opposite_velocity});
  }
  const int cycle = cycle_of(end.motion, end.period);
  return {end.motion, cycle > 0, make_cloud(run, opposite, {plan.scale, plan.scale * plan.pulsation}, cycle)};
}

}  // namespace ricochet
