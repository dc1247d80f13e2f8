#include "runners/kinds/sweep/case_workers.hpp"

#include "runners/march/prepare_case.hpp"

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
  at_work_ = 1;
  arena_.execute([&] {
    CaseWorker first;
    work(first);
    group_.wait();
  });
  if (failure_) std::rethrow_exception(failure_);
  return seconds_;
}

void CaseWorkers::call(int most) {
  for (int i = 0; seats_ && i < most && seats_->take(); ++i) {
    ++at_work_;
    group_.run([this] {
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
