#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runners/kinds/kind.hpp"

namespace ricochet {

/// What worker processes are given.
struct IsolationOptions {
  std::vector<std::filesystem::path> plugins;  ///< libraries beside the program's own
  double memory = 0;  ///< bytes of address space of each; 0: its share of what is free, and never less than 2 GiB
};

/// Cases whose code runs in processes of their own: a plugin that crashes, aborts, takes all memory or never returns
/// costs what its process had under way. A case goes on once from what it had kept; where its process ends again it is
/// `failed`, with the signal, the plugin and the function, and the last lines of stderr. All other cases are, to the
/// last bit, what they are in threads of this process.
class IsolatedCases {
 public:
  IsolatedCases(const RunContext& context, const IsolationOptions& options);
  ~IsolatedCases();

  CaseRunner runner();
  /// The cost of a case as its plan predicts it, s. Throws std::runtime_error where the process ended.
  double predicted_seconds(const StudyCase& study_case);

 private:
  class Desk;
  std::shared_ptr<Desk> desk_;
};

}  // namespace ricochet
