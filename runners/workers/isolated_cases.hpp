#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runners/kinds/kind.hpp"
#include "runners/march/case_context.hpp"
#include "runners/workers/worker_messages.hpp"

namespace ricochet {

/// Lets one worker compute what others look for under the same key (a reference), while they wait for it. Nobody waits
/// for one that waits itself: then both compute it, bitwise alike.
class KeyClaims {
 public:
  /// What `stored` finds; "" where this owner is to compute it. Waits while another one does.
  std::string find(int owner, const std::string& key, const std::function<std::string()>& stored,
                   const std::function<bool()>& stopping);
  /// Something is kept under the key.
  void kept(const std::string& key);
  /// The owner's case has ended: nobody waits for it any more.
  void release(int owner);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, int> owners_;
  std::set<int> waiting_;
};

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

/// Blocks of all cases in one queue, in the order in which they came, and the threads that have them marched.
class BlockPool {
 public:
  struct Block {
    BlockRequest request;
    int owner = 0;            ///< the worker that asked for it
    std::uint32_t about = 0;  ///< its question
    std::function<void(BlockStatus)> tell;
  };
  /// Marches one block and tells what became of it, once; ends early when `stopping` becomes true.
  using March = std::function<void(const Block&, const std::function<bool()>& stopping)>;

  /// `width`: blocks at one time. Threads begin with the first block.
  BlockPool(int width, March march) : width_(width), march_(std::move(march)) {}
  /// Stops them all.
  ~BlockPool();
  BlockPool(const BlockPool&) = delete;
  BlockPool& operator=(const BlockPool&) = delete;

  void begin(Block block);
  /// Stops one: one that has not begun is told to be interrupted at once.
  void stop(int owner, std::uint32_t about);
  /// Stops all blocks of an owner that is gone. None of them is marched any more when it returns.
  void forget(int owner);

 private:
  struct Marching {
    Marching(int of, std::uint32_t block) : owner(of), about(block) {}
    int owner;
    std::uint32_t about;
    std::atomic<bool> stop{false};
  };
  void work();

  const int width_;
  const March march_;
  std::mutex mutex_;
  std::condition_variable changed_, came_back_;
  std::deque<Block> waiting_;
  std::list<Marching> marching_;
  std::vector<std::thread> threads_;
  int free_ = 0;  // threads without a block
  bool ended_ = false;
};

/// What worker processes are given.
struct IsolationOptions {
  int jobs = 1;                                ///< workers that march at one time, where no hosts are given
  std::vector<std::filesystem::path> plugins;  ///< libraries beside the program's own
  /// The machines that they are on, this one first; none: this one alone.
  std::vector<std::shared_ptr<WorkerHost>> hosts = {};
};

/// Cases whose code runs in other processes. A plugin that crashes, aborts, takes all memory or never returns costs
/// what its process had under way. Such a case is retried once from what it had kept. Where its process ends again it
/// is `failed`, with the signal, the plugin and the function, and the last lines of stderr. All other cases are, to the
/// last bit, what they are in one process.
class IsolatedCases {
 public:
  IsolatedCases(const RunContext& context, const IsolationOptions& options);
  ~IsolatedCases();

  CaseRunner runner();
  /// "4 workers on 2 machines".
  std::string workers_in_words() const;
  /// Cases that are under way at one time: as many as there are workers. Cases that only wait for their blocks are as
  /// many as this machine can hold.
  int cases_at_once() const;
  /// The cost of a case as its plan predicts it, s. Throws std::runtime_error where the process ended.
  double predicted_seconds(const StudyCase& study_case);

 private:
  class Coordinator;
  std::shared_ptr<Coordinator> coordinator_;
};

}  // namespace ricochet
