#pragma once
#include <map>
#include <optional>
#include <ricochet/measure/orbits/branch.hpp>
#include <string>

#include "runners/march/case_context.hpp"

namespace ricochet {

/// A branch that is under way or ended, as it is kept.
struct KeptBranch {
  BranchTrace trace;
  BranchState entry;  ///< of the piece under way
  SetSequence first;
};

/// What a case keeps of its branches, by name: every two seconds, and when a branch ends. Contact sets are kept as what
/// they are, because their numbers are those of one run.
class BranchCheckpoints {
 public:
  BranchCheckpoints(CheckpointStore store, std::string key) : store_(std::move(store)), key_(std::move(key)) {}

  /// Reads what an earlier run of the case kept.
  void find(SetSteps& sets);
  /// The branch of this name, if there is one.
  const KeptBranch* branch(const std::string& name) const;
  /// Keeps a branch that goes on, where the last time is long enough ago.
  void keep_sometimes(const std::string& name, const BranchRun& run, const SetSteps& sets);
  /// Keeps one that ended.
  void keep(const std::string& name, const BranchRun& run, const SetSteps& sets);
  void forget();

 private:
  void save(const SetSteps& sets);

  CheckpointStore store_;
  std::string key_;
  std::map<std::string, KeptBranch> branches_;
  std::chrono::steady_clock::time_point saved_ = std::chrono::steady_clock::now();
};

}  // namespace ricochet
