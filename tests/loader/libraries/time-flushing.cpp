// Counts denormal numbers as zero from the moment in which it is loaded, as anything linked with -ffast-math does, and
// once more as it registers. Its scheme applies to nothing.
#include <ricochet/contract/float_control.hpp>
#include <ricochet/contract/plugin.hpp>

using namespace ricochet;

namespace {

class Flushing final : public TimeScheme {
 public:
  PlanOrRefusal plan(double, const ProblemFacts&) const override { return Refusal{"it applies to nothing"}; }
};

void flush() {
  set_float_control(float_control() | flushing_bits());
}

[[maybe_unused]] const bool loaded = (flush(), true);

void register_all(Registry& registry) {
  flush();
  registry.add_time({"flushing", "Flushes.", "It flushes as it is loaded.", "none", {}},
                    [](const Parameters&) { return std::make_unique<Flushing>(); });
}

}  // namespace

RICOCHET_PLUGIN(time, flushing, register_all)
