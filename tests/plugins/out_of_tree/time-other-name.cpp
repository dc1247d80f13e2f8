// Says that it provides one name and registers another.
#include "stand_in.hpp"

static void register_all(ricochet::Registry& registry) {
  add_stand_in(registry, "yet-another-name");
}

RICOCHET_PLUGIN(time, other_name, register_all)
