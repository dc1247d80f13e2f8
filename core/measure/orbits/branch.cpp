#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/measure/orbits/branch.hpp>
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <utility>

namespace ricochet {

CornerRoots roots_at(const std::vector<std::complex<double>>& multipliers) {
  constexpr double least_angle = 0.01;
  CornerRoots roots;
  roots.outside = outside(multipliers);
  std::complex<double> product = 1;
  for (const std::complex<double>& one : multipliers) {
    product *= 1.0 + one;
    if (one.imag() == 0) {
      if (one.real() < 0 && (roots.real == 0 || std::abs(one.real() + 1) < std::abs(roots.real + 1)))
        roots.real = one.real();
      continue;
    }
    const double angle = std::arg(one), modulus = std::abs(one);
    if (angle < least_angle || angle > std::numbers::pi - least_angle) continue;
    if (roots.modulus != 0 && std::abs(modulus - 1) >= std::abs(roots.modulus - 1)) continue;
    roots.modulus = modulus;
    roots.angle = angle;
  }
  roots.product = product.real();
  return roots;
}

ContactRuns contact_runs(const SetSteps& sets, const SetSequence& sequence, bool half) {
  ContactRuns runs;
  const auto all = static_cast<long long>(sequence.size()) * (half ? 2 : 1);
  for (std::size_t row = 0; row < static_cast<std::size_t>(sets.measure_rows()); ++row)
    each_run(
        static_cast<long long>(sequence.size()), half,
        [&](long long k) { return sets[sequence[static_cast<std::size_t>(k)]].side[row]; },
        [&](long long, long long length) { runs.add(length, all); });
  return runs;
}

bool is_image(const SetSteps& sets, const SetSequence& sequence) {
  const std::size_t half = sequence.size() / 2;
  if (sequence.size() % 2 != 0) return false;
  for (std::size_t k = 0; k < half; ++k)
    if (!sets.mirrors(sequence[k], sequence[k + half])) return false;
  return true;
}

int repeats_sooner(const SetSequence& sequence, int period) {
  const std::ptrdiff_t steps = std::ssize(sequence) / period;
  for (int sooner = 1; sooner < period; ++sooner)
    if (period % sooner == 0 && std::equal(sequence.begin() + sooner * steps, sequence.end(), sequence.begin()))
      return sooner;
  return 0;
}

void BranchTrace::end_at_repeat(int sooner, double parameter) {
  end_by(TraceEnd::joined,
         fmt::format("its orbits repeat after {} period{} from {:.10g} on", sooner, sooner == 1 ? "" : "s", parameter));
}

void BranchTrace::end_at_image(double parameter) {
  end_by(TraceEnd::joined, fmt::format("its orbits become their own images at {:.10g}", parameter));
}

void BranchTrace::end_at_arc(double longest) {
  end_by(TraceEnd::limit, fmt::format("an arc of {:.4g} m, the longest of at_most", longest));
}

bool BranchTrace::grazes() const {
  constexpr double share = 0.01;
  if (rebounds == 0) return false;
  double fastest = 0;
  for (const BranchCorner& corner : corners) fastest = std::max(fastest, corner.slowest);
  return corners.back().slowest < share * fastest;
}

BranchRun::BranchRun(PeriodicMap& map, const MapClock& clock, PieceFollower follower, BranchLimits limits)
    : map_(&map), clock_(clock), follower_(std::move(follower)), limits_(std::move(limits)) {
  first_ = follower_.state().sets;
  read();
  keep(true);
}

BranchRun::BranchRun(PeriodicMap& map, const MapClock& clock, PieceFollower follower, BranchLimits limits,
                     BranchTrace trace, SetSequence first_sets)
    : map_(&map),
      clock_(clock),
      follower_(std::move(follower)),
      limits_(std::move(limits)),
      trace_(std::move(trace)),
      first_(std::move(first_sets)) {}

void BranchRun::read() {
  const BranchState& state = follower_.state();
  BranchCorner corner;
  corner.parameter = state.parameter;
  corner.arc = state.arc;
  corner.tip = map_->tip(state.x, state.parameter);
  corner.way = state.parameter_along < 0 ? -1 : 1;
  const ContactRuns runs = contact_runs(map_->sets(), state.sets, clock_.half);
  corner.runs = runs.count;
  corner.held = runs.held;
  corner.shortest = runs.shortest;
  corner.change = state.change;
  std::vector<std::complex<double>> raw = multipliers_of(*map_, clock_, follower_.derivative());
  corner.raw = roots_at(raw);
  corner.smooth = runs.count == 0
                      ? corner.raw
                      : roots_at(multipliers_of(*map_, clock_,
                                                half_step_derivative(*map_, follower_.derivative(), state.sets, clock_,
                                                                     state.parameter, follower_.measures())));
  corner.leading = limits_.leading(std::move(raw));
  trace_.corners.push_back(std::move(corner));
}

namespace {

// Whether a special point may lie between two corners.
bool changes(const BranchCorner& was, const BranchCorner& now) {
  return now.way != was.way || now.runs != was.runs || now.held != was.held || !(now.raw.outside == was.raw.outside) ||
         !(now.smooth.outside == was.smooth.outside) || (now.raw.product < 0) != (was.raw.product < 0) ||
         (now.smooth.product < 0) != (was.smooth.product < 0);
}

}  // namespace

// Every so many corners, and those at which something changes.
void BranchRun::keep(bool special) {
  const auto number = static_cast<long long>(trace_.corners.size()) - 1;
  if (!special && number % trace_.stride != 0) return;
  trace_.states.emplace(number, follower_.state().x);
  if (special || static_cast<std::size_t>(number / trace_.stride) < limits_.most_states) return;
  const auto regular = [&](long long at) {
    if (at == 0) return false;
    const BranchCorner &now = trace_.corners[static_cast<std::size_t>(at)],
                       &was = trace_.corners[static_cast<std::size_t>(at - 1)];
    return !changes(was, now);
  };
  trace_.stride *= 2;
  std::erase_if(trace_.states, [&](const auto& one) { return one.first % trace_.stride != 0 && regular(one.first); });
}

void BranchRun::finish(const Piece& piece) {
  const BranchState& state = follower_.state();
  if (piece.end == BranchEnd::range)
    trace_.end_by(TraceEnd::range, fmt::format("the range ends at {:.10g}", state.parameter));
  else if (piece.end == BranchEnd::unresolved)
    trace_.end_by(TraceEnd::left, fmt::format("the branch was left at λ = {:.10g}: {}", state.parameter, piece.why));
}

bool BranchRun::advance(long long pieces) {
  constexpr int most_standing = 100;
  const double at_once = met_at_once * map_->metric().parameter_metres() * (limits_.largest - limits_.least);
  for (; pieces > 0 && !trace_.ended(); --pieces) {
    const Piece piece = follower_.end_of_piece(limits_.least, limits_.largest);
    trace_.corners.back().residual = piece.residual;
    const BranchState before = follower_.state();
    trace_.ties += piece.tie;
    standing_ = piece.length > at_once || piece.end == BranchEnd::range ? 0 : standing_ + 1;
    if (piece.end == BranchEnd::unresolved || piece.residual > largest_residual || standing_ > most_standing) {
      Piece last = piece;
      last.end = BranchEnd::unresolved;
      if (standing_ > most_standing)
        last.why = fmt::format("bounds that are met at once change in a circle (step {} of {}, point {})",
                               piece.change.step + 1, clock_.steps(), map_->sets().place(piece.change.row).point + 1);
      if (last.why.empty()) last.why = fmt::format("the residual is {:.3g} m", piece.residual);
      finish(last);
      break;
    }
    for (const double mark : limits_.marks) {
      const double s = (mark - before.parameter) / before.parameter_along;
      // A mark at the end of the range is on its last piece.
      if (!(s >= 0) || s > piece.length || (s == piece.length && piece.end != BranchEnd::range)) continue;
      BranchState there = follower_.at(s);
      const double tip = map_->tip(there.x, mark);
      trace_.marks.push_back(
          {mark, there.arc, tip, static_cast<long long>(trace_.corners.size()) - 1, std::move(there.x)});
    }
    follower_.go(piece);
    if (piece.end != BranchEnd::none) {
      finish(piece);
      const BranchState& last = follower_.state();
      BranchCorner corner = trace_.corners.back();
      corner.parameter = last.parameter;
      corner.arc = last.arc;
      corner.tip = map_->tip(last.x, last.parameter);
      corner.change = {};
      trace_.corners.push_back(std::move(corner));
      trace_.states.emplace(static_cast<long long>(trace_.corners.size()) - 1, last.x);
      break;
    }
    read();
    const auto size = trace_.corners.size();
    const BranchCorner &now = trace_.corners[size - 1], &was = trace_.corners[size - 2];
    const bool closed = follower_.state().sets == first_;
    keep(changes(was, now) || closed);
    if (limits_.ends_at_image && is_image(map_->sets(), follower_.state().sets))
      trace_.end_at_image(now.parameter);
    else if (const int sooner = limits_.ends_sooner ? repeats_sooner(follower_.state().sets, clock_.period) : 0)
      trace_.end_at_repeat(sooner, now.parameter);
    else if (closed)
      trace_.end_by(TraceEnd::closed, "closed: the branch came back to its first piece");
    else if (follower_.state().pieces >= limits_.pieces)
      trace_.end_by(TraceEnd::limit,
                    fmt::format("{} piece{}, the most of at_most", limits_.pieces, limits_.pieces == 1 ? "" : "s"));
    else if (follower_.state().arc >= limits_.arc)
      trace_.end_at_arc(limits_.arc);
    if (trace_.ended()) trace_.states.emplace(static_cast<long long>(size) - 1, follower_.state().x);
  }
  return !trace_.ended();
}

}  // namespace ricochet
