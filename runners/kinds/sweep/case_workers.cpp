#include "runners/kinds/sweep/case_workers.hpp"

#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <exception>
#include <mutex>

#include "runners/march/case_watch.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {

double run_workers(int workers, const std::function<void(int)>& work) {
  std::mutex mutex;
  std::exception_ptr failure;
  double seconds = 0;
  const TicketPointer ticket = current_ticket();
  const auto body = [&](int worker) {
    const CaseScope scope(ticket);
    const double began = thread_seconds();
    std::exception_ptr thrown;
    try {
      work(worker);
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard guard(mutex);
    seconds += thread_seconds() - began;
    if (thrown) failure = thrown;
  };
  tbb::task_arena arena(workers);
  arena.execute([&] {
    tbb::task_group group;
    for (int worker = 1; worker < workers; ++worker) group.run([&body, worker] { body(worker); });
    body(0);
    group.wait();
  });
  if (failure) std::rethrow_exception(failure);
  return seconds;
}

}  // namespace ricochet
