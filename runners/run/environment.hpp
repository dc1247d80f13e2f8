#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet {

/// What computes: program, commit, compiler, build type, flags, processor, cores that may be used, instruction sets,
/// digest of the arithmetic, kernel. Then libraries, plugin libraries (with a hash of their bytes), and the time
/// started (UTC).
Environment describe_environment(const std::vector<std::filesystem::path>& plugin_libraries);

/// How this program was built; the words that CMake gave, "unknown" where it was built without.
struct BuildFacts {
  std::string version, commit, type, flags;
};
BuildFacts build_facts();

}  // namespace ricochet
