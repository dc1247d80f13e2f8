#pragma once
#include <chrono>
#include <optional>
#include <ricochet/measure/orbits/branch.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>
#include <set>
#include <string>

#include "runners/march/case_context.hpp"

namespace ricochet {

/// A branch that is under way or ended, as it is kept.
struct KeptBranch {
  BranchTrace trace;
  BranchState entry;  ///< of the piece under way, or the last orbit of a branch by steps
  SetSequence first;  ///< sets of its first piece
};
KeptBranch kept(const BranchRun& run);
KeptBranch kept(const StepFollower& run);

/// What a case keeps of its branches, each under its own key: every two seconds, and when it ends. Contact sets are
/// kept as what they are, because their numbers are those of one run.
class BranchCheckpoints {
 public:
  BranchCheckpoints(CheckpointStore store, std::string key) : store_(std::move(store)), key_(std::move(key)) {}

  /// What an earlier run of the case kept of the branch of this name; nothing where it kept none. `sets`: null of
  /// branches by steps.
  std::optional<KeptBranch> find(const std::string& name, SetSteps* sets);
  /// Whether a branch that goes on is to be kept: the last time is long enough ago.
  bool due() const;
  void keep(const std::string& name, const KeptBranch& branch, const SetSteps* sets);
  /// Forgets all of them.
  void forget();

 private:
  std::string key_of(const std::string& name) const { return "branches/" + key_ + "/" + name; }

  CheckpointStore store_;
  std::string key_;
  std::set<std::string> names_;  // that something is kept of
  std::chrono::steady_clock::time_point saved_ = std::chrono::steady_clock::now();
};

}  // namespace ricochet
