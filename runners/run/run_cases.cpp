#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <set>

#include "runners/march/prepare_case.hpp"
#include "runners/run/alike_cases.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

// One of cases that are alike is planned; where that tells nothing (it may be refused), a few more.
constexpr std::size_t most_tried = 16;

// What waits, shared by the threads that work on it; one that was given up may look at it until the program ends.
class CaseQueue {
 public:
  explicit CaseQueue(std::vector<PendingCase> pending) : pending_(std::move(pending)) {}

  std::optional<std::size_t> take() {
    const std::lock_guard guard(mutex_);
    if (!again_.empty()) {
      const std::size_t one = again_.front();
      again_.pop_front();
      return one;
    }
    while (next_ < pending_.size() && settled_.count(pending_[next_].study_case->id) != 0) ++next_;
    return next_ < pending_.size() ? std::optional(next_++) : std::nullopt;
  }
  const PendingCase& operator[](std::size_t i) const { return pending_[i]; }
  std::optional<std::size_t> find(const std::string& id) const {
    for (std::size_t i = 0; i < pending_.size(); ++i)
      if (pending_[i].study_case->id == id) return i;
    return std::nullopt;
  }
  /// Whether the row of a case is still to be made; from now on it is not.
  bool settle(const std::string& id) {
    const std::lock_guard guard(mutex_);
    return settled_.insert(id).second;
  }
  void put_back(std::size_t i) {
    const std::lock_guard guard(mutex_);
    again_.push_back(i);
  }
  int settled() const {
    const std::lock_guard guard(mutex_);
    return static_cast<int>(settled_.size());
  }
  void fail(std::exception_ptr failure) {
    const std::lock_guard guard(mutex_);
    if (!failure_) failure_ = std::move(failure);
  }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  const std::vector<PendingCase> pending_;
  mutable std::mutex mutex_;
  std::size_t next_ = 0;
  std::deque<std::size_t> again_;
  std::set<std::string> settled_;
  std::exception_ptr failure_;
};

TicketPointer ticket_of(const PendingCase& one) {
  return std::make_shared<CaseTicket>(one.study_case->id, one.fingerprint, budget_of(*one.study_case));
}

void work(CaseQueue& queue, const StudyRunner& runner, std::atomic<bool>& stop, const CaseEvents& events) {
  bool announced = false;
  for (std::optional<std::size_t> at = queue.take(); at && !stop;) {
    const PendingCase& one = queue[*at];
    const TicketPointer ticket = ticket_of(one);
    const CaseScope scope(ticket);
    try {
      if (!announced) events.begins(one);
      const CaseRecord record = run_guarded(runner, *one.study_case, stop);
      const auto turn = ticket->turn();
      ticket->close();
      at = stop ? std::nullopt : queue.take();
      if (queue.settle(record.id)) events.finished(record, at ? &queue[*at] : nullptr);
      announced = true;
    } catch (const Interrupted&) {
      return;
    } catch (...) {
      queue.fail(std::current_exception());
      stop = true;
      return;
    }
  }
}

}  // namespace

CaseRecord run_guarded(const StudyRunner& runner, const StudyCase& study_case, const std::atomic<bool>& stop) {
  CaseRecord record;
  const auto fail = [&](std::string reason) {
    record = CaseRecord{};
    record.status = "failed";
    record.reason = std::move(reason);
  };
  try {
    record = runner.cases.run(study_case, stop);
  } catch (const Interrupted&) {
    throw;
  } catch (const InputError& error) {
    fail(error.pointer().empty() ? error.what() : fmt::format("at {}: {}", error.pointer(), error.what()));
  } catch (const std::bad_alloc&) {
    fail("not enough memory");
  } catch (const std::exception& error) {
    fail(error.what());
  } catch (const Refusal& refusal) {
    fail(refusal.sentence);
  } catch (...) {
    fail("an exception that carries no message");
  }
  record.id = study_case.id;
  record.axes = study_case.axes;
  return record;
}

CaseRecord given_up_record(const StudyCase& study_case, const LongCall& call) {
  CaseRecord record;
  record.id = study_case.id;
  record.axes = study_case.axes;
  record.status = "failed";
  record.reason = fmt::format("plugin {} did not return from {}() within the budget of {:g} s", call.plugin,
                              call.function, call.ticket->budget);
  return record;
}

int run_cases(const StudyRunner& runner, std::vector<PendingCase> pending, int jobs, std::atomic<bool>& stop,
              const CaseEvents& events) {
  // Of very many cases those that cost the same run in the order of their ids: the store keeps them in it, and what
  // ends together then stands together there, and not each case in pages of its own that are written anew.
  const bool by_id = pending.size() > 2000;
  std::stable_sort(pending.begin(), pending.end(), [&](const PendingCase& a, const PendingCase& b) {
    if (a.predicted_seconds != b.predicted_seconds) return a.predicted_seconds > b.predicted_seconds;
    return by_id && a.study_case->id < b.study_case->id;
  });
  const int threads = std::max(1, std::min(jobs, static_cast<int>(pending.size())));
  const auto queue = std::make_shared<CaseQueue>(std::move(pending));
  WatchHooks hooks;
  hooks.waiting = events.waiting;
  hooks.left_behind = events.left_behind;
  hooks.given_up = [&](const LongCall& call, const TicketPointer& worker) {
    try {
      // Where its thread worked for another case, that one is to blame, and the thread's own begins anew.
      const auto own = queue->find(worker->id), blamed = queue->find(call.ticket->id);
      const std::size_t failed = blamed ? *blamed : *own;
      const StudyCase& study_case = *(*queue)[failed].study_case;
      if (queue->settle(study_case.id)) events.finished(given_up_record(study_case, call), nullptr);
      if (own && *own != failed) queue->put_back(*own);
    } catch (...) {
      queue->fail(std::current_exception());
      stop = true;
    }
  };
  // TBB's own limit is the number of processors; --jobs may ask for more. A case may use what the others leave.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(std::max(1, jobs)));
  run_watched(
      threads, [queue, &runner, &stop, &events] { work(*queue, runner, stop, events); }, stop, hooks);
  queue->rethrow();
  return queue->settled();
}

std::vector<CaseRecord> predict_cases(const StudyRunner& runner, std::vector<PendingCase>& pending, int jobs,
                                      const std::atomic<bool>& stop, const CaseEvents& events) {
  struct Predictions {
    std::vector<PendingCase> cases;
    std::vector<std::vector<std::size_t>> alike;  // which, in the study's order
    std::atomic<std::size_t> next{0};
  };
  const auto all = std::make_shared<Predictions>();
  all->cases = pending;
  InOrderMet<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < pending.size(); ++i) groups[cost_key(*pending[i].study_case)].push_back(i);
  for (auto& [key, alike] : std::move(groups).list()) all->alike.push_back(std::move(alike));
  std::vector<CaseRecord> failed;
  WatchHooks hooks;
  hooks.waiting = events.waiting;
  hooks.left_behind = events.left_behind;
  hooks.given_up = [&](const LongCall& call, const TicketPointer&) {
    for (const PendingCase& one : pending)
      if (one.study_case->id == call.ticket->id) failed.push_back(given_up_record(*one.study_case, call));
  };
  run_watched(
      std::max(1, std::min(jobs, static_cast<int>(all->alike.size()))),
      [all, &runner, &stop] {
        for (std::size_t group = all->next++; group < all->alike.size() && !stop; group = all->next++) {
          const std::vector<std::size_t>& alike = all->alike[group];
          double seconds = 0;
          for (std::size_t k = 0; k < std::min(alike.size(), most_tried) && seconds == 0 && !stop; ++k) {
            const PendingCase& one = all->cases[alike[k]];
            const TicketPointer ticket = ticket_of(one);
            const CaseScope scope(ticket);
            try {
              seconds = std::max(0.0, runner.plan(*one.study_case).predicted_seconds);
            } catch (...) {
              // A prediction that cannot be made says nothing about the case: running it will.
            }
            const auto turn = ticket->turn();
            ticket->close();
          }
          for (const std::size_t i : alike) all->cases[i].predicted_seconds = seconds;
        }
      },
      stop, hooks);
  std::vector<PendingCase> left;
  for (const PendingCase& one : all->cases)
    if (std::none_of(failed.begin(), failed.end(),
                     [&](const CaseRecord& record) { return record.id == one.study_case->id; }))
      left.push_back(one);
  pending = std::move(left);
  return failed;
}

}  // namespace ricochet
