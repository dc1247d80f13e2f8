#include <algorithm>
#include <bit>
#include <cmath>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <utility>

namespace ricochet {
namespace {

constexpr int settles_after = 2;  // sub-steps without an effort until a speed out is read

// Mean of |v| where v goes evenly from a to b.
double mean_speed(double a, double b) {
  const double sum = std::abs(a) + std::abs(b);
  return a * b >= 0 ? 0.5 * sum : 0.5 * (a * a + b * b) / sum;
}

}  // namespace

ImpactRecorder::ImpactRecorder(const Marcher& marcher, std::size_t most)
    : model_(*marcher.program().model), most_(most), h_(marcher.program().h), T_(marcher.width()) {
  const int points = model_.problem().points();
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    Lane& state = lanes_.emplace_back(points, StartContact(marcher, lane));
    state.leaving.reserve(static_cast<std::size_t>(points));
    state.stops.resize(2 * static_cast<std::size_t>(points));
    state.impacts.reserve(std::min<std::size_t>(most, 64));
  }
  // Of steps that are left out an increment is known where their slots are.
  tells_slots_ = marcher.program().flight && marcher.program().flight->tells_slots();
  if (!marcher.program().flight || tells_slots_) increment_slot_ = marcher.program().increment_slot;
  asks_.next_shown = next_shown(marcher);
  if (!marcher.program().contact || increment_slot_ >= 0) return;
  earlier_.resize(static_cast<std::size_t>(model_.rows()) * static_cast<std::size_t>(T_));
  latest_.resize(earlier_.size());
}

void ImpactRecorder::stage_solved(const Marcher& marcher, const StageView& view) {
  if (!view.effort) return;
  const StageProgram& program = *view.program;
  if (program.opens_instant) open_instant(marcher, view);
  let_go(marcher, view);
  lasts_ = program.lasts;
  for (std::uint32_t mask = view.contact_lanes; mask != 0; mask &= mask - 1) {
    const int lane = std::countr_zero(mask);
    if (!marcher.status(lane).running) continue;
    Lane& state = lanes_[static_cast<std::size_t>(lane)];
    const double* efforts = view.effort[0] + lane;
    marcher.each_push(view, lane, [&](int j, double p) {
      state.closed.press(j, p);
      Point& one = state.points[static_cast<std::size_t>(j)];
      one.given += program.momentum * std::abs(p);
      if (model_.problem().circle_axis(j) < 0) return;
      // A projection gives nothing, and has a direction too.
      const double weight = program.momentum != 0 ? program.momentum : std::numeric_limits<double>::min();
      for (const int axis : {0, 1})
        one.vector[static_cast<std::size_t>(axis)] -= weight * efforts[static_cast<std::ptrdiff_t>(j + axis) * T_];
    });
    busy_ |= 1U << lane;
  }
  if (!program.closes_instant) return;
  for (std::uint32_t mask = busy_; mask != 0; mask &= mask - 1)
    if (const int lane = std::countr_zero(mask); marcher.status(lane).running) close_instant(marcher, view, lane);
}

void ImpactRecorder::step_done(Marcher& marcher) {
  asks_.next_shown = next_shown(marcher);
}

// Without contact it waits for nothing. Where a slot holds what positions moved by, it is there when a point closes. Of
// a flight the velocities over two sub-steps have to be known of what opened, and those over the last of what closes
// next.
long long ImpactRecorder::next_shown(const Marcher& marcher) const {
  if (!marcher.program().contact) return never;
  const bool waits =
      marcher.program().flight ? !tells_slots_ && !lanes_.front().leaving.empty() : busy_ != 0 || increment_slot_ < 0;
  return known_ < 2 || waits ? 0 : never;
}

void ImpactRecorder::interval(Marcher& marcher, const StepInterval& steps) {
  if (!marcher.program().contact) return;
  if (!steps.flight) {
    latest_time_ = static_cast<double>(marcher.step() - 1) * h_ + marcher.program().stages.front().facts.from * h_;
    return;
  }
  if (tells_slots_) know_left_out(marcher, steps);
  if (!steps.closed.empty()) press_left_out(marcher, steps);
  asks_.next_shown = next_shown(marcher);
}

void ImpactRecorder::press_left_out(const Marcher& marcher, const StepInterval& steps) {
  Lane& lane = lanes_.front();
  const std::vector<StageProgram>& stages = marcher.program().stages;
  double begins = steps.from, lasts = 0;
  if (!tells_slots_) {
    for (const ClosedPoint& closed : steps.closed)
      lane.points[static_cast<std::size_t>(closed.point)].place =
          model_.contact().times(closed.point, latest_.data()) + marcher.lift(0, closed.point, latest_time_);
    left_at_ = latest_time_;
  }
  if (listeners_.empty() && press_sums(stages.front(), steps)) return;
  steps.each_stage([&](int at, std::span<const double> efforts, std::span<const double> places) {
    const StageProgram& stage = stages[static_cast<std::size_t>(at)];
    if (!efforts.empty() && stage.opens_instant) {
      const double time = begins + stage.facts.from * h_;
      lasts = 0;
      // Without places they rest.
      for (std::size_t i = 0; i < steps.closed.size(); ++i)
        if (places.empty())
          move(lane, steps.closed[i].point, 0);
        else
          move_to_place(lane, steps.closed[i].point, places[i], time);
      left_at_ = time;
    }
    if (!efforts.empty()) lasts = std::max(lasts, stage.lasts);
    for (std::size_t i = 0; i < efforts.size(); ++i)
      lane.points[static_cast<std::size_t>(steps.closed[i].point)].given += stage.momentum * std::abs(efforts[i]);
    if (stage.closes_instant) {
      lane.force = 0;
      const double time = begins + stage.facts.instant * h_;
      for (const ClosedPoint& closed : steps.closed) press(lane, closed.point, lasts, time, false);
      for (ContactListener* listener : listeners_) listener->over(time);
    }
    if (at + 1 == static_cast<int>(stages.size())) begins += h_;
  });
  left_ = !tells_slots_;
}

// All instants of closed points that rest, at once; false where only each of them is told.
bool ImpactRecorder::press_sums(const StageProgram& stage, const StepInterval& steps) {
  if (!stage.opens_instant || !stage.closes_instant || !(stage.momentum > 0)) return false;
  const auto pushed = steps.pushed();
  if (pushed.empty()) return false;
  Lane& lane = lanes_.front();
  const double lasts = stage.momentum;
  lane.force = 0;
  for (std::size_t i = 0; i < pushed.size(); ++i) {
    const int point = steps.closed[i].point;
    move(lane, point, 0);
    Point& one = lane.points[static_cast<std::size_t>(point)];
    StopTotals all;
    all.impulse = lasts * pushed[i].sum;
    all.contact_time = lasts * static_cast<double>(steps.steps);
    all.squares = lasts * pushed[i].squares;
    all.peak_force = pushed[i].most;
    add(lane, one, all, pushed[i].last, stop(lane, point, one.side));
    one.pushed = lasts * pushed[i].last;
  }
  left_at_ = steps.from + static_cast<double>(steps.steps - 1) * h_ + stage.facts.from * h_;
  left_ = !tells_slots_;
  return true;
}

// The first of them, of what opened before them, and the last one, for what closes in the step after them.
void ImpactRecorder::know_left_out(const Marcher& marcher, const StepInterval& steps) {
  const double offset = marcher.program().stages.front().facts.from * h_;
  const long long first = marcher.step() - steps.steps;
  const auto time = [&](long long step) { return static_cast<double>(first + step) * h_ + offset; };
  for (long long step = 0; step < steps.steps && !lanes_.front().leaving.empty(); ++step)
    if (know(steps.flight->slots_before(step), time(step))) leave(marcher, 0, lift(marcher, 0));
  // Where a slot holds the increment, the step that comes brings it along.
  const long long last = steps.steps - 1;
  if (increment_slot_ >= 0)
    latest_time_ = time(last);
  else
    know(steps.flight->slots_before(last), time(last));
}

// A closed point over a sub-step at whose end it moves at `now`.
void ImpactRecorder::move(Lane& lane, int point, double now, double across) {
  Point& one = lane.points[static_cast<std::size_t>(point)];
  const auto along = [&](double first, double second) {
    return one.normal[0] == 0 && one.normal[1] == 0 ? first : one.normal[0] * first + one.normal[1] * second;
  };
  stop(lane, point, one.side).normal_work +=
      one.pushed * mean_speed(along(one.velocity, one.across), along(now, across));
  one.velocity = now;
  one.across = across;
}

// The same of one that stands at `place` at a time.
void ImpactRecorder::move_to_place(Lane& lane, int point, double place, double time) {
  Point& one = lane.points[static_cast<std::size_t>(point)];
  move(lane, point, (place - one.place) / (time - left_at_));
  one.place = place;
}

// What instants of a closed point gave; `force`: of the last of them.
void ImpactRecorder::add(Lane& lane, const Point& one, const StopTotals& given, double force, StopTotals& totals) {
  lane.force += force;
  lane.peak = std::max(lane.peak, given.peak_force);
  totals.impulse += given.impulse;
  totals.contact_time += given.contact_time;
  totals.squares += given.squares;
  totals.peak_force = std::max(totals.peak_force, given.peak_force);
  if (one.row >= lane.impacts.size()) return;
  Impact& impact = lane.impacts[one.row];
  impact.impulse += given.impulse;
  impact.duration += given.contact_time;
  impact.peak_force = std::max(impact.peak_force, given.peak_force);
  impact.release_force = force;
}

// One more instant of a closed point.
void ImpactRecorder::press(Lane& lane, int point, double lasts, double time, bool closes) {
  Point& one = lane.points[static_cast<std::size_t>(point)];
  const double force = lasts > 0 ? one.given / lasts : 0.0;
  StopTotals all;
  all.impulse = one.given;
  all.contact_time = lasts;
  all.squares = one.given * force;
  all.peak_force = force;
  add(lane, one, all, force, stop(lane, point, one.side));
  if (&lane == &lanes_.front())
    for (ContactListener* listener : listeners_)
      listener->instant({point, one.side > 0 ? StopSide::lower : StopSide::upper, time, lasts, one.given, force, closes,
                         one.came, one.row, one.normal});
  one.pushed = one.given;
  one.given = 0;
}

// What the last sub-step was, for the points that wait for it.
void ImpactRecorder::open_instant(const Marcher& marcher, const StageView& view) {
  lasts_ = 0;
  move_to(marcher, view.slots, view.from);
}

void ImpactRecorder::move_to(const Marcher& marcher, const double* const* slots, double time) {
  if (!know(slots, time)) return;
  for (std::uint32_t mask = busy_; mask != 0; mask &= mask - 1)
    if (const int lane = std::countr_zero(mask); marcher.status(lane).running) moved(marcher, lane);
  left_ = false;
}

// Keeps the positions at a time, and those before them; where a slot holds what they differ by, that is enough. Stages
// of a start rule may ask several times at the same: nothing moves then.
bool ImpactRecorder::know(const double* const* slots, double time) {
  const bool moves = known_ > 0 && time > latest_time_ + 1e-9 * h_;
  if (moves) {
    earlier_.swap(latest_);
    earlier_time_ = latest_time_;
  }
  if (increment_slot_ >= 0)
    increment_ = slots[increment_slot_];
  else
    std::copy_n(slots[0], latest_.size(), latest_.data());
  latest_time_ = time;
  known_ = moves ? 2 : std::max(known_, 1);
  return moves;
}

// Absolute velocity of a point over the last sub-step; of the initial state where there was none.
double ImpactRecorder::velocity(const Marcher& marcher, int lane, int point, double support) const {
  if (known_ < 2) {
    const LaneSpec& spec = marcher.program().lanes[static_cast<std::size_t>(lane)];
    double speed = marcher.lift_rate(lane, point, 0);
    for (SparseRows::InnerIterator entry(model_.problem().contact, point); entry; ++entry)
      speed += entry.value() * spec.velocity[entry.col()];
    return speed;
  }
  const RowMatrix& rows = model_.contact();
  const double lift =
      support + marcher.motions().point(point, latest_time_) - marcher.motions().point(point, earlier_time_);
  if (increment_ && T_ == 1) return (model_.times(rows, point, increment_) + lift) / (latest_time_ - earlier_time_);
  double way = 0;
  for (int e = rows.start[static_cast<std::size_t>(point)]; e < rows.start[static_cast<std::size_t>(point) + 1]; ++e) {
    const auto at = static_cast<std::size_t>(rows.index[static_cast<std::size_t>(e)]) * static_cast<std::size_t>(T_) +
                    static_cast<std::size_t>(lane);
    way += rows.value[static_cast<std::size_t>(e)] * (increment_ ? increment_[at] : latest_[at] - earlier_[at]);
  }
  return (way + lift) / (latest_time_ - earlier_time_);
}

double ImpactRecorder::velocity_of(const Marcher& marcher, int lane, int point, double support) const {
  const double first = velocity(marcher, lane, point, support);
  if (model_.problem().circle_axis(point) < 0) return first;
  const std::array<double, 2>& normal = lane_of(lane).points[static_cast<std::size_t>(point)].normal;
  return normal[0] * first + normal[1] * velocity(marcher, lane, point + 1, support);
}

// What the clamp moved by over the last sub-step.
double ImpactRecorder::lift(const Marcher& marcher, int lane) const {
  return known_ < 2 ? 0.0 : marcher.support(lane, latest_time_) - marcher.support(lane, earlier_time_);
}

// A sub-step is over: the velocities over it.
void ImpactRecorder::moved(const Marcher& marcher, int lane) {
  Lane& state = lanes_[static_cast<std::size_t>(lane)];
  const double lifted = lift(marcher, lane);
  state.closed.each([&](int point) {
    if (left_) {
      const double place = model_.contact().times(point, latest_.data()) + marcher.lift(lane, point, latest_time_);
      return move_to_place(state, point, place, latest_time_);
    }
    const bool circle = model_.problem().circle_axis(point) == 0;
    move(state, point, velocity(marcher, lane, point, lifted),
         circle ? velocity(marcher, lane, point + 1, lifted) : 0.0);
  });
  leave(marcher, lane, lifted);
}

// The speeds at which points leave, as far as they are known.
void ImpactRecorder::leave(const Marcher& marcher, int lane, double lifted) {
  Lane& state = lanes_[static_cast<std::size_t>(lane)];
  std::erase_if(state.leaving, [&](int point) {
    Point& one = state.points[static_cast<std::size_t>(point)];
    if (one.row < state.impacts.size()) {
      Impact& impact = state.impacts[one.row];
      const double now = velocity_of(marcher, lane, point, lifted);
      impact.speed_out = impact.side == StopSide::lower ? now : -now;
    }
    return ++one.free == settles_after;
  });
}

// Points that have left the stop that held them at the start.
void ImpactRecorder::let_go(const Marcher& marcher, const StageView& view) {
  for (int lane = 0; lane < marcher.lanes(); ++lane)
    if (StartContact& start = lanes_[static_cast<std::size_t>(lane)].start; start.any())
      start.read(marcher, view.slots, view.from);
}

// A point closes, and whether it had been open: contact of the start goes on as if it had always been there.
bool ImpactRecorder::begin(const Marcher& marcher, const StageView& view, int lane, int point, int side) {
  Lane& state = lanes_[static_cast<std::size_t>(lane)];
  Point& one = state.points[static_cast<std::size_t>(point)];
  const double lifted = lift(marcher, lane), towards = velocity_of(marcher, lane, point, lifted);
  one.velocity = velocity(marcher, lane, point, lifted);
  if (model_.problem().circle_axis(point) == 0) one.across = velocity(marcher, lane, point + 1, lifted);
  one.came = side > 0 ? -towards : towards;
  std::erase(state.leaving, point);
  if (state.start.any() && state.start.take(point, side)) {
    one.row = nowhere;
    return false;
  }
  StopTotals& totals = stop(state, point, side);
  totals.fastest = totals.impacts == 0 ? one.came : std::max(totals.fastest, one.came);
  ++totals.impacts;
  ++state.count;
  one.row = state.impacts.size();
  if (one.row >= most_) {
    one.row = nowhere;
    return true;
  }
  Impact impact;
  impact.time = view.time + view.program->facts.instant * h_;
  impact.point = point;
  impact.side = side > 0 ? StopSide::lower : StopSide::upper;
  impact.speed_in = one.came;
  state.impacts.push_back(impact);
  return true;
}

void ImpactRecorder::close_instant(const Marcher& marcher, const StageView& view, int lane) {
  Lane& state = lanes_[static_cast<std::size_t>(lane)];
  state.force = 0;
  state.closed.end_instant([&](int point, int before, int now) {
    Point& one = state.points[static_cast<std::size_t>(point)];
    if (before != 0 && now != before) {
      if (one.row < state.impacts.size()) state.impacts[one.row].open_end = false;
      one.free = 0;
      if (now == 0) state.leaving.push_back(point);
    }
    one.side = now;
    if (now == 0) return;
    if (const double size = std::hypot(one.vector[0], one.vector[1]); size > 0) {
      if (one.given > 0) one.given = size;
      one.normal = {one.vector[0] / size, one.vector[1] / size};
      one.vector = {0, 0};
    }
    const bool closes = now != before && begin(marcher, view, lane, point, now);
    press(state, point, lasts_, view.time + view.program->facts.instant * h_, closes);
  });
  if (lane == 0)
    for (ContactListener* listener : listeners_) listener->over(view.time + view.program->facts.instant * h_);
  if (state.closed.idle() && state.leaving.empty()) busy_ &= ~(1U << lane);
}

void ImpactRecorder::finish(const Marcher& marcher) {
  if (known_ > 0 && marcher.time() > latest_time_) move_to(marcher, marcher.slots(), marcher.time());
}

double ImpactRecorder::take_peak(int lane) {
  return std::exchange(lanes_[static_cast<std::size_t>(lane)].peak, 0.0);
}

}  // namespace ricochet
