#pragma once
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "runners/run/analysed_results.hpp"
#include "runners/store/record.hpp"

namespace ricochet {

/// Joins folders of one study: parts of it, or runs that were stopped at different cases. The result is the folder that
/// one run would have left: the same store, tables, report and answer. Cases go from store to store one by one. A case
/// of two folders is the same in both to the last bit, but for times. All were computed by this program, with these
/// plugins and one arithmetic. What was computed for several cases (references), and what unfinished ones have so far,
/// comes along; results kept aside do not.
///
/// Throws InputError, which names folder and case, where some of this does not hold, and where `out` is there and not
/// empty. Throws StoreError for a folder that cannot be read or is being run. Nothing is written then. Cases of which
/// no folder has a result stay to be run. Returns the exit code of a run with these results.
int merge_folders_with(const RenderReport& render, const std::vector<std::filesystem::path>& folders,
                       const std::filesystem::path& out, const std::vector<std::filesystem::path>& plugins,
                       std::FILE* said);

/// What a case that was marched again has in common with what is stored of it.
struct Comparison {
  std::size_t measures = 0, series = 0, tables = 0;  ///< compared: measures of the motion, columns of numbers, tables
  std::vector<std::string> differences;              ///< one sentence each; empty: the same to the last bit
};

/// Status, steps, measures (not those of the computation: its times), curve and tables of two records of a case, bit
/// for bit.
Comparison compare(const CaseRecord& stored, const CaseRecord& again);

/// "as stored to the last bit: 31 measures, 16 series, 2 tables", or what differs, a line each.
std::string text(const Comparison& comparison);

}  // namespace ricochet
