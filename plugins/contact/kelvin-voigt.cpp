
#include "power_law.hpp"

namespace {

using namespace ricochet;

/// p = (k δ + c δ̇)₊ for δ > 0. At δ = 0 the force jumps to c δ̇ where the point arrives. The graph is closed
/// there: 0 ≤ p ≤ c δ̇. Without that a step may have no solution. With b = c/2m and w² = k/m − b² > 0 a mass m keeps
///
///     e = exp[−(b/w)(π − atan2(2bw, w² − b²))]
///
/// of its speed, and leaves where the force is zero, before the depth is.
class KelvinVoigt final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  bool reads_rate() const override { return true; }
  // Beyond the stop at both ends of the step, all means over it are the mean of the ends.
  std::optional<ContactSlopes> linear_slopes(int set) const override {
    ContactSlopes slopes = spring_slopes(laws_[static_cast<std::size_t>(set)].stiffness, reads());
    slopes.viscosity = dampers_[static_cast<std::size_t>(set)];
    return slopes;
  }

 private:
  void set_lanes(std::span<const Parameters> lanes) override {
    laws_.clear();
    dampers_.clear();
    for (const Parameters& lane : lanes) {
      laws_.push_back({lane.real("stiffness"), 1});
      dampers_.push_back(lane.real("viscosity"));
    }
  }
  PointForce at(const ContactState& state) const override {
    if (!(state.depth > 0)) return {};
    const auto set = static_cast<std::size_t>(state.set);
    const double elastic = laws_[set].force(state.depth), viscous = dampers_[set] * state.rate;
    // It does not pull: what the spring gives back beyond that is lost too.
    if (!(elastic + viscous > 0)) return {.dissipation = -elastic * state.rate};
    return {.value = elastic + viscous,
            .stiffness = laws_[set].stiffness,
            .viscosity = dampers_[set],
            .dissipation = viscous * state.rate};
  }
  // The dashpot acts on the share of the step's way that lies beyond the stop, [δ₊ − δ⁻₊]/(δ − δ⁻): no jump at entry.
  PointForce gradient(const ContactState& state) const override {
    const auto set = static_cast<std::size_t>(state.set);
    const PointForce elastic = laws_[set].between(state.depth, state.before), share = beyond(state);
    const double viscosity = dampers_[set] * share.value, viscous = viscosity * state.rate;
    if (!(elastic.value + viscous > 0)) return {.dissipation = -elastic.value * state.rate};
    return {.value = elastic.value + viscous,
            .stiffness = elastic.stiffness + dampers_[set] * share.stiffness * state.rate,
            .viscosity = viscosity,
            .before = elastic.before + dampers_[set] * share.before * state.rate,
            .dissipation = viscous * state.rate};
  }
  static PointForce beyond(const ContactState& state) {
    if (state.depth > 0 && state.before > 0) return {.value = 1};
    const double way = state.depth - state.before, square = way * way;
    if (state.depth > 0) return {state.depth / way, -state.before / square, 0, state.depth / square};
    return {-state.before / way, state.before / square, 0, -state.depth / square};
  }
  double stored(double depth, int set) const override { return laws_[static_cast<std::size_t>(set)].stored(depth); }

  std::vector<PowerLaw> laws_;
  std::vector<double> dampers_;
};

void register_kelvin_voigt(Registry& registry) {
  ParameterSpec viscosity = real_parameter("viscosity", "N s/m", std::nullopt, {.low = 0},
                                           "c, viscosity of the dashpot at each contact point; 0: the penalty");
  viscosity.per_lane = true;
  registry.add_contact(
      {.name = "kelvin-voigt",
       .summary = "a spring beside a dashpot behind each stop, which never pulls",
       .text =
           R"(A point that passes a stop by δ is pushed back with k δ + c δ̇, never pulled. The force begins with a
          jump to c times the speed of arrival, and ends before the depth is back at zero. A mass m keeps exp[−(b/w)(π
          − atan2(2bw, w² − b²))] of its speed, b = c/2m, w² = k/m − b², whatever the speed: 0.57 at k = 1e4 N/m, c =
          40 N s/m, m = 1 kg. )" +
           std::string(damped_evaluation_text) +
           R"(Evaluated conserving, the dashpot acts on the share of the step's way that lies beyond the stop. The
          restitution of the time scheme has no part in it. What the dashpot takes is reported as dissipated by the
          law.)",
       .source = "Goldsmith (1960), Impact, section 3.4; Brogliato (2016), Nonsmooth Mechanics, section 2.1",
       .parameters = {with_role(stiffness_parameter("N/m", "k, stiffness of the spring at each contact point"),
                                ParameterRole::stiffness),
                      with_role(viscosity, ParameterRole::damping), evaluation_parameter()},
       .words = "Kelvin–Voigt"},
      [](const Parameters& p) { return std::make_unique<KelvinVoigt>(evaluation_of(p)); });
}

}  // namespace

RICOCHET_PLUGIN(contact, kelvin_voigt, register_kelvin_voigt)
