// Throws while it registers, an exception of its own type.
#include <stdexcept>

#include "stand_in.hpp"

namespace {

struct Mine : std::runtime_error {
  Mine() : std::runtime_error("the licence of this scheme has run out") {}
};

void register_all(ricochet::Registry&) {
  throw Mine();
}

}  // namespace

RICOCHET_PLUGIN(time, throws, register_all)
