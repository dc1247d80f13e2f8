#include "runners/kinds/sweep/case_workers.hpp"

#include "runners/march/seconds.hpp"

namespace ricochet {

CaseWorkers::CaseWorkers(ThreadSeats* seats) : seats_(seats), arena_(seats ? seats->count() : 1) {}

void CaseWorkers::work(CaseWorker& worker) {
  const CaseScope scope(ticket_);
  const double began = thread_seconds();
  std::exception_ptr thrown;
  try {
    work_(worker);
  } catch (...) {
    thrown = std::current_exception();
  }
  const std::lock_guard guard(mutex_);
  seconds_ += thread_seconds() - began;
  if (thrown) failure_ = thrown;
}

double CaseWorkers::run(const std::function<void(CaseWorker&)>& work_of_one) {
  work_ = work_of_one;
  ticket_ = current_ticket();
  seconds_ = 0;
  at_work_.store(1, std::memory_order_release);
  arena_.execute([&] {
    CaseWorker first;
    work(first);
    group_.wait();
  });
  const std::lock_guard guard(mutex_);
  if (failure_) std::rethrow_exception(failure_);
  return seconds_;
}

void CaseWorkers::call(int most) {
  for (int i = 0; seats_ && i < most && seats_->take(); ++i) {
    ++at_work_;
    group_.run([this] {
      // What the caller wrote is seen by this, and not only by what the library does to start a task.
      static_cast<void>(at_work_.load(std::memory_order_acquire));
      CaseWorker worker;
      worker.seats_ = seats_;
      worker.joined_ = true;
      work(worker);
      --at_work_;
      if (worker.seated_) seats_->leave();
    });
  }
}

void CaseWorkers::without_seat(const std::function<void()>& wait) {
  if (seats_) seats_->leave();
  wait();
  if (seats_) seats_->sit();
}

}  // namespace ricochet
