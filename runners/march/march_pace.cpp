#include "runners/march/march_pace.hpp"

#include <algorithm>
#include <cmath>

#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

// Without the first ones, which meet cold caches.
constexpr long long few_steps = 400, first_steps = 16, chunk = 32;
constexpr double long_enough = 0.01;  // s
// Contacts of a coarse step take a larger share of the steps: where there is time for so many times as many, they are
// made.
constexpr double worth_refining = 4;
// Of a march that leaves out steps: how the time of the whole grows with the number of steps, between 0.15 and 0.4 on
// the beams of bench_flight.
constexpr double flown_growth = 0.35;

struct Part {
  double step_seconds = 0;
  long long steps = 0;
  bool whole = false;  ///< no lane stopped on the way
  bool flies = false;  ///< steps are left out
};

// `steps`: of the whole case, by which its operator is chosen.
std::optional<Part> march_part(const StudyCase& study_case, long long steps, const Registry& registry,
                               const MakeObserver& observe) {
  Prepared prepared = prepare_case(study_case, registry, steps);
  if (!prepared.program) return std::nullopt;
  Marcher marcher(std::move(*prepared.program));
  const std::shared_ptr<StepObserver> observer = observe ? observe(marcher) : nullptr;
  marcher.start(observer.get());
  Part part;
  part.flies = marcher.program().flight != nullptr;
  if (prepared.steps > few_steps / 2) marcher.march(first_steps, observer.get());
  const long long before = marcher.step();
  const double start = thread_seconds();
  double now = start;
  while (marcher.step() < prepared.steps && marcher.any_running() && now - start < long_enough) {
    marcher.march(std::min(part.flies ? prepared.steps : chunk, prepared.steps - marcher.step()), observer.get());
    now = thread_seconds();
  }
  part.whole = marcher.any_running();
  part.steps = marcher.step() - before;
  if (marcher.step() > before) part.step_seconds = (now - start) / static_cast<double>(marcher.step() - before);
  return part;
}

}  // namespace

std::optional<double> march_pace(const StudyCase& study_case, const Registry& registry, const MakeObserver& observe) {
  const auto steps = std::llround(std::min(study_case.duration / study_case.step, 1e15));
  StudyCase coarse = study_case;
  coarse.step = std::max(study_case.step, study_case.duration / static_cast<double>(few_steps));
  std::optional<Part> part = march_part(coarse, steps, registry, observe);
  if (coarse.step > study_case.step && (!part || !part->whole)) {
    StudyCase beginning = study_case;
    beginning.duration = std::min(study_case.duration, study_case.step * static_cast<double>(few_steps));
    part = march_part(beginning, steps, registry, observe);
  }
  if (!part) return std::nullopt;
  if (coarse.step > study_case.step && part->whole && part->step_seconds > 0) {
    StudyCase finer = study_case;
    finer.step = std::max(study_case.step, study_case.duration * part->step_seconds / long_enough);
    if (finer.step * worth_refining < coarse.step)
      if (const auto found = march_part(finer, steps, registry, observe); found && found->whole) part = found;
  }
  if (!part->flies || part->steps <= 0 || steps <= part->steps) return part->step_seconds;
  const double longer = static_cast<double>(steps) / static_cast<double>(part->steps);
  return part->step_seconds * std::pow(longer, flown_growth) / longer;
}

}  // namespace ricochet
