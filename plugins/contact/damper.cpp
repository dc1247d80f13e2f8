#include "power_law.hpp"

namespace {

using namespace ricochet;

/// p = c δ̇₊ for δ > 0: a dashpot alone. It stores nothing and cannot pull, so it acts on the way in only. At δ = 0 the
/// force jumps to c δ̇ where the point arrives, and the graph is closed there. A free mass m slows down as e^{−ct/m} and
/// ends v m/c beyond the stop.
class Damper final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  bool reads_rate() const override { return true; }

 private:
  void set_lanes(std::span<const Parameters> lanes) override {
    dashpots_.clear();
    for (const Parameters& lane : lanes) dashpots_.push_back({lane.real("viscosity"), true});
  }
  PointForce at(const ContactState& state) const override {
    return state.depth > 0 ? dashpot(state.set).at(state.rate) : PointForce{};
  }
  PointForce gradient(const ContactState& state) const override { return dashpot(state.set).over(state); }
  double stored(double, int) const override { return 0; }
  const Dashpot& dashpot(int set) const { return dashpots_[static_cast<std::size_t>(set)]; }

  std::vector<Dashpot> dashpots_;
};

void register_damper(Registry& registry) {
  registry.add_contact(
      {.name = "damper",
       .summary = "a dashpot alone behind each stop, which never pulls",
       .text =
           R"(A point that passes a stop is pushed back with c times its speed of closing, and is free on its way out.
          Nothing is stored: the stop gives nothing back, and does not hold a load. A free mass m that arrives at
          speed v slows down as v e^(−c t/m) and comes to rest v m/c beyond the stop. )" +
           std::string(damped_evaluation_text) +
           R"(Evaluated conserving, the dashpot acts on the share of the step's way that lies beyond the stop. The
          restitution of the time scheme has no part in it. What the dashpot takes is reported as dissipated by the
          law.)",
       .source = "Goldsmith (1960), Impact, section 3.4: the dashpot of its spring and dashpot",
       .parameters = {viscosity_parameter({.low = 0, .low_open = true},
                                          "c, viscosity of the dashpot at each contact point"),
                      evaluation_parameter()}},
      [](const Parameters& p) { return std::make_unique<Damper>(evaluation_of(p)); });
}

}  // namespace

RICOCHET_PLUGIN(contact, damper, register_damper)
