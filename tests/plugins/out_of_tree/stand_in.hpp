#pragma once
#include <ricochet/contract/plugin.hpp>

/// A scheme that applies to nothing, for plugins that are wrong before any scheme is asked.
class StandIn final : public ricochet::TimeScheme {
 public:
  ricochet::PlanOrRefusal plan(double, const ricochet::ProblemFacts&) const override {
    return ricochet::Refusal{"a stand-in applies to nothing"};
  }
};

inline void add_stand_in(ricochet::Registry& registry, const char* name) {
  registry.add_time({name, "A stand-in.", "It applies to nothing.", "none", {}},
                    [](const ricochet::Parameters&) { return std::make_unique<StandIn>(); });
}
