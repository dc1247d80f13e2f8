#pragma once
#include <string>

namespace ricochet {

/// How this program was built; the words that CMake gave, "unknown" where it was built without.
struct BuildFacts {
  std::string version, commit, type, flags;
};
BuildFacts build_facts();

}  // namespace ricochet
