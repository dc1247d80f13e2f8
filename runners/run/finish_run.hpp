#pragma once
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "runners/run/outputs.hpp"
#include "runners/store/record.hpp"
#include "runners/store/store.hpp"

namespace ricochet {

/// Works out the tables that stand beside cases.csv from the cases alone: those of the study's kind, then effects
/// wherever at least two factors vary. Rows speak of finished cases only; a partial study has partial tables.
void derive_tables(StudyResults& results);

/// The same, returned.
inline StudyResults with_tables(StudyResults results) {
  derive_tables(results);
  return results;
}

/// reasons: why cases have no result, each reason once with the number of cases that give it; no rows where all are
/// done.
Table reasons_table(const StudyResults& results);

/// Writes text for a person and flushes. A failure is let be: a closed terminal or a full log must not cost a run.
inline void say(std::FILE* out, std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), out);
  std::fflush(out);
}

// How a folder whose cases are all in its store becomes one of results.

/// Makes the views of the store and writes the tables, curves and report of what it holds, which is returned.
/// `changed`: see write_outputs().
StudyResults write_folder(Store& store, const std::filesystem::path& folder, const RenderReport& render,
                          const std::set<std::string>* changed = nullptr);

/// Says the answer, the totals (`how` they came about) and where the report is; returns the exit code.
int tell_results(std::FILE* out, const StudyResults& results, const std::filesystem::path& folder,
                 const std::string& how, bool table = false);

}  // namespace ricochet
