#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/measure/orbits/impact_jump.hpp>
#include <ricochet/measure/orbits/section_march.hpp>

namespace ricochet {

std::string end_text(const Orbit& orbit) {
  return orbit.end_words.empty() ? text(orbit.end) : orbit.end_words;
}

namespace {

constexpr int impact_periods = 64;     // whose impacts are kept
constexpr double least_rebound = 0.1;  // of the speed of an impact

double central(const std::vector<double>& before, const std::vector<double>& after, std::size_t lane, double h) {
  return (after[lane] - before[lane]) / (2 * h);
}

}  // namespace

// Looks at contacts, and at the tip where extrema are wanted, of the lanes whose orbits are being kept.
class SectionMarch::Watch final : public StepObserver {
 public:
  Watch(const Marcher& marcher, const SectionPlan& plan, std::vector<std::optional<Orbit>>& orbits)
      : model_(*marcher.program().model),
        plan_(plan),
        orbits_(orbits),
        h_(marcher.program().h),
        offset_(marcher.program().velocity_offset) {
    tips_.resize(orbits.size());
    thrown_ = thrown_points(marcher.program(), least_rebound);
    // Contact alone is read of most steps, and flights keep it; where extrema are wanted, the tip is told of each.
    if (marcher.program().flight || plan.section != SectionKind::extremum) asks_.next_shown = never;
  }

  bool begin_period() {
    keeping_ = closed_ = pushed_ = 0;
    for (std::size_t lane = 0; lane < orbits_.size(); ++lane) {
      if (!orbits_[lane] || orbits_[lane]->stage != Orbit::Stage::keep) continue;
      keeping_ |= 1u << lane;
      if (orbits_[lane]->closed[0] || orbits_[lane]->closed[1]) closed_ |= 1u << lane;
      counts_[lane] = {0, 0};
      orbits_[lane]->rebounds_so_far = 0;
      tips_[lane] = {};
    }
    return keeping_ != 0;
  }
  const std::array<int, 2>& counts(std::size_t lane) const { return counts_[lane]; }

  void stage_solved(const Marcher& marcher, const StageView& view) override {
    if (!view.effort) return;
    if (view.program->opens_instant) pushed_ = 0;
    pushed_ |= view.contact_lanes;
    for (std::uint32_t mask = (pushed_ | closed_) & keeping_; mask != 0; mask &= mask - 1)
      read(marcher, view, std::countr_zero(mask));
  }

  void interval(Marcher& marcher, const StepInterval& steps) override {
    if ((keeping_ & 1U) == 0) return;
    if (plan_.section == SectionKind::extremum) steps.each_tip([&](double tip) { see_tip(0, tip); });
    if (steps.closed.empty()) return;
    Orbit& orbit = *orbits_.front();
    for (const ClosedPoint& closed : steps.closed)
      push(orbit, model_.problem().stop_row(closed.point), side_of(closed.point, closed.lower),
           kept_step(marcher, orbit));
    orbit.contact_steps += steps.instants * steps.steps;
    for (BriefContact& contact : orbit.brief)
      if (contact.point >= 0) contact.steps += steps.instants * steps.steps;
  }

  void step_done(Marcher& marcher) override {
    if (plan_.section != SectionKind::extremum) return;
    for (std::uint32_t mask = keeping_; mask != 0; mask &= mask - 1) {
      const int lane = std::countr_zero(mask);
      see_tip(static_cast<std::size_t>(lane), marcher.tip(lane));
    }
  }

 private:
  struct Tips {
    double before = 0, at = 0;
    int known = 0;
  };

  // Where it stands after one more step.
  void see_tip(std::size_t lane, double after) {
    auto& [before, at, known] = tips_[lane];
    if (known >= 2 && (at - before) * (after - at) <= 0 && at != before)
      orbits_[lane]->points.push_back({at, (after - before) / (2 * h_), std::numeric_limits<double>::quiet_NaN(),
                                       std::numeric_limits<double>::quiet_NaN()});
    before = at;
    at = after;
    ++known;
  }

  void read(const Marcher& marcher, const StageView& view, int lane) {
    Orbit& orbit = *orbits_[static_cast<std::size_t>(lane)];
    const int width = marcher.width(), points = model_.contact().rows();
    int first[2] = {-1, -1};
    const double* efforts = view.effort[0] + lane;
    const std::int64_t step = kept_step(marcher, orbit) + 1;
    for (int i = points; i-- > 0;) {
      const double p = efforts[static_cast<std::ptrdiff_t>(i) * width];
      if (p == 0) continue;
      const std::size_t side = side_of(i, p > 0);
      first[side] = i - std::max(0, model_.problem().circle_axis(i));
      push(orbit, model_.problem().stop_row(i), side, step);
    }
    std::array<bool, 2>& asked = asked_[static_cast<std::size_t>(lane)];
    if (view.program->opens_instant) asked = {false, false};
    bool any = false;
    for (std::size_t side = 0; side < 2; ++side) {
      const bool now = first[side] >= 0;
      if (now && !asked[side] && !orbit.closed[side])
        begin(marcher, view, lane, static_cast<int>(side), first[side], orbit);
      asked[side] = asked[side] || now;
      any = any || asked[side];
      if (view.program->closes_instant) orbit.closed[side] = asked[side];
    }
    if (!view.program->closes_instant) return;
    for (std::size_t side = 0; side < 2; ++side) follow(marcher, view, lane, asked[side], orbit.brief[side], orbit);
    orbit.contact_steps += any;
    closed_ &= ~(1u << lane);
    closed_ |= static_cast<std::uint32_t>(any) << lane;
  }

  // 0 lower, 1 upper; the sides of a clearance are one, upper.
  std::size_t side_of(int point, bool lower) const { return lower && !model_.problem().round(point) ? 0 : 1; }

  // Steps since its periods are kept.
  std::int64_t kept_step(const Marcher& marcher, const Orbit& orbit) const {
    return static_cast<std::int64_t>(orbit.kept_periods) * plan_.steps_per_period + marcher.step() - plan_.strobe - 1;
  }

  static void push(Orbit& orbit, int point, std::size_t side, std::int64_t step) {
    if (orbit.arrived) return;
    std::int64_t& last = orbit.pushed[2 * static_cast<std::size_t>(point) + side];
    orbit.arrived = step - last > longest_loose + 1;
    last = step;
    if (orbit.arrived) orbit.pushed = {};
  }

  // Until it is over or has lasted. What rests at its stop afterwards is where it is whenever it came.
  void follow(const Marcher& marcher, const StageView& view, int lane, bool closed, BriefContact& contact,
              Orbit& orbit) const {
    if (contact.point < 0) return;
    if (closed && ++contact.steps <= briefest_contact) return;
    orbit.lasting += contact.steps > briefest_contact && thrown_[static_cast<std::size_t>(contact.point)];
    if (!closed) {
      const double after = outwards(marcher, view, lane, static_cast<int>(contact.point));
      if (after * contact.before < 0 && std::abs(after) >= least_rebound * std::abs(contact.before))
        orbit.rebounds_so_far += std::abs(after - contact.before);
    }
    contact = {};
  }

  void begin(const Marcher& marcher, const StageView& view, int lane, int side, int point, Orbit& orbit) {
    const double t = view.from;
    const double speed = closing_speed(marcher, view, lane, point);
    const double turns = (static_cast<double>(marcher.step() % plan_.steps_per_period) + view.program->facts.from) /
                         plan_.steps_per_period;
    const double periods = orbit.transient_periods + orbit.kept_periods;
    const double steps = static_cast<double>(marcher.step()) + view.program->facts.from;
    orbit.impacts.push_back(
        {2 * std::numbers::pi * turns, side, std::abs(speed), point, h_ * (steps + periods * plan_.steps_per_period)});
    ++counts_[static_cast<std::size_t>(lane)][static_cast<std::size_t>(side)];
    orbit.brief[side] = {point, 0, outwards(marcher, view, lane, point)};
    if (plan_.section != SectionKind::impact) return;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const SupportMotions& motions = marcher.motions();
    orbit.points.push_back(
        {displacement(marcher, view, lane) + (marcher.support(lane, t) + motions.tip(t)),
         velocity(marcher, view, lane, model_.tip(), 0) + (marcher.support_rate(lane, t) + motions.tip_rate(t)), nan,
         nan});
  }

  // The velocity at which a point meets its stop, at the time when the gap closes. It lies on the line through that of
  // the scheme and that of the free step to come. A point without mass changes its velocity within few steps.
  double closing_speed(const Marcher& marcher, const StageView& view, int lane, int point) const {
    const double t = view.from, dt = view.to - view.from;
    const double before = outwards(marcher, view, lane, point);
    const Program& program = marcher.program();
    const StageProgram& stage = program.stages[static_cast<std::size_t>(view.stage)];
    const Combination& update = view.plan->update[0];
    // What a law of its own rows measures does not say where the point is.
    if (program.problem->circle_axis(point) == 0 || dt == 0 || stage.gate || stage.measure_z == 0 || update.z == 0 ||
        program.problem->changed_by_law())
      return before;
    // H q₊ of the free step from what the law measured, which is affine in the same z°.
    const auto at = [&](const std::vector<double>& weights) {
      double sum = 0;
      for (std::size_t j = 0; j < weights.size(); ++j)
        if (weights[j] != 0)
          sum += weights[j] * slot_at(view, marcher.width(), lane, static_cast<int>(j), model_.contact(), point);
      return sum;
    };
    const std::ptrdiff_t place = static_cast<std::ptrdiff_t>(point) * marcher.width() + lane;
    const double measured = view.free[place] - marcher.lift_levels(lane, point, view.time, stage.measure_levels);
    const double z = (measured - at(stage.measure.slots)) / stage.measure_z;
    const double now = at({1.0}) + marcher.lift(lane, point, t);
    const double next = at(update.slots) + update.z * z + marcher.lift(lane, point, view.to);
    const double after = (next - now) / dt;
    const LaneSpec& spec = program.lanes[static_cast<std::size_t>(lane)];
    const double stop = view.effort[0][place] > 0 ? spec.lower[point] : spec.upper[point];
    const double ahead = next != now ? std::clamp((stop - now) / (next - now), 0.0, 1.0) : 0.0;
    // The velocity stands where it does after any sub-step.
    const double offset = offset_ * h_ / dt, share = (ahead - offset) / (0.5 - offset);
    return before + share * (after - before);
  }

  // The velocity of a contact point before the stage along its row, in a circle along its radius.
  double outwards(const Marcher& marcher, const StageView& view, int lane, int point) const {
    const auto speed = [&](int row) {
      return velocity(marcher, view, lane, model_.contact(), row) + marcher.lift_rate(lane, row, view.from);
    };
    if (model_.problem().circle_axis(point) != 0) return speed(point);
    const StopCircle circle = marcher.circle(lane, point);
    const auto at = [&](int row) {
      return slot_at(view, marcher.width(), lane, 0, model_.contact(), row) + marcher.lift(lane, row, view.from);
    };
    return circle.outwards(at(point), at(point + 1), speed(point), speed(point + 1));
  }

  double slot_at(const StageView& view, int width, int lane, int slot, const RowMatrix& rows, int row) const {
    double sum = 0;
    for (int e = rows.start[static_cast<std::size_t>(row)]; e < rows.start[static_cast<std::size_t>(row) + 1]; ++e)
      sum += rows.value[static_cast<std::size_t>(e)] *
             view.slots[slot][static_cast<std::ptrdiff_t>(rows.index[static_cast<std::size_t>(e)]) * width + lane];
    return sum;
  }

  double displacement(const Marcher& marcher, const StageView& view, int lane) const {
    return slot_at(view, marcher.width(), lane, 0, model_.tip(), 0);
  }

  // Of a row of H or of the tip, relative to the clamp, before the stage.
  double velocity(const Marcher& marcher, const StageView& view, int lane, const RowMatrix& rows, int row) const {
    const std::vector<double>& weights = marcher.program().plan.velocity.slots;
    double sum = 0;
    for (int e = rows.start[static_cast<std::size_t>(row)]; e < rows.start[static_cast<std::size_t>(row) + 1]; ++e) {
      const auto at = static_cast<std::ptrdiff_t>(rows.index[static_cast<std::size_t>(e)]) * marcher.width() + lane;
      for (std::size_t j = 0; j < weights.size(); ++j)
        sum += rows.value[static_cast<std::size_t>(e)] * weights[j] * view.slots[j][at];
    }
    return sum;
  }

  const MarchModel& model_;
  const SectionPlan& plan_;
  std::vector<std::optional<Orbit>>& orbits_;
  double h_, offset_;
  std::uint32_t keeping_ = 0, closed_ = 0;
  std::uint32_t pushed_ = 0;  // at the present instant, by any of its stages
  std::array<std::array<int, 2>, 32> counts_{};
  std::array<std::array<bool, 2>, 32> asked_{};  // sides in contact at the present instant
  std::vector<Tips> tips_;
  std::vector<bool> thrown_;  // of the contact points
};

SectionMarch::SectionMarch(Program program, const SectionPlan& plan) : marcher_(std::move(program)), plan_(plan) {
  const auto lanes = static_cast<std::size_t>(marcher_.lanes());
  orbits_.resize(lanes);
  watch_ = std::make_unique<Watch>(marcher_, plan_, orbits_);
  for (Reading* reading : {&strobe_, &opposite_})
    for (auto* tips : {&reading->before, &reading->at, &reading->after}) tips->resize(lanes);
  for (int lane = 0; lane < marcher_.lanes(); ++lane) marcher_.freeze(lane, {.cause = EndCause::idle});
  marcher_.set_clock(plan_.strobe + 1);
}

SectionMarch::~SectionMarch() = default;

void SectionMarch::load(int place, Orbit orbit) {
  if (orbit.settling.scale.empty()) orbit.settling = Settling(plan_.reading_scale(), plan_.tolerance);
  marcher_.set_lane(place, orbit.lane, orbit.now);
  // The period that started it may be all that was asked.
  if (orbit.stage == Orbit::Stage::transient && orbit.transient_periods > 0) end_transient(place, orbit);
  orbits_[static_cast<std::size_t>(place)] = std::move(orbit);
}

void SectionMarch::read_tips(std::vector<double>& tips) const {
  for (std::size_t lane = 0; lane < orbits_.size(); ++lane)
    if (orbits_[lane]) tips[lane] = marcher_.tip(static_cast<int>(lane));
}

void SectionMarch::march_to(int step, bool watched) {
  const long long steps = step - marcher_.step();
  if (steps > 0) marcher_.march(steps, watched ? watch_.get() : nullptr);
}

std::vector<Orbit> SectionMarch::period() {
  const int origin = plan_.strobe + 1, whole = plan_.steps_per_period, half = plan_.strobe + whole / 2;
  const bool watched = watch_->begin_period();
  march_to(half - 1, watched);
  read_tips(opposite_.before);
  march_to(half, watched);
  read_tips(opposite_.at);
  march_to(half + 1, watched);
  read_tips(opposite_.after);
  march_to(plan_.strobe + whole - 1, watched);
  read_tips(strobe_.before);
  march_to(plan_.strobe + whole, watched);
  read_tips(strobe_.at);
  march_to(origin + whole, watched);
  read_tips(strobe_.after);
  marcher_.set_clock(origin);
  std::vector<Orbit> ended;
  const double h = marcher_.program().h;
  for (std::size_t lane = 0; lane < orbits_.size(); ++lane) {
    if (!orbits_[lane]) continue;
    Orbit& orbit = *orbits_[lane];
    const int place = static_cast<int>(lane);
    const LaneStatus& status = marcher_.status(place);
    if (!status.running) {
      orbit.stage = Orbit::Stage::stopped;
      orbit.end = status.end;
      orbit.stopped_period = orbit.transient_periods + orbit.kept_periods + 1;
    } else {
      const SectionPoint point{strobe_.at[lane], central(strobe_.before, strobe_.after, lane, h), -opposite_.at[lane],
                               -central(opposite_.before, opposite_.after, lane, h)};
      close_period(place, orbit, point, (strobe_.before[lane] + 2 * strobe_.at[lane] + strobe_.after[lane]) / 4);
    }
    if (orbit.stage != Orbit::Stage::complete && orbit.stage != Orbit::Stage::stopped) continue;
    if (orbit.stage == Orbit::Stage::complete) orbit.now = marcher_.lane_state(place);
    marcher_.freeze(place, {.cause = EndCause::idle});
    ended.push_back(std::move(orbit));
    orbits_[lane].reset();
  }
  return ended;
}

void SectionMarch::close_period(int place, Orbit& orbit, const SectionPoint& point, double smoothed) {
  // A sawtooth of single steps takes no part in settling and recurrence: readings are means over two steps.
  const std::array<double, 4> row = {smoothed, point.velocity, point.opposite_displacement, point.opposite_velocity};
  if (orbit.stage == Orbit::Stage::keep) {
    ++orbit.kept_periods;
    orbit.strobed.push_back(point);
    orbit.readings.width = static_cast<int>(row.size());
    orbit.readings.values.insert(orbit.readings.values.end(), row.begin(), row.end());
    const auto& counts = watch_->counts(static_cast<std::size_t>(place));
    orbit.impact_counts.push_back(counts[0] + counts[1]);
    orbit.most_on_a_side = std::max({orbit.most_on_a_side, counts[0], counts[1]});
    orbit.rebounds = std::max(orbit.rebounds, orbit.rebounds_so_far);
    const std::size_t old = orbit.impact_counts.size();
    if (old > impact_periods && orbit.impact_counts[old - 1 - impact_periods] > 0)
      orbit.impacts.erase(orbit.impacts.begin(), orbit.impacts.begin() + orbit.impact_counts[old - 1 - impact_periods]);
    if (orbit.kept_periods >= plan_.keep) complete(orbit);
    return;
  }
  ++orbit.transient_periods;
  orbit.settled = orbit.settling.add(row.data());
  end_transient(place, orbit);
}

void SectionMarch::end_transient(int place, Orbit& orbit) const {
  if (orbit.transient_periods < plan_.transient) return;
  if (!orbit.settled && orbit.transient_periods < plan_.at_most) return;
  orbit.stage = Orbit::Stage::keep;
  // Contact that is there when the kept periods begin is no impact of theirs.
  const std::array<bool, 2> closed = marcher_.pushed_by(place);
  std::copy(closed.begin(), closed.end(), orbit.closed);
  if (!marcher_.program().problem->clearances.empty()) orbit.closed[1] = closed[0] || closed[1];
  orbit.entry = marcher_.lane_state(place);
  orbit.pushed.assign(2 * static_cast<std::size_t>(marcher_.program().model->contact().rows()), 0);
}

void SectionMarch::complete(Orbit& orbit) const {
  orbit.stage = Orbit::Stage::complete;
  std::int64_t last = 0;
  for (const std::int64_t step : orbit.pushed) last = std::max(last, step);
  const std::int64_t steps = static_cast<std::int64_t>(orbit.kept_periods) * plan_.steps_per_period;
  orbit.rests = orbit.contact_steps > 0 && !orbit.arrived && steps - last <= longest_loose;
  orbit.pushed = {};
  if (!orbit.rests) return;
  // What never opens is no impact.
  orbit.impacts = {};
  std::fill(orbit.impact_counts.begin(), orbit.impact_counts.end(), 0);
  orbit.most_on_a_side = 0;
  orbit.rebounds = 0;
  orbit.lasting = 0;
  if (plan_.section == SectionKind::impact) orbit.points = {};
}

std::vector<Orbit> SectionMarch::running() const {
  std::vector<Orbit> copies;
  for (std::size_t lane = 0; lane < orbits_.size(); ++lane) {
    if (!orbits_[lane]) continue;
    copies.push_back(*orbits_[lane]);
    copies.back().now = marcher_.lane_state(static_cast<int>(lane));
  }
  return copies;
}

}  // namespace ricochet
