#pragma once
#include <filesystem>
#include <iosfwd>
#include <ricochet/loader/catalogue.hpp>
#include <string>
#include <vector>

#include "runners/march/prepare_case.hpp"
#include "runners/study/study.hpp"
#include "runners/workers/worker_messages.hpp"

namespace ricochet {

class AnalysedResults;

struct RunOptions {
  std::filesystem::path out;  ///< results folder; empty: default_folder()
  int jobs = 0;               ///< workers; 0: as many as processors that it may use
  bool fresh = false;         ///< forget what the folder holds
  bool table = false;         ///< print a line for every case
  /// Where cases run: in worker processes or in this one. `here_if_short`: in this one where all of them are predicted
  /// to take less than a second, else in workers.
  enum class Where { workers, here, here_if_short } where = Where::here;
  std::vector<std::filesystem::path> plugins = {};      ///< libraries beside the program's own, for workers
  std::vector<std::shared_ptr<WorkerHost>> hosts = {};  ///< where workers run; none: this machine alone
  StudyPart part = {};                                  ///< the cases that run, and that the folder has
};

/// What would run for a case of a study of this kind, decided without running it.
CasePlan plan_for(const std::string& kind, const StudyCase& study_case, const Registry& registry);

/// Where the results of a run go that is not told: results/NAME, results/NAME-part-3-of-64.
std::filesystem::path default_folder(const std::string& study, const StudyPart& part);

/// Runs what is missing, so many cases at once, writes every finished case at once, then cases.csv, curves/,
/// study.json and report.html, and prints the answer. Returns the exit code (0, 3, 5, 130); throws
/// PartRefused (study_cases.hpp).
int run_study(const Study& study, const Catalogue& catalogue, const Registry& registry, const RunOptions& options);

/// Writes tables, curves and report of these results into a folder.
void write_results(const AnalysedResults& results, const std::filesystem::path& folder);

/// Rebuilds report.html (and cases.csv, curves/) from results.sqlite; `json`: prints what the study asks with its
/// verdicts in place of words. Returns the exit code.
int rebuild_report(const std::filesystem::path& folder, bool json = false);

/// merge_folders_with() (merge_folders.hpp), with the reports of this program.
int merge_folders(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& out,
                  const std::vector<std::filesystem::path>& plugins);

/// Writes the tables of the store as CSV into `to`, curves into one file or one for each case. Returns the exit code.
int export_tables(const std::filesystem::path& folder, const std::filesystem::path& to, bool one_file = false);

}  // namespace ricochet
