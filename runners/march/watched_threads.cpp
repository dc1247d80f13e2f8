#include "runners/march/watched_threads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "runners/march/seconds.hpp"

namespace ricochet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kLookEvery = std::chrono::milliseconds(250);
constexpr double kLeast = 2;          // s that any call may take
constexpr double kAfterStop = 3;      // s for coming back
constexpr double kAsleepShare = 0.1;  // of the time that passes counts for a thread that only waits

std::atomic<int> left_behind_count{0};

// One call as the watcher follows it.
struct Followed {
  unsigned long long serial = 0;
  Clock::time_point seen;
  double processor = 0;
};

class Watcher {
 public:
  Watcher(int threads, const std::function<void()>& body, const std::atomic<bool>& stop, const WatchHooks& hooks)
      : body_(body), stop_(stop), hooks_(hooks) {
    for (int i = 0; i < threads; ++i) begin();
  }

  void run() {
    while (!workers_.empty()) {
      {
        std::unique_lock lock(ended_->mutex);
        ended_->changed.wait_for(lock, kLookEvery, [&] { return ended_->count > 0; });
        ended_->count = 0;
      }
      collect();
      if (workers_.empty() || seconds_since(looked_) < std::chrono::duration<double>(kLookEvery).count()) continue;
      looked_ = Clock::now();
      look();
    }
  }

 private:
  // Shared with threads that may outlive this object.
  struct Ended {
    std::mutex mutex;
    std::condition_variable changed;
    int count = 0;
  };
  struct Worker {
    std::thread thread;
    std::shared_ptr<std::atomic<bool>> returned = std::make_shared<std::atomic<bool>>(false);
  };
  struct Call : LongCall {
    double limited_seconds = 0;  // what counts against the budget
    bool limited = false;
  };

  void begin() {
    Worker& worker = workers_.emplace_back();
    worker.thread = std::thread([body = body_, ended = ended_, returned = worker.returned] {
      body();
      const std::lock_guard guard(ended->mutex);
      *returned = true;
      ++ended->count;
      ended->changed.notify_all();
    });
  }

  void collect() {
    for (auto it = workers_.begin(); it != workers_.end();) {
      if (*it->returned) {
        it->thread.join();
        it = workers_.erase(it);
      } else {
        ++it;
      }
    }
  }

  void look() {
    const std::vector<SeenThread> seen = look_at_threads();
    const std::vector<Call> calls = follow(seen);
    for (const Call& call : calls)
      if (call.limited && call.limited_seconds > std::max(kLeast, call.ticket->budget)) give_up(call, seen);
    std::vector<LongCall> waiting;
    for (const Call& call : calls)
      if (call.seconds > kLeast && !call.ticket->given_up()) waiting.push_back(call);
    if (hooks_.waiting) hooks_.waiting(waiting);
    if (!stop_) return;
    if (!stopped_) stopped_ = Clock::now();
    if (seconds_since(*stopped_) > kAfterStop) leave(calls, seen);
  }

  std::vector<Call> follow(const std::vector<SeenThread>& seen) {
    std::vector<Call> calls;
    std::map<pthread_t, Followed> now;
    for (const SeenThread& one : seen) {
      if (one.serial == 0) continue;
      const auto before = followed_.find(one.thread);
      const bool same = before != followed_.end() && before->second.serial == one.serial;
      const Followed& known = now[one.thread] =
          same ? before->second : Followed{one.serial, Clock::now(), one.processor_seconds};
      Call& call = calls.emplace_back();
      call.ticket = one.ticket;
      call.plugin = one.plugin;
      call.function = one.function;
      call.seconds = seconds_since(known.seen);
      call.limited_seconds = std::max(one.processor_seconds - known.processor, kAsleepShare * call.seconds);
      call.limited = std::isfinite(one.ticket->budget) && one.role != "reference";
    }
    followed_ = std::move(now);
    return calls;
  }

  // The worker in whose case this call is made: itself, or through a thread that helps it.
  std::list<Worker>::iterator worker_of(const TicketPointer& ticket, const std::vector<SeenThread>& seen) {
    return std::find_if(workers_.begin(), workers_.end(), [&](Worker& worker) {
      return std::any_of(seen.begin(), seen.end(), [&](const SeenThread& one) {
        return one.ticket == ticket && ::pthread_equal(one.thread, worker.thread.native_handle()) != 0;
      });
    });
  }

  // Waits for a turn at the store that has begun; false for a case that has come back meanwhile.
  static bool take_away(CaseTicket& ticket) {
    while (!ticket.give_up() && !ticket.closed()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return ticket.given_up();
  }

  void abandon(std::list<Worker>::iterator worker) {
    worker->thread.detach();
    workers_.erase(worker);
    ++left_behind_count;
  }

  void give_up(const Call& call, const std::vector<SeenThread>& seen) {
    const auto worker = worker_of(call.ticket, seen);
    if (worker == workers_.end()) return;
    TicketPointer outer = call.ticket;
    for (const SeenThread& one : seen)
      if (::pthread_equal(one.thread, worker->thread.native_handle()) != 0) outer = one.outermost;
    if (!outer->give_up()) return;  // at the store, or come back: at the next look
    take_away(*call.ticket);
    abandon(worker);
    hooks_.given_up(call, outer);
    begin();
  }

  // Once every worker that is left sits in a call, all of them are left there.
  void leave(const std::vector<Call>& calls, const std::vector<SeenThread>& seen) {
    std::vector<std::list<Worker>::iterator> stuck;
    std::vector<LongCall> left;
    for (const Call& call : calls)
      if (const auto worker = worker_of(call.ticket, seen); call.seconds > kLeast && worker != workers_.end()) {
        left.push_back(call);
        if (std::find(stuck.begin(), stuck.end(), worker) == stuck.end()) stuck.push_back(worker);
      }
    if (stuck.size() < workers_.size()) return;
    for (const SeenThread& one : seen)
      if (!take_away(*one.outermost) || !take_away(*one.ticket)) return;
    if (hooks_.left_behind) hooks_.left_behind(left);
    for (const auto& worker : stuck) abandon(worker);
  }

  const std::function<void()> body_;
  const std::atomic<bool>& stop_;
  const WatchHooks& hooks_;
  std::list<Worker> workers_;
  std::shared_ptr<Ended> ended_ = std::make_shared<Ended>();
  std::map<pthread_t, Followed> followed_;
  Clock::time_point looked_ = Clock::now();
  std::optional<Clock::time_point> stopped_;
};

}  // namespace

std::string LongCall::text() const {
  return fmt::format("plugin {}, {}() has not returned for {:.0f} s", plugin, function, seconds);
}

void run_watched(int threads, const std::function<void()>& body, const std::atomic<bool>& stop,
                 const WatchHooks& hooks) {
  Watcher(threads, body, stop, hooks).run();
}

int threads_left_behind() {
  return left_behind_count;
}

}  // namespace ricochet
