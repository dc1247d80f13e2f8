#pragma once
#include <atomic>
#include <ricochet/loader/catalogue.hpp>
#include <vector>

#include "runners/kinds/trajectory/trajectory.hpp"
#include "runners/study/load_study.hpp"
#include "tests/places.hpp"
#include "tests/refusals.hpp"

namespace ricochet::testing {

/// The cases of small studies of kind `trajectory`, from their text to what running them leaves.
class CaseRuns {
 public:
  /// `folder`: where files lie that studies name.
  explicit CaseRuns(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}
  const Registry& registry() const { return registry_; }
  Study study(const Json& text) { return parse_study(text.dump(1), catalogue_, registry_, folder_); }
  std::string refusal(const Json& text) {
    return input_error([&] { study(text); });
  }
  std::vector<CaseRecord> of(const Json& text) {
    std::vector<CaseRecord> out;
    for (const StudyCase& one : study(text).cases) out.push_back(run_case(one, registry_, stop_));
    return out;
  }
  /// Its first case alone.
  CaseRecord first_of(const Json& text) { return run_case(study(text).cases.front(), registry_, stop_); }

 private:
  std::filesystem::path folder_;
  Catalogue catalogue_{tests::places().plugins, {}, {}};
  Registry registry_;
  const std::atomic<bool> stop_ = false;
};

}  // namespace ricochet::testing
