#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runners/kinds/kind.hpp"
#include "runners/workers/worker.hpp"

namespace ricochet {

/// What worker processes are given.
struct IsolationOptions {
  int jobs = 1;                                ///< workers that march at one time, where no hosts are given
  std::vector<std::filesystem::path> plugins;  ///< libraries beside the program's own
  /// The machines that they are on, this one first; none: this one alone.
  std::vector<std::shared_ptr<WorkerHost>> hosts = {};
};

/// Cases whose code runs in processes of their own: a plugin that crashes, aborts, takes all memory or never returns
/// costs what its process had under way. A case goes on once from what it had kept; where its process ends again it is
/// `failed`, with the signal, the plugin and the function, and the last lines of stderr. All other cases are, to the
/// last bit, what they are in one process.
class IsolatedCases {
 public:
  IsolatedCases(const RunContext& context, const IsolationOptions& options);
  ~IsolatedCases();

  CaseRunner runner();
  /// "4 workers on 2 machines".
  std::string workers_in_words() const;
  /// Cases that are under way at one time: as many as there are workers, or, where they only wait for their blocks,
  /// what this machine can hold.
  int cases_at_once() const;
  /// The cost of a case as its plan predicts it, s. Throws std::runtime_error where the process ended.
  double predicted_seconds(const StudyCase& study_case);

 private:
  class Coordinator;
  std::shared_ptr<Coordinator> coordinator_;
};

}  // namespace ricochet
