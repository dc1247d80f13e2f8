#include <ricochet/measure/contact/tangent_watch.hpp>

namespace ricochet {

TangentWatch::TangentWatch(const Marcher& marcher, const WindowParts& window)
    : window_(window),
      h_(marcher.program().h),
      rows_(marcher, marcher.program().problem->tangents),
      tangents_of_(marcher.program().problem->tangent_of),
      tangents_(static_cast<std::size_t>(rows_.count())),
      work_(tangents_.size() * static_cast<std::size_t>(window.count)) {
  asks_.next_shown = any() ? 0 : never;
  if (!any()) return;
  // Of the initial state.
  const SemiDiscrete& problem = *marcher.program().problem;
  const Eigen::VectorXd speeds = problem.tangents.rows * marcher.program().lanes.front().velocity;
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    tangents_[i].speed = speeds[row];
    if (!problem.motions.empty())
      tangents_[i].speed += problem.motions.sum(problem.tangents.on_motions.row(row), 0, true);
  }
}

void TangentWatch::stage_solved(const Marcher& marcher, const StageView& view) {
  if (any() && view.effort && view.program->opens_instant) know(marcher, view.slots[0], view.from);
}

void TangentWatch::know(const Marcher& marcher, const double* position, double t) {
  // Stages of a start rule may ask several times at the same time.
  const bool moves = known_ && t > time_ + 1e-9 * h_;
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    Tangent& one = tangents_[i];
    const int row = static_cast<int>(i);
    const double place = rows_.relative(row, position) + rows_.lift(marcher, row, t);
    if (moves) {
      one.speed = (place - one.place) / (t - time_);
      if (one.given > 0)
        if (const int part = window_.of(one.time, 1e-6 * h_); part >= 0)
          work_[i * static_cast<std::size_t>(window_.count) + static_cast<std::size_t>(part)] +=
              0.5 * (one.slid + one.given * std::abs(one.speed));
      one.given = one.slid = 0;
    }
    one.place = place;
  }
  known_ = true;
  time_ = t;
}

void TangentWatch::instant(const ContactInstant& one) {
  const int tangent = tangent_of(one.point);
  if (tangent < 0) return;
  Tangent& state = tangents_[static_cast<std::size_t>(tangent)];
  state.given += one.given;
  state.slid += one.given * std::abs(state.speed);
  state.time = one.time;
  if (!one.closes || one.impact == std::numeric_limits<std::size_t>::max()) return;
  at_impacts_.resize(one.impact + 1, std::numeric_limits<double>::quiet_NaN());
  at_impacts_[one.impact] = state.speed;
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
