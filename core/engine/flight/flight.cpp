#include <algorithm>
#include <cmath>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/flight/flight_set.hpp>
#include <ricochet/engine/flight/push_tables.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <utility>

namespace ricochet {
namespace {

constexpr long long longest_wait = 64;  // steps between two searches that found nothing
// Steps after which the tip is read sooner than searched for: at all, and where its ends do not tell.
constexpr long long at_once = 32, soon_read = 256;
// Steps that are marched between two searches after which points had to be followed; readings that cost what a step
// does.
constexpr long long longest_march = 16384, readings_of_step = 8;
constexpr long long modes_of_step = 30;  // n² numbers in the tables of a set that cost what a step does
constexpr long long brief = 8;           // steps in contact that are marched before any is left out

}  // namespace

Flight::Flight(const Program& program, double layer, long long steps)
    : layer_(layer),
      worth_reading_(std::max<long long>(readings_of_step, program.problem->points() / 2)),
      powers_(flight_powers(steps)),
      most_sets_(most_flight_sets(
          flight_set_bytes(program.model->rows(), static_cast<int>(program.plan.slots.size()), powers_))) {
  const LaneSpec& lane = program.lanes.front();
  crossed_ = (lane.lower.array() > lane.upper.array()).any();
  free_ = std::make_unique<FlightSet>(program, layer, std::vector<ClosedPoint>{}, powers_);
  set_ = free_.get();
  closed_cause_ = why_not_closed(program);
  steps_cause_ = ClosedSteps::why_not(program);
  tells_slots_ = program.stages.size() == 1 && program.width == 1 && (!program.contact || closed_cause_.empty());
  if (tells_slots_) {
    slots_.assign(program.plan.slots.size(), std::vector<double>(static_cast<std::size_t>(program.model->rows())));
    for (std::vector<double>& slot : slots_) slot_pointers_.push_back(slot.data());
  }
  legs_.resize(static_cast<std::size_t>(powers_) + 2);
}

std::string Flight::why_not_closed(const Program& program) {
  if (!program.contact) return "there is none";
  if (program.law->reads()) return "the law is compliant";
  if (program.stages.size() != 1) return "the step has several stages";
  const StageProgram& stage = program.stages.front();
  if (stage.gate) return "the scheme closes contact by velocities";
  if (stage.impulse.op || stage.effort.size() != 1 || stage.effort[0] != 1 || stage.work_effort.size() > 1)
    return "efforts of steps before act on";
  if (stage.measure.z == 0) return "the impact measure does not see the effort of its own step";
  if (program.problem->changed_by_law()) return "the law measures no displacements";
  if (program.law->memory_per_point() > 0) return "the law keeps a memory";
  if (program.model->modal_damping().size() > 0) return "the damping is that of the open modes";
  return "";
}

// Points that are closed elsewhere move otherwise: their sets are made anew.
void Flight::place(const LaneSpec& lane, double layer) {
  layer_ = layer;
  crossed_ = (lane.lower.array() > lane.upper.array()).any();
  latest_ = nullptr;
  free_->place(lane, layer);
  sets_.clear();
  set_ = free_.get();
}

void Flight::forget() {
  comes_back_ = true;
  schedule_ = {};
  latest_ = nullptr;
  for (auto& one : sets_) {
    one->seen = 0;
    one->schedule = {};
  }
}

Flight::ContactSet& Flight::contact_set(std::span<const ClosedPoint> closed) {
  for (auto& one : sets_)
    if (std::equal(closed.begin(), closed.end(), one->closed.begin(), one->closed.end())) return *one;
  if (sets_.size() == most_sets_) {
    // The one that was seen least makes room.
    const auto least_seen =
        std::min_element(sets_.begin(), sets_.end(), [](const auto& a, const auto& b) { return a->seen < b->seen; });
    sets_.erase(least_seen);
  }
  ContactSet& one = *sets_.emplace_back(std::make_unique<ContactSet>());
  one.closed.assign(closed.begin(), closed.end());
  return one;
}

// A set of the same points, otherwise closed, that was seen often enough to be made; null: there is none.
const FlightSet* Flight::twin_of(const ContactSet& one, long long enough) const {
  const auto same_point = [](const ClosedPoint& a, const ClosedPoint& b) { return a.point == b.point; };
  for (const auto& other : sets_)
    if (other.get() != &one && other->set && other->set->cause().empty() && other->seen >= enough &&
        std::equal(other->closed.begin(), other->closed.end(), one.closed.begin(), one.closed.end(), same_point))
      return other->set.get();
  return nullptr;
}

bool Flight::due(const Program& program, std::span<const ClosedPoint> closed) {
  set_ = free_.get();
  steps_ = nullptr;
  set_schedule_ = &schedule_;
  // Stops that pass each other push from both sides: no point is closed by one of them alone.
  if (!closed.empty() && crossed_) return false;
  const ContactSet* const before = std::exchange(latest_, nullptr);
  if (!closed.empty() && !closed_cause_.empty()) {
    if (!steps_cause_.empty()) return false;
    ContactSet& one = contact_set(closed);
    // Their numbers cost about as much as so many steps.
    const long long points = static_cast<long long>(closed.size());
    if (++one.seen < std::max(brief, program.model->rows() * points / 2)) return false;
    if (!one.steps) one.steps = std::make_unique<ClosedSteps>(program, *free_, one.closed);
    steps_ = one.steps.get();
    set_schedule_ = &one.schedule;
  } else if (!closed.empty()) {
    ContactSet& one = contact_set(closed);
    latest_ = &one;
    latest_for_ = &one == before ? latest_for_ + 1 : 1;
    // Its modes cost about as much as so many steps with all the dofs. Points that come back to one stop come back to
    // the other one. What a short contact has before it rests cannot be left out, and does not count.
    // Of a march that comes back to its clock every period, sets do too: they pay over all periods.
    const long long rows = program.model->rows(),
                    enough = comes_back_ ? brief : std::max(brief, rows * rows / modes_of_step);
    const FlightSet* const twin = twin_of(one, enough);
    if (latest_for_ > least) ++one.seen;
    if (one.seen < (twin ? brief : enough)) return false;
    if (!one.set) one.set = std::make_unique<FlightSet>(program, layer_, one.closed, powers_, twin);
    if (!one.set->cause().empty()) return false;
    set_schedule_ = &one.schedule;
    set_ = one.set.get();
  }
  if (set_schedule_->wait == 0) return true;
  --set_schedule_->wait;
  return false;
}

// A run of steps ends where contact changes, or where another point might close.
long long Flight::step_closed(Columns columns, const double* e, ClosedSteps::Past past, long long most) {
  const long long asked = std::min(most, set_schedule_->next), k = steps_->march(columns[0], e, past, asked);
  if (k < least) {
    set_schedule_->wait = std::max(set_schedule_->penalty, least);
    set_schedule_->penalty = std::min(2 * set_schedule_->wait, longest_wait);
    set_schedule_->next = 2 * least;
    return 0;
  }
  set_schedule_->penalty = least;
  set_schedule_->next = std::min(2 * k, ClosedSteps::longest);
  return k;
}

long long Flight::search(Columns columns, const double* e, ClosedSteps::Past past, long long most) {
  clear_ = 0;
  if (steps_) return step_closed(columns, e, past, most);
  FlightSet* const set = set_;
  Schedule* const schedule = set_schedule_;
  most = std::min(most, set->motion().longest());
  const auto fails = [&] {
    schedule->wait = schedule->penalty;
    schedule->penalty = std::clamp<long long>(2 * schedule->penalty, 1, longest_wait);
    return 0LL;
  };
  std::copy_n(e, 3, start_.e);
  if (!set->enter(columns[0], e, start_.x)) return fails();
  tangents_.resize(columns.size() - 1);
  for (std::size_t k = 0; k < tangents_.size(); ++k)
    if (!set->enter(columns[k + 1], tangents_[k].e, tangents_[k].x)) return fails();
  // The steps that begin 0 to `last` steps from now are clear.
  const long long last = set->clear_steps().count(start_.x, e, most, schedule->next);
  const long long k = tells_slots_ ? std::min(last + 1, most) : last;
  const long long clear_after = last + 1 - (k < least ? 0 : k);
  if (set->closed().empty() && last >= 0) clear_ = clear_after;
  // What is reached is known to the step: until then there is nothing to look for.
  if (last < most) schedule->wait = clear_after;
  if (last < 0) return fails();
  schedule->penalty = 0;
  if (k < least) return 0;
  // Points that are near a bound in nearly every step cost as much to follow as steps that are marched: those come
  // next.
  const bool dear = set->clear_steps().read() > k * worth_reading_;
  schedule->dear = dear ? std::min(std::max(2 * schedule->dear, k), longest_march) : schedule->dear / 2;
  schedule->wait = std::max(schedule->wait, schedule->dear);
  return k;
}

FlightSums Flight::fly(long long k, Columns columns, ClosedSteps::Past past, bool works) {
  FlightSums sums;
  pushed_asked_ = false;
  if (steps_) {
    steps_->leave(columns[0], past);
    return steps_->sums();
  }
  last_ = start_;
  for (int power = 0; k >> power != 0; ++power) {
    if (((k >> power) & 1) == 0) continue;
    if (works) set_->works().add(power, last_.x.data(), last_.e, sums);
    set_->motion().leap(power, last_.x.data(), last_.e);
  }
  set_->leave(last_.x, last_.e, columns[0]);
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    advance(k, tangents_[i]);
    set_->leave(tangents_[i].x, tangents_[i].e, columns[i + 1]);
  }
  flown_ = k;
  efforts_from_ = -1;
  return sums;
}

const double* const* Flight::slots_before(long long step) {
  last_ = start_;
  advance(step, last_);
  set_->leave(last_.x, last_.e, slot_pointers_.data());
  return slot_pointers_.data();
}

long long Flight::find_efforts(long long first) {
  const long long count = std::min(effort_block, flown_ - first);
  if (efforts_from_ == first) return count;
  // The first block begins where the flight does, the next where the last one ended.
  if (efforts_from_ < 0 || effort_next_ != first) {
    after_efforts_ = start_;
    advance(first, after_efforts_);
  }
  const std::size_t points = set_->closed().size();
  efforts_.resize(static_cast<std::size_t>(effort_block) * points);
  for (long long k = 0; k < count; k += StepReadings::block) {
    const int steps = static_cast<int>(std::min<long long>(StepReadings::block, count - k));
    for (std::size_t i = 0; i < points; ++i) {
      double efforts[StepReadings::block];
      set_->effort(i).first(steps, after_efforts_.x.data(), after_efforts_.e, efforts);
      for (int step = 0; step < steps; ++step)
        efforts_[static_cast<std::size_t>(k + step) * points + i] = efforts[step];
    }
    advance(steps, after_efforts_);
  }
  efforts_from_ = first;
  effort_next_ = first + count;
  return count;
}

void Flight::tip_extremes(double& low, double& high) {
  if (steps_) {
    for (const double tip : steps_->tips()) {
      low = std::min(low, tip);
      high = std::max(high, tip);
    }
    return;
  }
  Sought sought{nullptr, set_->tip_readings(), 0, low, high};
  if (flown_ <= at_once)
    read_all(start_, flown_, sought);
  else
    find_extremes(set_->tip(), sought);
  low = sought.low;
  high = sought.high;
}

void Flight::see_at(Sought& sought, const Leg& leg) {
  values_.resize(static_cast<std::size_t>(sought.bound->watch(0).rows.rows()));
  sought.bound->values(0, leg.x.data(), leg.e, values_.data());
  sought.see(values_[static_cast<std::size_t>(sought.point)]);
}

// Of many steps.
void Flight::find_extremes(const ExtremeBounds& bounds, Sought& sought) {
  sought.bound = bounds.each.get();
  // The last first: most of what comes before it is then known to be no extreme.
  legs_[1] = start_;
  advance(flown_ - 1, legs_[1]);
  see_at(sought, legs_[1]);
  legs_[0] = start_;
  if (!bounds.by_four) return search(sought, 0, flown_, 1);
  if (told_by_ends(sought, legs_[0], flown_, 1)) return;
  sought.bound = bounds.by_four.get();
  for (long long first = 0; first < std::min(4LL, flown_); ++first) {
    legs_[0] = start_;
    advance(first, legs_[0]);
    search(sought, 0, (flown_ - first + 3) / 4, 4);
  }
}

// Whether the first of k readings and the last one are all that may be an extreme; these are then told.
bool Flight::told_by_ends(Sought& sought, const Leg& leg, long long k, int stride) {
  FlightBound& bound = *sought.bound;
  bound.set_state(leg.x.data(), leg.e);
  sought.see(bound.value(0, sought.point));
  if (k == 1) return true;
  const FlightBound::Range range = bound.range(0, sought.point, k - 1);
  if (range.low >= sought.low && range.high <= sought.high) return true;
  if (k > 2) {
    const FlightBound::Range change = bound.range(1, sought.point, k - 2);
    if (change.low <= 0 && change.high >= 0) return false;
  }
  last_ = leg;
  advance((k - 1) * stride, last_);
  see_at(sought, last_);
  return true;
}

// After each of some steps from a leg on.
void Flight::read_all(const Leg& leg, long long steps, Sought& sought) {
  last_ = leg;
  sought.readings.each(set_->motion(), steps, last_.x.data(), last_.e, [&](double value) { sought.see(value); });
}

// Of k readings from a leg on, `stride` steps apart: by halves, as far as they may tell something.
void Flight::search(Sought& sought, std::size_t depth, long long k, int stride) {
  const Leg& leg = legs_[depth];
  if (told_by_ends(sought, leg, k, stride)) return;
  // Halves of few steps cost more than their readings.
  if ((k - 1) * stride < soon_read) return read_all(leg, (k - 1) * stride + 1, sought);
  Leg& next = legs_[depth + 1];
  next = leg;
  advance(k / 2 * stride, next);
  search(sought, depth + 1, k - k / 2, stride);
  next = leg;
  search(sought, depth + 1, k / 2, stride);
}

std::span<const Flight::Pushed> Flight::pushed() {
  if (std::exchange(pushed_asked_, true)) return pushed_;
  pushed_.clear();
  if (steps_ || set_->closed().empty()) return pushed_;
  std::vector<PushTables>* const tables = set_->push_tables(flown_);
  if (!tables) return pushed_;
  pushed_.resize(tables->size());
  for (std::size_t i = 0; i < tables->size(); ++i) push_point(i, (*tables)[i]);
  return pushed_;
}

// The long powers of two by tables, the rest step by step.
void Flight::push_point(std::size_t i, PushTables& tables) {
  const double side = set_->closed()[i].lower ? 1 : -1;
  const StepReadings& readings = set_->effort(i);
  Pushed& one = pushed_[i];
  Leg& leg = legs_[0];
  leg = start_;
  double sum = 0;
  for (int power = PushTables::shortest; flown_ >> power != 0; ++power) {
    if (((flown_ >> power) & 1) == 0) continue;
    tables.add(power, leg.x.data(), leg.e, sum, one.squares);
    set_->motion().leap(power, leg.x.data(), leg.e);
  }
  const long long rest = flown_ & ((1LL << PushTables::shortest) - 1);
  readings.each(set_->motion(), rest, leg.x.data(), leg.e, [&](double p) {
    sum += p;
    one.squares += p * p;
  });
  one.sum = side * sum;
  Sought sought{nullptr, readings, static_cast<int>(i), infinity, -infinity};
  find_extremes(set_->effort_extremes(), sought);
  one.most = std::max(std::abs(sought.low), std::abs(sought.high));
  leg = start_;
  advance(flown_ - 1, leg);
  one.last = side * readings(0, leg.x.data(), leg.e);
}

}  // namespace ricochet
