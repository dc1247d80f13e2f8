#include "runners/march/march_pace.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

// Without the first ones, which meet cold caches.
constexpr long long few_steps = 400, first_steps = 16, chunk = 32;
// A step that sees less of the support's motion meets other contacts.
constexpr double steps_per_period = 200;
// Contacts of a coarse step take a larger share of the steps: where there is time for so many times as many, they are
// made. A march that leaves out steps is tried on ever finer ones, to see how its visits grow.
constexpr double worth_refining = 4, refinement = 8;
constexpr int most_parts = 5;
// Visits that only look ahead grow with the number n of steps as n^p, as measured from 1e2 to 1e6 steps per flight.
constexpr double looking_growth = 0.17;

struct Part {
  double seconds = 0;
  long long steps = 0, of = 0;      ///< marched, and those of the whole
  long long visited = 0, held = 0;  ///< of those marched: not left out; left out in contact
  bool standing = false;            ///< no lane stopped on the way
  bool flies = false;               ///< steps are left out
  bool whole() const { return standing && steps == of; }
};

/// p n^looking_growth + q n.
struct VisitGrowth {
  double p = 0, q = 0;
  double at(double n) const { return p * std::pow(n, looking_growth) + q * n; }
};

VisitGrowth growth_through(const Part& coarse, const Part& fine) {
  const auto m = static_cast<double>(coarse.of), n = static_cast<double>(fine.of);
  const auto u = static_cast<double>(coarse.visited), v = static_cast<double>(fine.visited);
  const double mp = std::pow(m, looking_growth), np = std::pow(n, looking_growth);
  const double determinant = mp * n - np * m;
  VisitGrowth found{(u * n - v * m) / determinant, (v * mp - u * np) / determinant};
  if (found.p < 0) found = {0, v / n};
  if (found.q < 0) found = {v / np, 0};
  return found;
}

/// Seconds of a visit, and of a step that is left out in contact.
struct Costs {
  double visit = 0, held = 0;
};

// Least squares of the relative misfit, weighed with the time that each part took.
Costs costs_of(const std::vector<Part>& parts) {
  double vv = 0, vh = 0, hh = 0, vt = 0, ht = 0;
  for (const Part& part : parts) {
    if (part.seconds <= 0) continue;
    const auto v = static_cast<double>(part.visited), h = static_cast<double>(part.held);
    vv += v * v / part.seconds;
    vh += v * h / part.seconds;
    hh += h * h / part.seconds;
    vt += v;
    ht += h;
  }
  const Costs visits{vv > 0 ? vt / vv : 0, 0};
  const double determinant = vv * hh - vh * vh;
  if (determinant <= 1e-9 * vv * hh) return visits;
  const Costs both{(vt * hh - ht * vh) / determinant, (ht * vv - vt * vh) / determinant};
  if (both.held < 0) return visits;
  return both.visit < 0 ? Costs{0, ht / hh} : both;
}

class Pace {
 public:
  Pace(const StudyCase& study_case, const Registry& registry, const MakeObserver& observe, double seconds)
      : case_(study_case),
        registry_(registry),
        observe_(observe),
        long_enough_(seconds),
        steps_(std::llround(std::min(study_case.duration / study_case.step, 1e15))) {}

  std::optional<double> found() {
    const double coarse = std::max(case_.step, coarsest_step());
    std::optional<Part> part = march(coarse);
    if (coarse > case_.step && (!part || !part->standing)) part = march(case_.step);
    if (!part) return std::nullopt;
    std::vector<Part> parts{*part};
    while (parts.size() < most_parts && part->of < steps_ && part->seconds < long_enough_) {
      const double finer = part->flies ? refinement : long_enough_ / part->seconds;
      if (finer < worth_refining) break;
      part = march(std::max(case_.step, case_.duration / (finer * static_cast<double>(part->of))));
      if (!part || !part->standing) break;
      parts.push_back(*part);
      if (!part->flies) break;
    }
    const Part& last = parts.back();
    return last.flies ? flown(parts) : last.seconds / static_cast<double>(last.steps);
  }

 private:
  /// The largest step that stands for the case's own, s.
  double coarsest_step() const {
    const double pulsation = case_.scene.support.pulsation;
    const double few = case_.duration / static_cast<double>(few_steps);
    return pulsation > 0 ? std::min(few, 2 * std::numbers::pi / (pulsation * steps_per_period)) : few;
  }

  /// A step of the case, where steps are left out: by its visits and its steps in contact, whose numbers the finest
  /// marches of the whole duration tell. A march that was cut off may not have seen the contact that comes later: it
  /// tells what they cost.
  double flown(const std::vector<Part>& parts) const {
    const auto n = static_cast<double>(steps_);
    std::vector<Part> whole;
    std::copy_if(parts.begin(), parts.end(), std::back_inserter(whole), [](const Part& part) { return part.whole(); });
    if (whole.empty()) return parts.back().seconds / static_cast<double>(parts.back().steps);
    const Part& finest = whole.back();
    const double longer = n / static_cast<double>(finest.of);
    const double visited = whole.size() > 1 ? growth_through(whole[whole.size() - 2], finest).at(n)
                                            : longer * static_cast<double>(finest.visited);
    const Costs costs = costs_of(parts);
    return (costs.visit * visited + costs.held * longer * static_cast<double>(finest.held)) / n;
  }

  /// As much of the march on this step as is long enough. Its operator is chosen by the steps of the whole case.
  std::optional<Part> march(double step) const {
    StudyCase other = case_;
    other.step = step;
    Prepared prepared = prepare_case(other, registry_, steps_);
    if (!prepared.program) return std::nullopt;
    Marcher marcher(std::move(*prepared.program));
    const std::shared_ptr<StepObserver> observer = observe_ ? observe_(other, marcher, prepared.steps) : nullptr;
    marcher.start(observer.get());
    Part part;
    part.of = prepared.steps;
    part.flies = marcher.program().flight != nullptr;
    if (prepared.steps > few_steps / 2 && !part.flies) marcher.march(first_steps, observer.get());
    // Flights end where the case is sampled.
    const long long few = part.flies ? std::max(chunk, prepared.steps / std::max(1, case_.samples)) : chunk;
    const long long before = marcher.step();
    const double start = thread_seconds();
    double now = start;
    while (marcher.step() < prepared.steps && marcher.any_running() && now - start < long_enough_) {
      marcher.march(std::min(few, prepared.steps - marcher.step()), observer.get());
      now = thread_seconds();
    }
    if (marcher.step() <= before) return std::nullopt;
    part.standing = marcher.any_running();
    part.steps = marcher.step() - before;
    part.visited = marcher.steps_visited();
    part.held = marcher.steps_held();
    part.seconds = now - start;
    return part;
  }

  const StudyCase& case_;
  const Registry& registry_;
  const MakeObserver& observe_;
  const double long_enough_;  // s
  const long long steps_;
};

}  // namespace

std::optional<double> march_pace(const StudyCase& study_case, const Registry& registry, const MakeObserver& observe,
                                 double seconds) {
  return Pace(study_case, registry, observe, seconds).found();
}

}  // namespace ricochet
