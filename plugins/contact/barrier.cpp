#include <algorithm>
#include <limits>

#include "power_law.hpp"

namespace {

using namespace ricochet;

/// Logarithmic barrier in front of each stop, D thick. With δ = D − clearance,
///
///     U = −κ δ² ln(1 − δ/D),   p = κ [−2δ ln(1 − δ/D) + δ²/(D − δ)],   without bound as δ → D
struct BarrierLaw {
  double stiffness = 0, thickness = 0;

  double share(double depth) const { return depth / thickness; }
  double stored(double depth) const {
    if (!(depth > 0)) return 0;
    if (depth >= thickness) return std::numeric_limits<double>::infinity();
    return -stiffness * depth * depth * std::log1p(-share(depth));
  }
  double force(double depth) const {
    if (!(depth > 0)) return 0;
    if (depth >= thickness) return std::numeric_limits<double>::infinity();
    return stiffness * depth * (-2 * std::log1p(-share(depth)) + share(depth) / (1 - share(depth)));
  }
  double slope(double depth) const {
    if (!(depth > 0)) return 0;
    if (depth >= thickness) return std::numeric_limits<double>::infinity();
    const double x = share(depth), left = 1 - x;
    return stiffness * (-2 * std::log1p(-x) + 2 * x / left + x * (2 - x) / (left * left));
  }
};

class Barrier final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  double layer(int set) const override { return law(set).thickness; }

 private:
  void set_lanes(std::span<const Parameters> lanes) override {
    laws_.clear();
    for (const Parameters& lane : lanes) laws_.push_back({lane.real("stiffness"), lane.real("thickness")});
  }
  PointForce at(const ContactState& state) const override {
    const BarrierLaw& law = this->law(state.set);
    return {.value = law.force(state.depth), .stiffness = law.slope(state.depth)};
  }
  PointForce gradient(const ContactState& state) const override {
    const BarrierLaw& law = this->law(state.set);
    const double left = law.thickness - std::max(state.depth, state.before);
    return mean_force(law, state.depth, state.before, std::min({state.depth, state.before, left}));
  }
  double stored(double depth, int set) const override { return law(set).stored(depth); }
  const BarrierLaw& law(int set) const { return laws_[static_cast<std::size_t>(set)]; }

  std::vector<BarrierLaw> laws_;
};

void register_barrier(Registry& registry) {
  ParameterSpec thickness = real_parameter("thickness", "m", 1e-3, {.low = 0, .low_open = true},
                                           "D, distance before the stop at which the barrier is first felt");
  thickness.per_lane = true;
  registry.add_contact(
      {.name = "barrier",
       .summary = "a logarithmic barrier in front of each stop: no penetration, ever",
       .text =
           R"(From D before the stop on a point is pushed back by the barrier −κ δ² ln(1 − δ/D), δ = D − clearance,
          smooth where it begins and without bound at the stop: with an evaluation at the end of the step a point
          never reaches it. The smaller κ and D, the nearer to a rigid stop, and the stiffer. Nothing is lost by the
          law; evaluated at the end of the step the scheme loses at each impact what the step does not resolve. )" +
           std::string(evaluation_text) +
           R"(Explicit, midpoint or hybrid, a step may land beyond the stop, where the law has no energy and the run
          fails.)",
       .source = R"(Li, Ferguson, Schneider, Langlois, Zorin, Panozzo, Jiang and Kaufman (2020), Incremental potential
          contact, eq. 6; )" +
                 std::string(evaluation_source),
       .parameters = {stiffness_parameter("N/m", "κ, scale of the barrier at each contact point"), thickness,
                      evaluation_parameter()}},
      [](const Parameters& p) { return std::make_unique<Barrier>(evaluation_of(p)); });
}

}  // namespace

RICOCHET_PLUGIN(contact, barrier, register_barrier)
