#pragma once
#include <mutex>
#include <set>
#include <string>

#include "runners/kinds/sweep/orbit_exponents.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"
#include "runners/march/checkpoint_store.hpp"

namespace ricochet {

/// What an interrupted set of orbits had marched, in a checkpoint store: finished orbits in parts that are written
/// once, those on their way anew each time. Without a store nothing is kept.
class OrbitCheckpoints {
 public:
  /// `key` tells this set of orbits from every other.
  OrbitCheckpoints(const CheckpointStore& checkpoints, std::string key)
      : checkpoints_(checkpoints), key_(std::move(key)) {}

  /// Everything that was saved; further parts follow it. Call it first.
  MarchedOrbits find();
  void save(const MarchedOrbits& marched);
  void forget();

 private:
  std::string part(int number) const;

  const CheckpointStore& checkpoints_;
  std::string key_;
  int parts_ = 0;
};

/// Batches of exponents that a killed run had measured, read when they are asked for and forgotten at the end.
class ExponentCheckpoints {
 public:
  ExponentCheckpoints(const CheckpointStore& checkpoints, std::string key)
      : checkpoints_(checkpoints), key_(std::move(key)) {}
  /// Lets the task keep its batches here, and find them.
  void serve(ExponentTask& task);
  void forget();

 private:
  std::string part(std::size_t batch) const;
  void note(std::size_t batch);

  const CheckpointStore& checkpoints_;
  std::string key_;
  std::mutex mutex_;
  std::set<std::size_t> kept_;
};

}  // namespace ricochet
