#include "runners/run/build_facts.hpp"

#ifndef RICOCHET_VERSION
#define RICOCHET_VERSION "unknown"
#endif
#ifndef RICOCHET_COMMIT
#define RICOCHET_COMMIT "unknown"
#endif
#ifndef RICOCHET_BUILD_TYPE
#define RICOCHET_BUILD_TYPE "unknown"
#endif
#ifndef RICOCHET_FLAGS
#define RICOCHET_FLAGS "unknown"
#endif

namespace ricochet {

BuildFacts build_facts() {
  return {RICOCHET_VERSION, RICOCHET_COMMIT, RICOCHET_BUILD_TYPE, RICOCHET_FLAGS};
}

}  // namespace ricochet
