#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "runners/check/law_checks.hpp"

namespace ricochet::checking {
namespace {

// Load, let go, a second touch that goes deeper, let go, a third one.
constexpr std::array<double, 6> turns = {0.5, -0.2, 1, -0.3, 0.8, -0.2};

constexpr int touching = 3, both = 2;  // points, and lanes

// Three points on the way that `share` of the deepest stands for: on the lower stop in lane 0, on the upper one in lane
// 1, each point a little behind the one before it.
LaneProblem pressed(int side, double share, double last, double far, double layer, const Eigen::VectorXd& effort) {
  constexpr double open = std::numeric_limits<double>::infinity(),
                   time = 2e-3;  // s between two instants: speeds of some 0.5 m/s
  constexpr std::array<double, touching> sizes = {1, 0.7, 0.85};
  LaneProblem lane;
  for (auto* v : {&lane.free, &lane.rate, &lane.before}) *v = Eigen::VectorXd::Zero(touching);
  lane.lower = Eigen::VectorXd::Constant(touching, side < 0 ? layer : -open);
  lane.upper = Eigen::VectorXd::Constant(touching, side < 0 ? open : -layer);
  for (int i = 0; i < touching; ++i) {
    const double size = far * sizes[static_cast<std::size_t>(i)];
    lane.free[i] = side * (share * size - layer);
    lane.before[i] = side * (last * size - layer);
    lane.rate[i] = (lane.free[i] - lane.before[i]) / time;
  }
  lane.effort = effort;
  return lane;
}

bool differ(const LawBench& one, const LawBench& other, int lane) {
  const LaneOutcome &a = one.outcome(lane), &b = other.outcome(lane);
  return one.effort(lane) != other.effort(lane) || a.converged != b.converged || a.residual != b.residual ||
         a.dissipation != b.dissipation;
}

/// What a law keeps over load, unload and reload.
struct Remembered {
  int numbers = 0;       // per point
  std::string wrong;     // "": nothing
  bool written = false;  // whether any is ever other than 0
  bool lasts = false;    // whether any answer, or what is kept after it, follows from what was kept
};

Remembered remembered(const Law& law) {
  LawBench single(law, 1, 1);
  const bool barrier = is_barrier(single);
  Remembered found;
  found.numbers = single.law().memory_per_point();
  const auto with = [&](std::string wrong) {
    found.wrong = std::move(wrong);
    return found;
  };
  const double layer = single.layer(), far = barrier ? 0.9 * layer : 0.01, reach = barrier ? 0.0 : 1.0;
  std::mt19937 random(20261128);
  DenseDelassus W = random_delassus(random, touching, flexibility_of(law));
  LawBench bench(law, touching, both);
  bench.remember(true);
  double share = 0;
  int solves = 0;
  for (const double turn : turns) {
    constexpr int steps = 6;
    const double from = share;
    for (int k = 1; k <= steps; ++k) {
      const double last = share;
      share = from + (turn - from) * k / steps;
      std::vector<LaneProblem> problems;
      for (int l = 0; l < both; ++l)
        problems.push_back(pressed(l == 0 ? -1 : 1, share, last, far, layer, bench.effort(l)));
      const bool touched = share > 0 || last > 0 || bench.effort(0).any() || bench.effort(1).any();
      const std::vector<double> kept = bench.memory();
      bench.solve(W, reach, reach, problems, touched ? std::vector<int>{0, 1} : std::vector<int>{});
      if (!touched) continue;
      ++solves;
      for (int l = 0; l < both; ++l)
        if (!bench.effort(l).allFinite() || !bench.outcome(l).converged)
          return with(fmt::format("solve {} of a load, unload and reload, {}", solves,
                                  bench.outcome(l).converged ? "an effort is not finite" : "does not converge"));
      const std::vector<double> left = bench.memory();
      if (std::any_of(left.begin(), left.end(), [](double x) { return std::isnan(x); }))
        return with(fmt::format("keeps a number that is none after {} solves", solves));
      if (k % 2 == 0) {
        LawBench other(law, touching, both);
        other.keep(kept);
        other.solve(W, reach, reach, problems, {0, 1});
        for (int l = 0; l < both; ++l)
          if (differ(bench, other, l) || bench.memory() != other.memory())
            return with(fmt::format(
                "solve {} of a load, unload and reload: it answers {:.10g} N, and {:.10g} N as a new law with the same "
                "numbers kept. What lasts between solves must stand in `memory`: it is part of a lane's state",
                solves, bench.effort(l)[0], other.effort(l)[0]));
      }
      const bool some = std::any_of(kept.begin(), kept.end(), [](double x) { return x != 0; });
      if (!some || found.lasts) continue;
      found.written = true;
      LawBench blank(law, touching, both);
      blank.solve(W, reach, reach, problems, {0, 1});
      found.lasts = blank.memory() != bench.memory() || differ(bench, blank, 0) || differ(bench, blank, 1);
    }
  }
  return found;
}

// With any of its parameter values: some may switch a memory off.
bool some_values_remember(const Law& law) {
  for (ParameterSet& set : parameter_sets(law.entry->manual.parameters)) {
    try {
      if (remembered({law.entry, std::move(set)}).lasts) return true;
    } catch (const std::exception&) {
      // Told with these values themselves.
    } catch (const Refused&) {
    }
  }
  return false;
}

}  // namespace

Verdict answers_follow_from_memory(const Law& law) {
  if (law.make()->absent()) return not_applicable(no_contact_at_all);
  const auto [numbers, wrong, written, lasts] = remembered(law);
  if (!wrong.empty()) return fails(wrong);
  if (numbers == 0) return fine("none: each solve is a matter of its own, over load, unload and reload");
  if (!written) return not_declared(fmt::format("{} numbers per point, all 0 over load, unload and reload", numbers));
  if (!lasts && some_values_remember(law)) return fine("forgotten with these values, kept with others");
  if (!lasts)
    return fails(
        "what it keeps is forgotten: over load, unload and reload each answer, and what is kept after it, are those of "
        "a law that has seen nothing");
  return fine(fmt::format("{} number{} per point, the whole of what lasts over load, unload and reload", numbers,
                          numbers == 1 ? "" : "s"));
}

namespace {

/// One instant of a slow or a fast cycle at one point.
struct Instant {
  double depth = 0, way = 0;      // m, and since the instant before
  double speed = 0, time = 0;     // m/s along the depth, and s since the instant before
  double effort = 0, mean = 0;    // N, and of the two instants where the law knows one
  double dissipation = 0;         // W
  double damper = 0;              // W, what the effort beyond that at rest takes
  double stored = 0, before = 0;  // J
  bool answered = true;
};

struct Cycle {
  double most = 0;  // J: what the deepest push could do
  std::vector<Instant> instants;
};

constexpr int parts = 200;  // of each way
constexpr double of_trapezium = 2.0 / parts;

Cycle cycle(LawBench& bench, int side, double speed) {
  const double layer = bench.layer(), far = depths_of(bench).back() + layer;
  Cycle cycle;
  // The first touch alone is no scale of it.
  cycle.most = std::abs(at_point(bench, side, far - layer, speed, far - layer).effort) * far;
  bench.remember(true);
  Instant last;
  last.depth = -layer;
  for (const double turn : turns) {
    const double from = last.depth + layer;
    for (int k = 1; k <= parts; ++k) {
      Instant now;
      now.depth = from + (turn * far - from) * k / parts - layer;
      now.way = now.depth - last.depth;
      now.speed = speed == 0 ? 0 : std::copysign(speed, now.way);
      now.time = speed == 0 ? 0 : std::abs(now.way) / speed;
      const std::vector<double> kept = bench.memory();
      if (now.speed != 0) now.damper = -std::abs(at_point(bench, side, now.depth, 0, last.depth).effort);
      bench.keep(kept);
      const PointAnswer here = at_point(bench, side, now.depth, side * now.speed, last.depth);
      now.answered = here.answered;
      now.effort = std::abs(here.effort);
      now.damper = now.speed != 0 ? (now.effort + now.damper) * now.speed : 0;
      now.mean = bench.law().reads() == Evaluation::conserving ? now.effort : 0.5 * (now.effort + last.effort);
      now.dissipation = here.dissipation;
      now.stored = bench.law().potential(bench.state(side, now.depth));
      now.before = last.stored;
      cycle.instants.push_back(now);
      last = now;
    }
  }
  bench.remember(false);
  return cycle;
}

// What is wrong with a cycle, "" when nothing.
std::string energies_of(const Cycle& cycle) {
  constexpr double nothing = 1e-9;  // of a difference of energies
  double unanswered = 0, at = 0;    // since when it has not pushed, and what it held then
  for (const Instant& now : cycle.instants) {
    if (!now.answered || !(now.stored >= 0))
      return fmt::format("stores {:g} J at a depth of {:g} m", now.stored, now.depth);
    const double more = now.stored - now.before, work = now.mean * now.way;
    if (!(more <= work + of_trapezium * cycle.most))
      return fmt::format("stores {:g} J more from a depth of {:g} to {:g} m; its force took {:g} J", more,
                         now.depth - now.way, now.depth, work);
    if (now.effort != 0)
      unanswered = 0;
    else if (now.stored > unanswered)
      unanswered = now.stored, at = now.depth;
    const bool turns_back = &now == &cycle.instants.back() || (&now)[1].way * now.way < 0;
    if (turns_back && now.way < 0 && unanswered > nothing * cycle.most)
      return fmt::format("stores {:g} J at a depth of {:g} m, where it has let go: no force gives that back",
                         unanswered, at);
  }
  return {};
}

std::string dissipation_of(const Cycle& cycle) {
  double reported = 0, lost = 0, largest = 0;
  for (const Instant& now : cycle.instants) largest = std::max(largest, now.effort * std::abs(now.speed));
  for (const Instant& now : cycle.instants) {
    const auto says = [&](const std::string& wrong) {
      return fmt::format("reports {:g} W dissipated at a depth of {:g} m and {:g} m/s{}", now.dissipation, now.depth,
                         now.speed, wrong);
    };
    if (!(now.dissipation >= -1e-9 * largest) || !std::isfinite(now.dissipation))
      return says(": a law may only take energy");
    if (now.speed == 0 && now.dissipation != 0) return says(": what does not move has no power");
    if (!(now.dissipation >= now.damper - 1e-6 * largest))
      return says(fmt::format("; its force beyond that at rest takes {:g} W", now.damper));
    reported += now.dissipation * now.time;
    lost += now.mean * now.way - (now.stored - now.before);
  }
  if (!(reported <= lost + of_trapezium * cycle.most * static_cast<double>(turns.size())))
    return fmt::format("reports {:g} J dissipated over load, unload and reload, of {:g} J lost", reported, lost);
  return {};
}

Verdict over_cycles(const Law& law, std::string (*wrong)(const Cycle&), const char* right) {
  LawBench bench(law, 1, 1);
  for (const int side : {-1, 1})
    for (const double speed : {0.0, 0.5})
      if (std::string sentence = wrong(cycle(bench, side, speed)); !sentence.empty()) return fails(sentence);
  return fine(right);
}

}  // namespace

Verdict stores_what_it_gives_back(const Law& law) {
  return over_cycles(law, energies_of,
                     "over load, unload and reload it stores no more than it was given, and gives it back");
}

Verdict dissipates_what_is_lost(const Law& law) {
  return over_cycles(law, dissipation_of, "over load, unload and reload no less than a damper's, no more than is lost");
}

}  // namespace ricochet::checking
