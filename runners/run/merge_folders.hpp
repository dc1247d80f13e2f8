#pragma once
#include <cstdio>
#include <filesystem>
#include <vector>

#include "runners/run/outputs.hpp"

namespace ricochet {

/// Joins folders of one study (parts of it, or runs that were stopped at different cases) into the folder that one run
/// would have left: the same store, and from it the same tables, report and answer. Cases go from store to store one
/// by one. A case of two folders is the same in both to the last bit, but for times; all were computed by this program,
/// with these plugins and one arithmetic. What was computed for several cases (references), and what unfinished ones
/// have so far, comes along; results kept aside do not.
///
/// Where some of this does not hold it throws InputError, which names folder and case, and StoreError for a folder that
/// cannot be read or is being run; nothing is written then, nor where `out` is there and not empty. Cases of which no
/// folder has a result stay to be run. Returns the exit code of a run with these results.
int merge_folders_with(const RenderReport& render, const std::vector<std::filesystem::path>& folders,
                       const std::filesystem::path& out, const std::vector<std::filesystem::path>& plugins,
                       std::FILE* said);

}  // namespace ricochet
