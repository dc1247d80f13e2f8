#include "runners/kinds/basins/cell_scenes.hpp"

#include <algorithm>

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
    out.refusal = (*scenes_)[scene].refusal;
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

}  // namespace ricochet
