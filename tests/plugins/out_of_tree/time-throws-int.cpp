// Throws something that is no exception.
#include "stand_in.hpp"

static void register_all(ricochet::Registry&) {
  throw 42;
}

RICOCHET_PLUGIN(time, throws_int, register_all)
