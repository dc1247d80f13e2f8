#include "three_level.hpp"

namespace {

using namespace ricochet;

PlanOrRefusal carpenter_taylor_katona(const Parameters&, double h, const ProblemFacts& facts) {
  return ThreeLevel{}.plan(h, facts);
}

void register_carpenter_taylor_katona(Registry& registry) {
  registry.add_time(
      {.name = "carpenter-taylor-katona",
       .summary = "central differences, the multiplier keeps the next position admissible",
       .text = R"(Central differences whose predicted position is corrected by the effort so that q_{n+1} lies
          between the stops: newmark-dumont-paoli with β = 0 and e = 0. Explicit where the mass is diagonal and
          nothing is damped; stable up to hω = 2. A point that meets a stop stays there until it is pulled off, and
          contact never gives energy.)",
       .source = R"(Carpenter, Taylor and Katona (1991), Lagrange constraints for transient finite element surface
          contact)",
       .parameters = {},
       .words = "Carpenter–Taylor–Katona"},
      carpenter_taylor_katona);
}

}  // namespace

RICOCHET_PLUGIN(time, carpenter_taylor_katona, register_carpenter_taylor_katona)
