#include "runners/kinds/basins/cell_scenes.hpp"

#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <tuple>

#include "runners/kinds/sweep/orbit_checkpoints.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"
#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

constexpr const char* displacement_pointer = "/scene/initial/displacement";
constexpr const char* velocity_pointer = "/scene/initial/velocity";

}  // namespace

CellScenes::CellScenes(const StudyCase& study_case, const Registry& registry)
    : case_(study_case), registry_(registry), axes_(grid_axes(study_case.settings)) {
  const std::string &x = axes_[0].pointer, &y = axes_[1].pointer;
  turned_ = x == velocity_pointer;
  shared_ = ((x == displacement_pointer && y == velocity_pointer) || (turned_ && y == displacement_pointer)) &&
            study_case.scene.initial.projection == InitialSpec::Projection::none;
  scenes_ = std::make_unique<ForcedScenes>(case_, registry_);
}

void CellScenes::begin() {
  if (!shared_) scenes_ = std::make_unique<ForcedScenes>(case_, registry_);
}

int CellScenes::displaced(double value) {
  const auto [known, added] = displacements_.try_emplace(value, 0);
  if (added) known->second = scenes_->add(displacement_pointer, value, true);
  return known->second;
}

int CellScenes::moving(double value) {
  const auto [known, added] = velocities_.try_emplace(value, 0);
  if (!added) return known->second;
  // Where the beam stands must be possible, and matters no further.
  double place = 0;
  for (const double candidate : axes_[turned_ ? 1 : 0].values)
    if ((*scenes_)[displaced(place = candidate)].refusal.empty()) break;
  return known->second = scenes_->add({{{displacement_pointer, place}, {velocity_pointer, value}}});
}

CellScenes::Prepared CellScenes::prepare(std::size_t column, std::size_t row) {
  Prepared out;
  const double x = axes_[0].values[column], y = axes_[1].values[row];
  const auto refused = [&](int scene) {
    out.refusal = (*scenes_)[scene].refusal.text;
    out.no_start = (*scenes_)[scene].no_start;
    return !out.refusal.empty();
  };
  if (!shared_) {
    out.task.scene = scenes_->add({{{axes_[0].pointer, x}, {axes_[1].pointer, y}}});
    refused(out.task.scene);
    out.task.lane = (*scenes_)[out.task.scene].lane;
    return out;
  }
  out.task.scene = displaced(turned_ ? y : x);
  if (refused(out.task.scene)) return out;
  const int velocity = moving(turned_ ? x : y);
  refused(velocity);
  out.task.lane = (*scenes_)[out.task.scene].lane;
  out.task.lane.velocity = (*scenes_)[velocity].lane.velocity;
  return out;
}

namespace {

constexpr const char* ends_mark = "ends of cells 6";

}  // namespace

template <class Archive>
void serialize(Archive& archive, CellEnd& end) {
  auto& [motion, period, open, periods, status, reason, without, lost, section, displacements] = end;
  archive(motion, period, open, periods, status, reason, without, lost, section, displacements);
}

CellEnd cell_end(const Orbit& orbit) {
  CellEnd end;
  std::tie(end.status, end.reason) = status_of(orbit);
  end.lost = orbit.end.cause == EndCause::process_ended;
  end.periods = orbit.transient_periods + orbit.kept_periods;
  if (orbit.stage != Orbit::Stage::complete) return end;
  end.motion = orbit.verdict.value().motion;
  end.period = orbit.verdict->period;
  end.open = orbit.verdict->open;
  end.section = orbit.strobed;
  end.displacements = orbit.readings.values;
  return end;
}

CellEnd refused_end(const std::string& sentence) {
  CellEnd end;
  end.status = Status::refused;
  end.reason = sentence;
  return end;
}

CellEnd no_start_end(const std::string& sentence) {
  CellEnd end = refused_end(sentence);
  end.no_start = true;
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
  if (end.motion.regime == Regime::no_contact) return {end.motion, {}};
  std::vector<CloudPoint> run, opposite;
  for (std::size_t i = 0; i < end.section.size(); ++i) {
    run.push_back({end.displacements[i], end.section[i].velocity});
    opposite.push_back({end.section[i].opposite_displacement, end.section[i].opposite_velocity});
  }
  const int cycle = cycle_of(end.motion, end.period);
  return {end.motion,
          make_cloud(run, opposite, {plan.scale, plan.scale * plan.pulsation}, cycle, end.open * plan.scale)};
}

CellEnd march_cell(const StudyCase& study_case, const Registry& registry, CellPlace cell, SampleCount count,
                   const std::function<void(const PointSample&)>& use) {
  CellScenes made(study_case, registry);
  made.begin();
  CellScenes::Prepared prepared = made.prepare(cell.column, cell.row);
  if (!prepared.refusal.empty()) return refused_end(prepared.refusal);
  const ForcedScenes& scenes = made.scenes();
  ScheduleOptions options;
  options.section = section_plan(study_case, scenes);
  OrbitScheduler scheduler(scenes, options);
  const int number = scheduler.add(std::move(prepared.task));
  const std::atomic<bool> stop = false;
  scheduler.run(stop, [](const MarchedOrbits&) {});
  const Orbit& orbit = scheduler.orbit(number);
  Orbit ended = orbit;
  keep_end(ended, options.section);
  const CellEnd end = cell_end(ended);
  if (end.status == Status::done) march_on(scenes, scheduler.task(number).scene, orbit, options.section, count, use);
  return end;
}

}  // namespace ricochet
