#include "runners/march/march_pace.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

// Without the first ones, which meet cold caches.
constexpr long long few_steps = 400, first_steps = 16, chunk = 32;
// A step that sees less of the support's motion meets other contacts.
constexpr double steps_per_period = 200;
// Contacts of a coarse step take a larger share of the steps: where there is time for so many times as many, they are
// made. A march that leaves out steps is tried on ever finer ones, to see how its time grows.
constexpr double worth_refining = 4, refinement = 8;
constexpr int most_parts = 5;
// How the time of a march that leaves out steps grows with their number n, as n^p: in contact it may be n, and less
// than this it was nowhere.
constexpr double least_growth = 0.15, most_growth = 1;

struct Part {
  double seconds = 0;
  long long steps = 0, of = 0;  ///< marched, and those of the whole
  bool standing = false;        ///< no lane stopped on the way
  bool flies = false;           ///< steps are left out
  double step_seconds() const { return seconds / static_cast<double>(steps); }
  double whole_seconds() const { return step_seconds() * static_cast<double>(of); }
};

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
    double growth = most_growth;
    for (int made = 1; made < most_parts && part->of < steps_ && part->seconds < long_enough_; ++made) {
      const double finer = part->flies ? refinement : long_enough_ / part->seconds;
      if (finer < worth_refining) break;
      const auto next = march(std::max(case_.step, case_.duration / (finer * static_cast<double>(part->of))));
      if (!next || !next->standing) break;
      growth = std::log(next->whole_seconds() / part->whole_seconds()) /
               std::log(static_cast<double>(next->of) / static_cast<double>(part->of));
      part = next;
      if (!part->flies) break;
    }
    if (!part->flies) return part->step_seconds();
    const double longer = static_cast<double>(steps_) / static_cast<double>(part->of);
    return part->whole_seconds() * std::pow(longer, std::clamp(growth, least_growth, most_growth)) /
           static_cast<double>(steps_);
  }

 private:
  /// The largest step that stands for the case's own, s.
  double coarsest_step() const {
    const double pulsation = case_.scene.support.pulsation;
    const double few = case_.duration / static_cast<double>(few_steps);
    return pulsation > 0 ? std::min(few, 2 * std::numbers::pi / (pulsation * steps_per_period)) : few;
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
    if (prepared.steps > few_steps / 2) marcher.march(first_steps, observer.get());
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
