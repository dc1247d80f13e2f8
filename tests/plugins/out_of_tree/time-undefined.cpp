// Calls a function that nobody has.
#include "stand_in.hpp"

int nowhere(double);

static void register_all(ricochet::Registry& registry) {
  if (nowhere(1) > 0) add_stand_in(registry, "undefined");
}

RICOCHET_PLUGIN(time, undefined, register_all)
