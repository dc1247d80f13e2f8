#include "runners/workers/lost_worker.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <stdexcept>

#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

/// The process waits for a signal that nobody will send, and so would the next one.
bool stopped_itself(const WorkerEnd& end) {
  return end.stopped && end.in_third_party();
}

}  // namespace

Lost ended_for_nonsense(Worker& worker) {
  worker.kill();
  Lost lost{worker.end(), {}};
  if (!lost.end.host_lost) lost.end.cause = "this program: what it said was no message";
  return lost;
}

void check_ready(const WorkerReady& ready, const std::string& host, const std::string& identity,
                 const std::string& arithmetic) {
  if (!ready.failure.empty() && !ready.pointer.empty()) throw InputError(ready.pointer, ready.failure);
  if (!ready.failure.empty())
    throw std::runtime_error(fmt::format("a worker on {} did not open the study: {}", host, ready.failure));
  if (ready.identity != identity)
    throw std::runtime_error(
        fmt::format("a worker on {} has another program or other plugins than this process", host));
  if (ready.arithmetic != arithmetic)
    throw std::runtime_error(
        fmt::format("{} computes other last digits than this machine (another processor or C library): a study's "
                    "results come from one arithmetic. Ask the scheduler for nodes of one kind (--constraint)",
                    host));
}

double longest_call_of(const StudyCase& study_case) {
  constexpr double longest = 60;
  const double budget = budget_of(study_case);
  return std::isfinite(budget) ? budget : longest;
}

double longest_stop_of(const StudyCase* study_case) {
  return study_case ? std::min(lost_after, longest_call_of(*study_case)) : lost_after;
}

bool over_budget(const Lost& lost, const StudyCase& study_case) {
  return lost.given_up && std::isfinite(budget_of(study_case));
}

bool failed_by(const Lost& lost, const StudyCase& study_case, int& attempt) {
  constexpr int attempts = 2;
  if (lost.end.host_lost) return false;
  return over_budget(lost, study_case) || stopped_itself(lost.end) || attempt++ == attempts;
}

std::string sentence(const Lost& lost, const StudyCase& study_case) {
  if (!lost.given_up) return lost.end.sentence(stopped_itself(lost.end) ? "" : "twice");
  const GivenUp& call = *lost.given_up;
  if (over_budget(lost, study_case))
    return fmt::format("plugin {} did not return from {}() within the budget of {:g} s", call.plugin, call.function,
                       call.budget);
  return fmt::format("plugin {} did not return from {}() within {:g} s; its process was ended twice", call.plugin,
                     call.function, call.budget);
}

}  // namespace ricochet
