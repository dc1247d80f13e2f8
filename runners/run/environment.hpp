#pragma once
#include <filesystem>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet {

/// Program, commit, compiler, flags, processor, cores, instruction sets, kernel, libraries, plugin libraries (with a
/// hash of their bytes), time started (UTC).
Environment describe_environment(const std::vector<std::filesystem::path>& plugin_libraries);

/// The environment of a resumed run: `now`, plus one entry "NAME (earlier cases)" for each value that was another when
/// the kept cases ran.
Environment merge_environments(const Environment& now, const Environment& earlier);

}  // namespace ricochet
