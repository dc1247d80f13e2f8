#include <cmath>
#include <ricochet/measure/contact/stop_places.hpp>
#include <ricochet/measure/contact/tangent_watch.hpp>

namespace ricochet {

TangentWatch::TangentWatch(const Marcher& marcher, const WindowParts& window)
    : window_(window), h_(marcher.program().h), rows_(marcher, marcher.program().problem->tangents) {
  asks_.next_shown = any() ? 0 : never;
  if (!any()) return;
  const SemiDiscrete& problem = *marcher.program().problem;
  const StopList stops = stop_list(problem);
  for (int stop = 0; stop < stops.count(); ++stop) {
    const int row = problem.tangent_of[static_cast<std::size_t>(stops.row[static_cast<std::size_t>(stop)])];
    tangents_of_.push_back(row < 0 ? -1 : static_cast<int>(tangents_.size()));
    if (row < 0) continue;
    if (!tangents_.empty()) tangents_.back().count = row - tangents_.back().first;
    tangents_.emplace_back().first = row;
    tangents_.back().round = problem.round(stops.row[static_cast<std::size_t>(stop)]);
    tangents_.back().count = rows_.count() - row;
  }
  for (const RunningSurface& one : problem.surfaces)
    for (Tangent& tangent : tangents_)
      if (tangent.first <= one.row && one.row < tangent.first + tangent.count) tangent.surfaces.push_back(one);
  work_.resize(tangents_.size() * static_cast<std::size_t>(window.count));
  // Of the initial state.
  const Eigen::VectorXd speeds = problem.tangents.rows * marcher.program().lanes.front().velocity;
  for (Tangent& one : tangents_) {
    one.waiting.reserve(4);
    for (int k = 0; k < one.count; ++k) {
      const Eigen::Index row = one.first + k;
      double& speed = one.speed[static_cast<std::size_t>(k)];
      speed = speeds[row];
      if (!problem.motions.empty()) speed += problem.motions.sum(problem.tangents.on_motions.row(row), 0, true);
    }
    for (const RunningSurface& surface : one.surfaces)
      one.moves(surface, one.speed, surface.speed + (surface.history ? surface.history->rate(0) : 0.0));
  }
}

// A plane surface that moves leaves so much less, the rim of a round one moves beside its rows.
void TangentWatch::Tangent::moves(const RunningSurface& surface, std::array<double, rows_and_rim>& of,
                                  double by) const {
  if (round)
    of[rim] += by;
  else
    of[static_cast<std::size_t>(surface.row - first)] -= by;
}

double TangentWatch::Tangent::along(const std::array<double, 2>& normal) const {
  if (!round) return count == 1 ? speed[0] : std::hypot(speed[0], speed[1]);
  const double circle = normal[0] * speed[1] - normal[1] * speed[0] + speed[rim];
  return count == 2 ? std::abs(circle) : std::hypot(circle, normal[0] * speed[2] + normal[1] * speed[3]);
}

void TangentWatch::stage_solved(const Marcher& marcher, const StageView& view) {
  if (any() && view.effort && view.program->opens_instant) know(marcher, view.slots[0], view.from);
}

void TangentWatch::know(const Marcher& marcher, const double* position, double t) {
  // Stages of a start rule may ask several times at the same time.
  const bool moves = known_ && t > time_ + 1e-9 * h_;
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    Tangent& one = tangents_[i];
    std::array<double, Tangent::rows_and_rim> place{};
    for (int k = 0; k < one.count; ++k)
      place[static_cast<std::size_t>(k)] =
          rows_.relative(one.first + k, position) + rows_.lift(marcher, one.first + k, t);
    for (const RunningSurface& surface : one.surfaces)
      one.moves(surface, place, surface.speed * t + (surface.history ? surface.history->value(t) : 0.0));
    for (std::size_t k = 0; moves && k < place.size(); ++k) one.speed[k] = (place[k] - one.place[k]) / (t - time_);
    one.place = place;
    if (!moves) continue;
    if (!one.waiting.empty())
      if (const int part = window_.of(one.time, 1e-6 * h_); part >= 0) {
        double slid = one.slid;
        for (const Waiting& push : one.waiting) slid += push.given * std::abs(one.along(push.normal));
        work_[i * static_cast<std::size_t>(window_.count) + static_cast<std::size_t>(part)] += 0.5 * slid;
      }
    one.waiting.clear();
    one.slid = 0;
  }
  known_ = true;
  time_ = t;
}

void TangentWatch::instant(const ContactInstant& one) {
  const int tangent = tangent_of(one.point);
  if (tangent < 0) return;
  Tangent& state = tangents_[static_cast<std::size_t>(tangent)];
  const double speed = state.along(one.normal);
  if (one.given > 0) {
    if (!state.waiting.empty() && state.waiting.back().normal == one.normal)
      state.waiting.back().given += one.given;
    else
      state.waiting.push_back({one.given, one.normal});
  }
  state.slid += one.given * std::abs(speed);
  state.time = one.time;
  if (!one.closes || one.impact == std::numeric_limits<std::size_t>::max()) return;
  at_impacts_.resize(one.impact + 1, std::numeric_limits<double>::quiet_NaN());
  at_impacts_[one.impact] = speed;
}

void TangentWatch::finish(const Marcher& marcher) {
  if (any()) know(marcher, marcher.slots()[0], marcher.time());
}

double TangentWatch::work(int point, int part) const {
  return work_[static_cast<std::size_t>(tangent_of(point)) * static_cast<std::size_t>(window_.count) +
               static_cast<std::size_t>(part)];
}

double TangentWatch::power(int point) const {
  double sum = 0;
  for (int part = 0; part < window_.count; ++part) sum += work(point, part);
  return sum / (window_.to - window_.from);
}

double TangentWatch::speed_at(std::size_t impact) const {
  return impact < at_impacts_.size() ? at_impacts_[impact] : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace ricochet
