#include <algorithm>
#include <bit>
#include <ricochet/engine/flight/flight.hpp>

namespace ricochet {
namespace {

constexpr std::size_t most_sets = 64;   // of held points that are remembered
constexpr long long longest_wait = 64;  // steps between two looks that found nothing
constexpr int most_powers = 40;

}  // namespace

Flight::Flight(const Program& program, double layer, long long steps)
    : layer_(layer),
      powers_(std::clamp(static_cast<int>(std::bit_width(static_cast<unsigned long long>(steps))), 4, most_powers)) {
  free_ = std::make_unique<FlightSet>(program, layer, std::vector<HeldPoint>{}, powers_);
  set_ = free_.get();
  held_cause_ = why_not_held(program);
  legs_.resize(static_cast<std::size_t>(powers_) + 2);
}

std::string Flight::why_not_held(const Program& program) {
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
  return "";
}

Flight::Kept& Flight::kept(std::span<const HeldPoint> held) {
  for (auto& one : sets_)
    if (std::equal(held.begin(), held.end(), one->held.begin(), one->held.end())) return *one;
  if (sets_.size() == most_sets) {
    // The one that was seen least makes room.
    const auto least_seen =
        std::min_element(sets_.begin(), sets_.end(), [](const auto& a, const auto& b) { return a->seen < b->seen; });
    sets_.erase(least_seen);
  }
  Kept& one = *sets_.emplace_back(std::make_unique<Kept>());
  one.held.assign(held.begin(), held.end());
  return one;
}

long long Flight::look(const Program& program, const double* const* slots, const double* e,
                       std::span<const HeldPoint> held, long long most) {
  Pace* pace = &pace_;
  FlightSet* set = free_.get();
  if (!held.empty()) {
    if (!held_cause_.empty()) return 0;
    Kept& one = kept(held);
    // Its modes cost about as much as so many steps with all the dofs.
    const long long rows = program.model->rows();
    if (++one.seen < std::max(8LL, rows * rows / 20)) return 0;
    if (!one.set) one.set = std::make_unique<FlightSet>(program, layer_, one.held, powers_);
    if (!one.set->cause().empty()) return 0;
    pace = &one.pace;
    set = one.set.get();
  }
  if (pace->wait > 0) {
    --pace->wait;
    return 0;
  }
  most = std::min(most, set->motion().longest());
  const auto fails = [&] {
    pace->wait = pace->penalty;
    pace->penalty = std::min(2 * pace->penalty, longest_wait);
    pace->next = 2 * least;
    return 0LL;
  };
  std::copy_n(e, 3, start_e_);
  if (!set->enter(slots, e, start_)) return fails();
  FlightBound& bound = set->bound();
  bound.look(start_.data(), e);
  long long k = std::min(pace->next, most);
  if (bound.holds(k)) {
    while (k < most && bound.holds(std::min(2 * k, most))) k = std::min(2 * k, most);
  } else {
    do k /= 2;
    while (k >= least && !bound.holds(k));
  }
  if (k < least) return fails();
  pace->penalty = least;
  pace->next = k;
  set_ = set;
  return k;
}

FlightSums Flight::fly(long long k, double* const* slots, bool works) {
  FlightSums sums;
  x_ = start_;
  std::copy(start_e_, start_e_ + 3, e_);
  for (int power = 0; k >> power != 0; ++power) {
    if (((k >> power) & 1) == 0) continue;
    if (works) set_->works().add(power, x_.data(), e_, sums);
    set_->motion().leap(power, x_.data(), e_);
  }
  set_->leave(x_, e_, slots);
  flown_ = k;
  efforts_.resize(set_->held().size());
  return sums;
}

void Flight::tip_extremes(double& low, double& high) {
  legs_[0].x = start_;
  std::copy(start_e_, start_e_ + 3, legs_[0].e);
  search(0, flown_, low, high);
}

// Of the k steps from a leg on: by halves, as far as they may tell something.
void Flight::search(std::size_t depth, long long k, double& low, double& high) {
  Leg& leg = legs_[depth];
  FlightBound& tip = set_->tip();
  tip.look(leg.x.data(), leg.e);
  const double now = tip.value(0, 0);
  low = std::min(low, now);
  high = std::max(high, now);
  if (k == 1) return;
  const FlightBound::Range range = tip.range(0, 0, k - 1);
  if (range.low >= low && range.high <= high) return;
  Leg& half = legs_[depth + 1];
  half.x = leg.x;
  std::copy_n(leg.e, 3, half.e);
  search(depth + 1, k / 2, low, high);
  half.x = leg.x;
  std::copy_n(leg.e, 3, half.e);
  set_->motion().advance(k / 2, half.x.data(), half.e);
  search(depth + 1, k - k / 2, low, high);
}

}  // namespace ricochet
