#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runners/store/run_identity.hpp"
#include "runners/study/study_part.hpp"

namespace ricochet {

/// How far the run of a folder is, as its store tells anybody who may read it.
struct RunStatus {
  std::string name, question, kind;
  int expected = 0;
  StudyPart part;                   ///< of the study, whose cases are expected
  std::map<std::string, int> rows;  ///< status → finished cases
  int partial = 0;                  ///< rows of cases under way
  struct UnderWay {
    std::string id, stage, since;  ///< UTC
  };
  std::vector<UnderWay> under_way;
  std::optional<RunIdentity> run;  ///< the one that began last
  std::string progress, heard;     ///< what it last said of itself, and when (UTC); "" once it has ended in order
  double silent = 0;               ///< s since the store was last written to
};

/// Reads it without reading results. Throws StoreError where there is no store.
RunStatus read_status(const std::filesystem::path& folder);

}  // namespace ricochet
