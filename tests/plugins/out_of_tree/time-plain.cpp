// A stand-in that is nothing but that: built with other flags, or against other headers, and shadowing a name of ours.
#include "stand_in.hpp"

#ifndef NAME
#define NAME "newmark"
#define SYMBOL newmark
#endif

static void register_all(ricochet::Registry& registry) {
  add_stand_in(registry, NAME);
}

RICOCHET_PLUGIN(time, SYMBOL, register_all)
