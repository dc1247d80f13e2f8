#include "three_level.hpp"

namespace {

using namespace ricochet;

void register_all(Registry& registry) {
  registry.add_time(
      {.name = "carpenter-taylor-katona",
       .summary = "central differences, the multiplier keeps the next position admissible",
       .text = R"(Central differences whose predicted position is corrected by the effort so that q_{n+1} lies
          between the stops: newmark-dumont-paoli with β = 0 and e = 0. Explicit where the mass is diagonal and
          nothing is damped; stable up to hω = 2. A point that meets a stop stays there until it is pulled off, and
          contact never gives energy.)",
       .source = "Carpenter, Taylor and Katona (1991), Lagrange constraints for transient finite element surface "
                 "contact",
       .parameters = {}},
      [](const Parameters&) { return std::make_unique<ThreeLevel>(0.0, 0.0, true); });
}

}  // namespace

RICOCHET_PLUGIN(time, carpenter_taylor_katona, register_all)
