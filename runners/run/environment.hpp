#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet {

/// What computes: program, commit, compiler, contract (the tag that plugins share), build type, flags, processor, cores
/// that may be used, instruction sets, lanes, digest of the arithmetic, kernel. Then libraries, plugin libraries (with a hash of their bytes), and the time
/// started (UTC).
Environment describe_environment(const std::vector<std::filesystem::path>& plugin_libraries);

}  // namespace ricochet
