#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <ricochet/contract/errors.hpp>

#include "runners/execution/study_runner.hpp"

namespace ricochet {

CaseRecord run_guarded(const StudyRunner& runner, const StudyCase& study_case, const std::atomic<bool>& stop) {
  CaseRecord record;
  const auto fail = [&](std::string reason) {
    record = CaseRecord{};
    record.status = "failed";
    record.reason = std::move(reason);
  };
  try {
    record = runner.run(study_case, stop);
  } catch (const Interrupted&) {
    throw;
  } catch (const InputError& error) {
    fail(error.pointer().empty() ? error.what() : fmt::format("at {}: {}", error.pointer(), error.what()));
  } catch (const std::bad_alloc&) {
    fail("not enough memory");
  } catch (const std::exception& error) {
    fail(error.what());
  } catch (...) {
    fail("an exception that carries no message");
  }
  record.id = study_case.id;
  record.axes = study_case.axes;
  return record;
}

int run_cases(const StudyRunner& runner, std::vector<PendingCase> pending, int jobs, std::atomic<bool>& stop,
              const std::function<void(const PendingCase&)>& started,
              const std::function<void(const CaseRecord&)>& finished) {
  std::stable_sort(pending.begin(), pending.end(), [](const PendingCase& a, const PendingCase& b) {
    return a.predicted_seconds > b.predicted_seconds;
  });
  std::atomic<std::size_t> next{0};
  std::atomic<int> done{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < pending.size() && !stop; i = next++) {
        started(pending[i]);
        finished(run_guarded(runner, *pending[i].study_case, stop));
        ++done;
      }
    } catch (const Interrupted&) {
    } catch (...) {
      const std::lock_guard guard(failure_mutex);
      if (!failure) failure = std::current_exception();
      stop = true;
    }
  };
  const int threads = std::max(1, std::min(jobs, static_cast<int>(pending.size())));
  // TBB's own limit is the number of processors; --jobs may ask for more. A case may use what the others leave.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(std::max(1, jobs)));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::task_group group;
    for (int i = 1; i < threads; ++i) group.run(work);
    work();
    group.wait();
  });
  if (failure) std::rethrow_exception(failure);
  return done;
}

}  // namespace ricochet
