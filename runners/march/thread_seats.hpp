#pragma once
#include <algorithm>
#include <atomic>

namespace ricochet {

/// The threads that a run may keep busy, over all its cases. May be used from any thread.
class ThreadSeats {
 public:
  explicit ThreadSeats(int count) : count_(std::max(1, count)) {}
  ThreadSeats(const ThreadSeats&) = delete;
  ThreadSeats& operator=(const ThreadSeats&) = delete;

  /// A seat for a thread that runs a case, even where none is free: others give way.
  void sit() { ++taken_; }
  /// A free seat; false where there is none.
  bool take() {
    for (int taken = taken_; taken < count_;)
      if (taken_.compare_exchange_weak(taken, taken + 1)) return true;
    return false;
  }
  void leave() { --taken_; }
  /// Leaves where more are seated than there are seats; whether it did.
  bool give_way() {
    for (int taken = taken_; taken > count_;)
      if (taken_.compare_exchange_weak(taken, taken - 1)) return true;
    return false;
  }
  int count() const { return count_; }
  int free() const { return std::max(0, count_ - taken_); }

  /// Of a thread that runs a case.
  class Seat {
   public:
    explicit Seat(ThreadSeats& seats) : seats_(seats) { seats_.sit(); }
    ~Seat() { seats_.leave(); }
    Seat(const Seat&) = delete;
    Seat& operator=(const Seat&) = delete;

   private:
    ThreadSeats& seats_;
  };

 private:
  const int count_;
  std::atomic<int> taken_{0};
};

}  // namespace ricochet
