// Declares a parameter that no study could give.
#include "stand_in.hpp"

static void register_all(ricochet::Registry& registry) {
  ricochet::PluginManual manual = {"parameter-name", "A stand-in.", "It applies to nothing.", "none", {}};
  manual.parameters = {ricochet::real_parameter("name", "1", 0.5, {0, 1}, "reserved")};
  registry.add_time(manual, [](const ricochet::Parameters&) { return std::make_unique<StandIn>(); });
}

RICOCHET_PLUGIN(time, parameter_name, register_all)
