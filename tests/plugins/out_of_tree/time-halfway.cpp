// Provides two schemes and fails after the first: neither may be used.
#include <stdexcept>

#include "stand_in.hpp"

static void register_all(ricochet::Registry& registry) {
  add_stand_in(registry, "halfway");
  throw std::runtime_error("the second scheme was not to be had");
}

RICOCHET_PLUGIN(time, halfway, register_all)
RICOCHET_PROVIDES(time, other_half)
