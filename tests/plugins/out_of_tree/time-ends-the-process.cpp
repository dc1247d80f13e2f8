// Built several times: a library whose constructor ends the process that loads it, or keeps it.
#include <unistd.h>

#include "stand_in.hpp"

[[maybe_unused]] static void stay() {
  for (;;) pause();
}

[[gnu::constructor]] static void at_load() {
  ENDING;
}

static void register_all(ricochet::Registry& registry) {
  add_stand_in(registry, NAME);
}

RICOCHET_PLUGIN(time, SYMBOL, register_all)
