#include <algorithm>

#include "power_law.hpp"

namespace {

using namespace ricochet;

/// p = F (e^{x/l} − e^{−r}), x the depth beyond the stop, from x = −r l on: with s = x + r l,
/// p = F e^{−r} (e^{s/l} − 1), U = F e^{−r} (l (e^{s/l} − 1) − s).
struct ExponentialLaw {
  double scale = 0;   ///< F e^{−r}, N
  double length = 0;  ///< l, m
  double reach = 0;   ///< r, lengths

  double force(double s) const { return s > 0 ? scale * std::expm1(s / length) : 0.0; }
  double slope(double s) const { return s > 0 ? scale / length * std::exp(s / length) : 0.0; }
  double stored(double s) const {
    if (!(s > 0)) return 0;
    // e^y − 1 − y: near 0 by its series, where the difference would cancel.
    const double y = s / length;
    const double beyond = y < 1e-3 ? y * y * (0.5 + y / 6 + y * y / 24 + y * y * y / 120) : std::expm1(y) - y;
    return scale * length * beyond;
  }
};

class Exponential final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  double layer(int set) const override { return law(set).reach * law(set).length; }

 private:
  void set_lanes(std::span<const Parameters> lanes) override {
    laws_.clear();
    for (const Parameters& lane : lanes)
      laws_.push_back({lane.real("force") * std::exp(-lane.real("reach")), lane.real("length"), lane.real("reach")});
  }
  PointForce at(const ContactState& state) const override {
    const ExponentialLaw& law = this->law(state.set);
    return {.value = law.force(state.depth), .stiffness = law.slope(state.depth)};
  }
  PointForce gradient(const ContactState& state) const override {
    const ExponentialLaw& law = this->law(state.set);
    return mean_force(law, state.depth, state.before, std::min({law.length, state.depth, state.before}));
  }
  double stored(double depth, int set) const override { return law(set).stored(depth); }
  const ExponentialLaw& law(int set) const { return laws_[static_cast<std::size_t>(set)]; }

  std::vector<ExponentialLaw> laws_;
};

void register_exponential(Registry& registry) {
  ParameterSpec force = real_parameter("force", "N", std::nullopt, {.low = 0, .low_open = true},
                                       "F, force at the stop, but for the part cut off");
  ParameterSpec length = real_parameter("length", "m", 1e-3, {.low = 0, .high = 1, .low_open = true},
                                        "l, distance over which the force grows e times");
  ParameterSpec reach = real_parameter("reach", "1", 10.0, {.low = 0, .high = 100},
                                       "r, where the force begins, in lengths before the stop");
  force.per_lane = length.per_lane = reach.per_lane = true;
  registry.add_contact(
      {.name = "exponential",
       .summary = "a force that grows e times with each length of approach",
       .text =
           R"(A point at depth x beyond the stop, or before it where x < 0, is pushed back with F (e^(x/l) − e^(−r)),
          from r lengths before the stop on: continuous, elastic, without a corner at the stop. The shorter l, the
          nearer to a rigid stop, and the stiffer: the slope at the stop is F/l. )" +
           std::string(evaluation_text) + "The restitution of the time scheme has no part in it.",
       .source = R"(a regularisation of the stop by a smooth potential that no one author owns; the cut-off is this
          program's; )" +
                 std::string(evaluation_source),
       .parameters = {force, length, reach, evaluation_parameter()}},
      [](const Parameters& p) { return std::make_unique<Exponential>(evaluation_of(p)); });
}

}  // namespace

RICOCHET_PLUGIN(contact, exponential, register_exponential)
