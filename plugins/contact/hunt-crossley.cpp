#include "power_law.hpp"

namespace {

using namespace ricochet;

/// p = k δⁿ (1 + χ δ̇)₊ at each point and side. For a mass that arrives at speed v, whatever k and n,
///
///     χ v (1 + e) = ln[(1 + χ v)/(1 − e χ v)]
class HuntCrossley final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  bool reads_rate() const override { return true; }

 private:
  void set_lanes(std::span<const Parameters> lanes) override {
    laws_ = power_laws(lanes);
    damping_.clear();
    for (const Parameters& lane : lanes) damping_.push_back(lane.real("damping"));
  }
  PointForce at(const ContactState& state) const override {
    const auto set = static_cast<std::size_t>(state.set);
    return damped(laws_[set].at(state.depth), damping_[set], state.rate);
  }
  PointForce gradient(const ContactState& state) const override {
    const auto set = static_cast<std::size_t>(state.set);
    return damped(laws_[set].between(state.depth, state.before), damping_[set], state.rate);
  }
  double stored(double depth, int set) const override { return laws_[static_cast<std::size_t>(set)].stored(depth); }

  std::vector<PowerLaw> laws_;
  std::vector<double> damping_;
};

void register_hunt_crossley(Registry& registry) {
  ParameterSpec damping =
      real_parameter("damping", "s/m", std::nullopt, {.low = 0}, "χ, damping per speed of closing; 0: elastic");
  damping.per_lane = true;
  registry.add_contact(
      {.name = "hunt-crossley",
       .summary = "elastic contact with a damping that grows with the depth",
       .text =
           R"(A point that passes a stop by δ is pushed back with k δⁿ (1 + χ δ̇), never pulled. The force starts and
          ends at zero, other than that of a spring beside a dashpot. The restitution follows from χ v alone, whatever
          k, n and the mass: χ v (1+e) = ln[(1 + χ v)/(1 − e χ v)], that is 0.71 at χ v = 0.6 and 0.41 at χ v = 2,
          near 1 − (2/3) χ v for small ones. )" +
           std::string(damped_evaluation_text) +
           R"(The restitution of the time scheme has no part in it. What the damping takes is reported as dissipated
          by the law.)",
       .source = "Hunt and Crossley (1975), Coefficient of restitution interpreted as damping in vibroimpact",
       .parameters = {stiffness_parameter("N/m^n", "k, force at rest at a depth of 1 m at each contact point"),
                      exponent_parameter(), damping, evaluation_parameter()},
       .words = "Hunt–Crossley"},
      [](const Parameters& p) { return std::make_unique<HuntCrossley>(evaluation_of(p)); });
}

}  // namespace

RICOCHET_PLUGIN(contact, hunt_crossley, register_hunt_crossley)
