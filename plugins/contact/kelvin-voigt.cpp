
#include "power_law.hpp"

namespace {

using namespace ricochet;

/// p = (k δ + c δ̇)₊ for δ > 0. At δ = 0 the force jumps to c δ̇ where the point arrives. The graph is closed
/// there: 0 ≤ p ≤ c δ̇. Without that a step may have no solution. With b = c/2m and w² = k/m − b² > 0 a mass m keeps
///
///     e = exp[−(b/w)(π − atan2(2bw, w² − b²))]
///
/// of its speed, and leaves where the force is zero, before the depth is. A dashpot that acts on the way in alone lets
/// the spring give back all that it holds. The mass turns after t = atan2(w, b)/w, and keeps e = exp(−b t).
class KelvinVoigt final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  bool reads_rate() const override { return true; }
  // Beyond the stop at both ends of the step, all means over it are the mean of the ends.
  std::optional<ContactSlopes> linear_slopes(int set) const override {
    const Dashpot& dashpot = dashpots_[static_cast<std::size_t>(set)];
    if (dashpot.one_way) return std::nullopt;
    ContactSlopes slopes = spring_slopes(springs_[static_cast<std::size_t>(set)].stiffness, reads());
    slopes.viscosity = dashpot.viscosity;
    return slopes;
  }

 private:
  void set_lanes(std::span<const Parameters> lanes) override {
    springs_.clear();
    dashpots_.clear();
    for (const Parameters& lane : lanes) {
      springs_.push_back({lane.real("stiffness"), 1});
      dashpots_.push_back({lane.real("viscosity"), lane.flag("one_way")});
    }
  }
  PointForce at(const ContactState& state) const override {
    if (!(state.depth > 0)) return {};
    const auto set = static_cast<std::size_t>(state.set);
    return beside(springs_[set].at(state.depth), dashpots_[set].at(state.rate), state.rate);
  }
  PointForce gradient(const ContactState& state) const override {
    const auto set = static_cast<std::size_t>(state.set);
    return beside(springs_[set].between(state.depth, state.before), dashpots_[set].over(state), state.rate);
  }
  double stored(double depth, int set) const override { return springs_[static_cast<std::size_t>(set)].stored(depth); }

  std::vector<PowerLaw> springs_;
  std::vector<Dashpot> dashpots_;
};

void register_kelvin_voigt(Registry& registry) {
  ParameterSpec one_way;
  one_way.key = "one_way";
  one_way.type = ParameterSpec::Type::boolean;
  one_way.unit = "1";
  one_way.fallback = false;
  one_way.text = "whether the dashpot acts while the point closes alone, and not on its way out";
  one_way.per_lane = true;
  registry.add_contact(
      {.name = "kelvin-voigt",
       .summary = "a spring beside a dashpot behind each stop, which never pulls",
       .text =
           R"(A point that passes a stop by δ is pushed back with k δ + c δ̇, never pulled. The force begins with a
          jump to c times the speed of arrival, and ends before the depth is back at zero. A mass m keeps exp[−(b/w)(π
          − atan2(2bw, w² − b²))] of its speed, b = c/2m, w² = k/m − b², whatever the speed: 0.57 at k = 1e4 N/m, c =
          40 N s/m, m = 1 kg. With `one_way` the dashpot acts on the way in alone, and the mass keeps exp(−b atan2(w,
          b)/w): 0.76 there. )" +
           std::string(damped_evaluation_text) +
           R"(Evaluated conserving, the dashpot acts on the share of the step's way that lies beyond the stop. The
          restitution of the time scheme has no part in it. What the dashpot takes is reported as dissipated by the
          law.)",
       .source = "Goldsmith (1960), Impact, section 3.4; Brogliato (2016), Nonsmooth Mechanics, section 2.1",
       .parameters = {with_role(stiffness_parameter("N/m", "k, stiffness of the spring at each contact point"),
                                ParameterRole::stiffness),
                      viscosity_parameter({.low = 0},
                                          "c, viscosity of the dashpot at each contact point; 0: the penalty"),
                      one_way, evaluation_parameter()},
       .words = "Kelvin–Voigt"},
      [](const Parameters& p) { return std::make_unique<KelvinVoigt>(evaluation_of(p)); });
}

}  // namespace

RICOCHET_PLUGIN(contact, kelvin_voigt, register_kelvin_voigt)
