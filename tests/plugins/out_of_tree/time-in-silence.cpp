// Registers what it says, and one more that it does not say.
#include "stand_in.hpp"

static void register_all(ricochet::Registry& registry) {
  add_stand_in(registry, "in-silence");
  add_stand_in(registry, "unsaid");
}

RICOCHET_PLUGIN(time, in_silence, register_all)
