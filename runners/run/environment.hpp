#pragma once
#include <filesystem>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet {

/// Program, commit, compiler, flags, processor, cores that may be used, instruction sets, digest of the arithmetic,
/// kernel, libraries, plugin libraries (with a hash of their bytes), time started (UTC).
Environment describe_environment(const std::vector<std::filesystem::path>& plugin_libraries);

}  // namespace ricochet
