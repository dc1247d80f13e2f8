#pragma once
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>

#include "runners/march/case_watch.hpp"
#include "runners/march/thread_seats.hpp"

namespace ricochet {

/// A thread that works for a case.
class CaseWorker {
 public:
  /// Whether it joined the thread that runs the case: it may leave while there is work.
  bool joined() const { return joined_; }
  /// Whether its seat is wanted for a thread that runs a case: then it has left it, and returns.
  bool gives_way() {
    if (joined_ && seated_ && seats_->give_way()) seated_ = false;
    return joined_ && !seated_;
  }

 private:
  friend class CaseWorkers;
  ThreadSeats* seats_ = nullptr;
  bool joined_ = false, seated_ = true;
};

/// The threads that work for one case: the one that runs it, which has its seat, and those that join it where seats are
/// free.
class CaseWorkers {
 public:
  /// `seats`: null: the thread that runs the case alone.
  explicit CaseWorkers(ThreadSeats* seats);

  /// Runs the work on this thread, and on others that are called by it; returns the processor seconds of all. What one
  /// of them throws is thrown when all have returned. A worker must not count on the others: fewer may come.
  double run(const std::function<void(CaseWorker&)>& work);
  /// From within the work: lets up to so many others join.
  void call(int most);
  /// Threads that work for the case, and could.
  int could_work() const { return at_work_ + (seats_ ? seats_->free() : 0); }
  /// Waits, without its seat, for as long as `wait` takes.
  void without_seat(const std::function<void()>& wait);

 private:
  void work(CaseWorker& worker);

  ThreadSeats* seats_;
  tbb::task_arena arena_;
  tbb::task_group group_;
  std::function<void(CaseWorker&)> work_;
  TicketPointer ticket_;
  std::mutex mutex_;
  std::exception_ptr failure_;
  double seconds_ = 0;
  std::atomic<int> at_work_{0};
};

}  // namespace ricochet
