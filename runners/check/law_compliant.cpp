#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runners/check/law_checks.hpp"

namespace ricochet::checking {
namespace {

constexpr std::array sides = {-1, 1};
// Two measures of 0.02 m that near are the same one, m.
constexpr double smallest = 1e-12;
const char* side_name(int side) {
  return side < 0 ? "lower" : "upper";
}

bool reads_before(const LawBench& bench) {
  return bench.law().reads() == Evaluation::conserving;
}

// From a depth before a step, in contact or without, to each depth after it; the same one where the law does not know.
struct Way {
  double depth = 0, before = 0;
};
std::vector<Way> steps_of(LawBench& bench) {
  std::vector<Way> steps;
  for (const double depth : depths_of(bench)) {
    const double within = depth + bench.layer();
    if (!reads_before(bench)) {
      steps.push_back({depth, depth});
      continue;
    }
    for (const double share : {0.8, 1.1, -0.3, -0.9}) {
      const double other = share * within - bench.layer();
      if (other >= 0 && bench.layer() > 0 && !at_point(bench, -1, other, 0, other).answered) continue;
      steps.push_back({depth, other});
      // And out of contact again.
      if (share < 0) steps.push_back({other, depth});
    }
  }
  return steps;
}

std::vector<double> speeds_of(const LawBench& bench) {
  if (!bench.law().reads_rate()) return {0.0};
  return {0.0, -0.2, 0.2, -2, 2};
}

bool is_compliant(const Law& law) {
  return law.make()->reads().has_value();
}
Verdict rigid() {
  return not_applicable("not a compliant law");
}

constexpr double unanswered = std::numeric_limits<double>::quiet_NaN();

// What one point answers at a given measure, speed and measure before, between the stops of a lane, where the law keeps
// this of it; else `unanswered`.
double answer_at(LawBench& bench, const LaneProblem& lane, Eigen::Index i, double g, double u,
                 const std::vector<double>& kept) {
  const double layer = bench.layer();
  double effort = 0;
  for (const int side : sides) {
    const double stop = side < 0 ? lane.lower[i] - layer : lane.upper[i] + layer;
    const double depth = side * (g - stop), before = side * (lane.before[i] - stop);
    const bool acts = depth > -layer || (reads_before(bench) && before > -layer);
    // What a step leads from one stop to the other, both answer for.
    if (!acts) continue;
    if (!kept.empty()) bench.keep(kept);
    const PointAnswer here = at_point(bench, side, depth, u, before);
    if (!here.answered) return unanswered;
    effort += here.effort;
  }
  return effort;
}

// The same near a measure where the force may jump: p lies between the ends of the jump.
double answer_near(LawBench& bench, const LaneProblem& lane, Eigen::Index i, double g, double u,
                   const std::vector<double>& kept, double p) {
  const double one = answer_at(bench, lane, i, g - smallest, u, kept);
  const double other = answer_at(bench, lane, i, g + smallest, u, kept);
  if (std::isnan(one) || std::isnan(other)) return unanswered;
  return std::clamp(p, std::min(one, other), std::max(one, other));
}

}  // namespace

std::vector<double> depths_of(LawBench& bench) {
  std::vector<double> depths;
  const double layer = bench.layer();
  if (layer > 0)
    for (const double share : {0.9, 0.5, 0.1}) depths.push_back(-share * layer);
  // No corner of a law is likely to lie there.
  for (const double depth : {1.13e-5, 1.13e-4, 1.13e-3, 1.13e-2})
    if (layer == 0 || at_point(bench, -1, depth, 0, depth).answered) depths.push_back(depth);
  return depths;
}

Verdict force_law_is_one(const Law& law) {
  if (!is_compliant(law)) return rigid();
  LawBench bench(law, 1, 1);
  const double layer = bench.layer();
  double most = 0;
  if (!(layer >= 0)) return fails(fmt::format("its layer is {:g} m: it must not be negative", layer));
  for (const int side : sides)
    for (const double speed : speeds_of(bench)) {
      const PointAnswer away = at_point(bench, side, -layer - 1e-3, speed, -layer - 1e-3);
      const double open = away.effort;
      if (!away.answered)
        return fails("it has no finite force, or says that it did not converge, of a point that touches nothing");
      if (open != 0)
        return fails(fmt::format("{:g} N where the point is 1 mm away from the {} stop{} (speed {:g} m/s)", open,
                                 side_name(side), layer > 0 ? "'s layer" : "", speed));
      double last = 0;
      for (const double depth : depths_of(bench)) {
        const PointAnswer here = at_point(bench, side, depth, speed, depth);
        const double p = here.effort;
        if (!here.answered)
          return fails(
              fmt::format("it has no finite force, or says that it did not converge, at a depth of {:g} m", depth));
        if (side * p > 0)
          return fails(
              fmt::format("pulls: {:g} N at the {} stop, depth {:g} m, speed {:g} m/s. A force p > 0 pushes up from "
                          "the lower stop, p < 0 down from the upper one",
                          p, side_name(side), depth, speed));
        if (speed == 0 && !(std::abs(p) >= last * (1 - 1e-9)))
          return fails(fmt::format("the force falls from {:g} to {:g} N as the depth grows to {:g} m", last,
                                   std::abs(p), depth));
        const double mirrored = at_point(bench, -side, depth, -speed, depth).effort;
        if (!(std::abs(p + mirrored) <= 1e-9 * std::abs(p)))
          return fails(fmt::format("{:g} N at the {} stop, {:g} N at the other one in the mirror", p, side_name(side),
                                   mirrored));
        if (speed == 0) last = std::abs(p);
        most = std::max(most, std::abs(p));
      }
    }
  if (most == 0) return fails("no force at all beyond the stop");
  const double p = std::abs(at_point(bench, -1, depths_of(bench).back(), 0, depths_of(bench).back()).effort);
  if (p == 0) return fine(fmt::format("pushes what moves, the same on both sides; {:.4g} N at most", most));
  return fine(fmt::format("pushes, grows with the depth, the same on both sides; {:.4g} N at {:g} m", p,
                          depths_of(bench).back()));
}

Verdict solution_answers_the_force_law(const Law& law) {
  if (!is_compliant(law)) return rigid();
  std::mt19937 random(20240612);
  const double flexibility = flexibility_of(law);
  double worst = 0;
  LawBench one(law, 1, 1);
  // Where no effort moves the measure, a barrier has no answer beyond its stop.
  const bool barrier = is_barrier(one);
  for (const int points : {1, 3, 10}) {
    LawBench bench(law, points, 1);
    bench.remember(true);  // from one touch to the next
    Eigen::VectorXd last;
    for (int k = 0; k < 12; ++k) {
      DenseDelassus W = random_delassus(random, points, flexibility);
      // A law that remembers may note how a point would move without efforts: each is alone.
      if (one.law().memory_per_point() > 0) W = DenseDelassus(W.matrix().diagonal().asDiagonal());
      const std::vector<double> before = bench.memory();
      const double reach = std::array{1.0, 0.25, barrier ? 0.5 : 0.0}[static_cast<std::size_t>(k % 3)];
      const double rate_reach = 10 * reach;
      LaneProblem lane = random_lane(random, points, k % 2 == 1);
      if (barrier) {  // it stood before the stop
        const Eigen::VectorXd most = (lane.upper.array() + 0.5 * one.layer()).matrix();
        lane.before = lane.before.cwiseMax((lane.lower.array() - 0.5 * one.layer()).matrix()).cwiseMin(most);
      }
      if (one.law().memory_per_point() > 0) lane.before = k == 0 ? lane.free : last;
      bench.solve(W, reach, rate_reach, {lane}, {0});
      const Eigen::VectorXd p = bench.effort(0);
      const LaneOutcome& outcome = bench.outcome(0);
      const std::vector<double> after = bench.memory();
      if (!p.allFinite()) return fails(fmt::format("{} points: an effort is not finite", points));
      if (!outcome.converged) return fails(fmt::format("{} points: says that it did not converge", points));
      const Eigen::VectorXd push = W.matrix() * p, g = lane.free + reach * push, u = lane.rate + rate_reach * push;
      last = g;
      double difference = 0, largest = 0;
      for (Eigen::Index i = 0; i < points; ++i) {
        // A law may note what it keeps before it solves or after.
        double nearest = HUGE_VAL, expected = 0;
        for (const auto& kept : {before, after}) {
          const double wanted = answer_near(one, lane, i, g[i], u[i], bench.of_point(kept, i, 0), p[i]);
          if (std::abs(p[i] - wanted) < nearest) nearest = std::abs(p[i] - wanted), expected = wanted;
        }
        if (std::isinf(nearest))
          return fails(
              fmt::format("{} point{}, reach {:g}: the efforts lead to a measure of {:g} m, where the law answers one "
                          "point no force",
                          points, points == 1 ? "" : "s", reach, g[i]));
        difference = std::max(difference, nearest);
        largest = std::max({largest, std::abs(expected), std::abs(p[i])});
      }
      if (!(difference <= 1e-6 * largest + 10 * outcome.residual / flexibility))
        return fails(
            fmt::format("{} point{}, reach {:g}: the efforts found differ by {:.3g} of {:.3g} N from what the law "
                        "answers one point at the measures they lead to. The law states an error of {:.3g} m at most",
                        points, points == 1 ? "" : "s", reach, difference, largest, outcome.residual));
      if (!(outcome.residual <= 1e-4 * 0.02))
        return fails(
            fmt::format("{} points: leaves an error of {:.3g} m in measures of 0.02 m", points, outcome.residual));
      if (largest > 0) worst = std::max(worst, difference / largest);
    }
  }
  return fine(fmt::format("1, 3 and 10 points, one and two stops: p = Φ(g(p)) to {:.1g}", worst));
}

Verdict stiffness_as_declared(const Law& law) {
  if (!is_compliant(law)) return rigid();
  LawBench bench(law, 1, 1);
  const auto stiffness = constant_stiffness(bench.law());
  if (!stiffness) return not_declared("not linear: references and spectra that need one stiffness refuse");
  for (const double depth : {1e-4, 1e-3, 1e-2})
    for (const double speed : speeds_of(bench)) {
      const double p = at_point(bench, -1, depth, speed, depth).effort;
      if (!(std::abs(p - *stiffness * depth) <= 1e-9 * *stiffness * depth))
        return fails(
            fmt::format("declares that its force is {:g} N/m times the depth; at {:g} m and {:g} m/s it is "
                        "{:g} N, not {:g}",
                        *stiffness, depth, speed, p, *stiffness * depth));
    }
  return fine(fmt::format("{:g} N/m", *stiffness));
}

Verdict slopes_are_derivatives(const Law& law) {
  if (!is_compliant(law)) return rigid();
  LawBench bench(law, 1, 1);
  if (!bench.law().offers_slopes()) return not_declared("no slopes: exponents are those of twins");
  const bool remembers = reads_before(bench);
  for (const int side : sides)
    for (const Way& way : steps_of(bench))
      for (const double speed : speeds_of(bench)) {
        const double depth = way.depth, before = way.before;
        const PointAnswer here = at_point(bench, side, depth, speed, before);
        if (here.effort == 0) continue;  // a damper that lets go
        const double dg = 1e-5 * std::abs(depth), du = 1e-5;
        bool lets_go = false;  // within the difference: there is no derivative
        const auto difference = [&](double d, double u, double b) {
          const double ahead = at_point(bench, side, depth + d, speed + u, before + b).effort;
          const double behind = at_point(bench, side, depth - d, speed - u, before - b).effort;
          lets_go = ahead == 0 || behind == 0;
          return ahead - behind;
        };
        // δp = −stiffness δg − viscosity δu − before δg⁻, with g = side · depth.
        const double stiffness = -side * difference(dg, 0, remembers ? 0 : dg) / (2 * dg);
        const double viscosity = bench.law().reads_rate() ? -difference(0, du, 0) / (2 * du) : 0;
        if (lets_go) continue;
        const double backwards = remembers ? -side * difference(0, 0, dg) / (2 * dg) : 0;
        const double size = std::max(std::abs(stiffness), std::abs(here.effort / depth));
        const auto wrong = [&](const char* what, double says, double is) {
          return fmt::format("at a depth of {:g} m and {:g} m/s it says a {} of {:.6g}, differences give {:.6g}", depth,
                             speed, what, says, is);
        };
        if (!(std::abs(here.slopes.stiffness - stiffness) <= 1e-4 * size))
          return fails(wrong("stiffness", here.slopes.stiffness, stiffness));
        if (!(std::abs(here.slopes.before - backwards) <= 1e-4 * size))
          return fails(wrong("slope in the measure before", here.slopes.before, backwards));
        const double damping = std::max(std::abs(viscosity), std::abs(here.effort));
        // A dashpot that acts one way has a corner at rest.
        if (speed != 0 && !(std::abs(here.slopes.viscosity - viscosity) <= 1e-4 * damping))
          return fails(wrong("viscosity", here.slopes.viscosity, viscosity));
      }
  return fine("agree with differences of the force");
}

Verdict potential_stores_the_force(const Law& law) {
  LawBench bench(law, 1, 1);
  if (bench.law().absent()) return not_applicable("the law is the absence of contact");
  if (!bench.law().reads()) {
    for (const double depth : {1e-4, 1e-2})
      if (const double stored = bench.law().potential({.depth = depth}); stored != 0)
        return fails(fmt::format("a rigid law stores nothing; its potential at {:g} m is {:g} J", depth, stored));
    return not_applicable("a rigid law stores nothing");
  }
  if (bench.law().memory_per_point() > 0) return stores_what_it_gives_back(law);
  const auto U = [&](double depth) { return bench.law().potential({.depth = depth}); };
  const bool conserving = bench.law().conserves_energy();
  const double rest = U(-bench.layer());
  for (const double depth : depths_of(bench)) {
    const double stored = U(depth);
    if (!(stored >= 0)) return fails(fmt::format("stores {:g} J at a depth of {:g} m", stored, depth));
    if (!(std::abs(rest) <= 1e-9 * stored)) return fails(fmt::format("stores {:g} J where it begins to act", rest));
    // What is stored is counted from where the law begins to act.
    const double step = conserving ? 0.25 * std::abs(depth) : 1e-5 * std::max(std::abs(depth), bench.layer());
    const double ahead = depth + step, behind = depth - step;
    if (behind < -bench.layer()) continue;
    const double slope = (U(ahead) - U(behind)) / (2 * step);
    const double p =
        conserving ? at_point(bench, -1, ahead, 0, behind).effort : at_point(bench, -1, depth, 0, depth).effort;
    const double tolerance = (conserving ? 1e-8 : 1e-5) * std::max(std::abs(p), std::abs(slope));
    if (!(std::abs(slope - p) <= tolerance))
      return fails(fmt::format("at a depth of {:g} m the force is {:.6g} N, its potential grows by {:.6g} J/m", depth,
                               p, slope));
  }
  return fine("its slope is the force at rest");
}

Verdict energy_over_a_step(const Law& law) {
  LawBench bench(law, 1, 1);
  const bool conserving = bench.law().conserves_energy();
  if (!reads_before(bench)) {
    if (conserving) return fails("declares that it conserves energy, and does not read the measure before the step");
    return not_applicable("it does not know the step, only one measure of it");
  }
  if (bench.law().memory_per_point() > 0) return not_applicable("its force depends on what it remembers");
  const double layer = bench.layer();
  const auto U = [&](double depth) { return depth > -layer ? bench.law().potential({.depth = depth}) : 0.0; };
  double given = 0, kept = 0;
  for (const int side : sides)
    for (const auto& [depth, before] : steps_of(bench)) {
      const PointAnswer here = at_point(bench, side, depth, 0, before);
      const double work = std::abs(here.effort) * (depth - before), stored = U(depth) - U(before);
      if (!here.answered || !std::isfinite(stored))
        return fails(
            fmt::format("force or energy of a step from a depth of {:g} to {:g} m are not finite", before, depth));
      const double share = (stored - work) / std::max(U(depth), U(before));
      given = std::max(given, share);
      kept = std::max(kept, -share);
    }
  // Round-off of a difference of energies over one of depths 1e-1 to 1e-2 of them.
  constexpr double tolerance = 1e-11;
  const double most = std::max(given, kept);
  if (conserving && !(most <= tolerance))
    return fails(
        fmt::format("declares that it conserves energy; over a step it gives or keeps {:.3g} of what is stored", most));
  if (conserving) return fine(fmt::format("p (δ − δ⁻) = U(δ) − U(δ⁻) to {:.1g}", most));
  const auto part = [](const char* does, double share) {
    return share <= tolerance ? fmt::format("{} nothing", does) : fmt::format("{} up to {:.2g}", does, share);
  };
  return not_declared(
      fmt::format("of what is stored at a depth a step {}, and {}", part("gives", given), part("keeps", kept)));
}

Verdict dissipation_is_reported(const Law& law) {
  LawBench bench(law, 1, 1);
  if (!bench.law().reads()) return not_applicable("not a compliant law");
  if (bench.law().memory_per_point() > 0) return dissipates_what_is_lost(law);
  double most = 0;
  for (const int side : sides)
    for (const double depth : depths_of(bench)) {
      const double at_rest = at_point(bench, side, depth, 0, depth).effort;
      for (const double speed : speeds_of(bench)) {
        const PointAnswer here = at_point(bench, side, depth, speed, depth);
        const double taken = -(here.effort - at_rest) * speed;
        const double scale = std::abs(at_rest * speed) + std::abs(taken);
        if (!(taken >= -1e-9 * scale))
          return fails(fmt::format("gives {:.3g} W at a depth of {:g} m and {:g} m/s: a law may only take energy",
                                   -taken, depth, speed));
        if (!(std::abs(here.dissipation - taken) <= 1e-6 * scale))
          return fails(
              fmt::format("reports {:.6g} W dissipated at a depth of {:g} m and {:g} m/s; its force beyond that "
                          "at rest takes {:.6g}",
                          here.dissipation, depth, speed, taken));
        most = std::max(most, taken);
      }
    }
  return fine(most > 0 ? "what its force beyond that at rest takes" : "none");
}

}  // namespace ricochet::checking
