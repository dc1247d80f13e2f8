#include "runners/kinds/basins/cell_ends.hpp"

#include <algorithm>
#include <tuple>

#include "runners/kinds/sweep/orbit_bytes.hpp"
#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

constexpr const char* ends_mark = "ends of cells 4";

}  // namespace

template <class Archive>
void serialize(Archive& archive, MotionClass& motion) {
  archive(motion.regime, motion.period);
}

template <class Archive>
void serialize(Archive& archive, CellEnd& end) {
  archive(end.motion, end.period, end.periods, end.status, end.reason, end.lost, end.section, end.displacements);
}

CellEnd cell_end(const Orbit& orbit, const SectionPlan& plan) {
  OrbitView view;
  view.orbit = &orbit;
  judge(view, plan);
  const RegimeVerdict& verdict = view.judged.verdict;
  CellEnd end;
  std::tie(end.status, end.reason) = status_of(view);
  end.lost = orbit.end.cause == EndCause::process_ended;
  end.periods = orbit.transient_periods + orbit.kept_periods;
  if (orbit.stage != Orbit::Stage::complete) return end;
  end.motion = verdict.motion;
  end.period = verdict.period;
  const std::size_t wanted = static_cast<std::size_t>(end.period > 0 ? end.period : longest_cell_section);
  const std::size_t first = orbit.strobed.size() - std::min(orbit.strobed.size(), wanted);
  const auto width = static_cast<std::size_t>(orbit.readings.width);
  for (std::size_t i = first; i < orbit.strobed.size(); ++i) {
    end.section.push_back(orbit.strobed[i]);
    end.displacements.push_back(orbit.readings.values[i * width]);
  }
  return end;
}

CellEnd refused_end(const std::string& sentence) {
  CellEnd end;
  end.status = "refused";
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
  const int cycle = end.motion.period;
  return {end.motion, cycle > 0, make_cloud(run, opposite, {plan.scale, plan.scale * plan.pulsation}, cycle)};
}

}  // namespace ricochet
