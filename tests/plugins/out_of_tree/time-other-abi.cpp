// Compiled with another contract version: none of its code may run, not even this.
#include <cstdlib>

#include "stand_in.hpp"

[[gnu::constructor]] static void never_loaded() {
  std::abort();
}

static void register_all(ricochet::Registry& registry) {
  add_stand_in(registry, "other-abi");
}

RICOCHET_PLUGIN(time, other_abi, register_all)
