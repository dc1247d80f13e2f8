#pragma once
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "runners/workers/worker.hpp"

namespace ricochet {

/// The workers of a run, by the machine they are on, and how many of each machine are at work. May be used from any
/// thread.
class WorkerPlaces {
 public:
  /// A worker, at work or idle.
  struct Member {
    std::shared_ptr<WorkerHost> host;
    std::unique_ptr<Worker> worker;  ///< null: to be started
    int number = 0;                  ///< counts workers, over all machines
    std::size_t place = 0;
  };
  using MemberPointer = std::shared_ptr<Member>;

  enum class Where {
    here,     ///< on the first machine, beside those that are counted: it will wait for others most of the time
    anywhere  ///< where there is most room
  };

  /// The room that one takes while it is at work.
  class Slot {
   public:
    Slot() = default;
    Slot(WorkerPlaces& places, std::size_t place) : places_(&places), place_(place) {}
    Slot(Slot&& other) noexcept : places_(std::exchange(other.places_, nullptr)), place_(other.place_) {}
    Slot& operator=(Slot&&) = delete;
    ~Slot() {
      if (places_) places_->leave(place_);
    }

   private:
    WorkerPlaces* places_ = nullptr;
    std::size_t place_ = 0;
  };
  struct Taken {
    MemberPointer member;
    Slot slot;
  };

  /// `hosts`: at least one; the first is this machine.
  explicit WorkerPlaces(std::vector<std::shared_ptr<WorkerHost>> hosts);

  /// Of all machines.
  int width() const { return width_; }
  int machines() const;
  int width_here() const { return places_.front().host->width(); }
  /// An idle worker, or one to be started there.
  Taken take(Where where);
  void give_back(MemberPointer member);

 private:
  struct Place {
    std::shared_ptr<WorkerHost> host;
    int at_work = 0;
    std::vector<MemberPointer> idle = {};
  };
  void leave(std::size_t place);
  std::size_t roomiest() const;

  std::mutex mutex_;
  std::vector<Place> places_;
  int width_ = 0, born_ = 0;
};

}  // namespace ricochet
