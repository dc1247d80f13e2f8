#include "power_law.hpp"

namespace {

using namespace ricochet;

/// p = k (δ + D)₊, δ the depth beyond the stop and D the thickness of a layer in front of it.
class Layer final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  double layer(int set) const override { return thickness_[static_cast<std::size_t>(set)]; }
  // With a thickness the force is no multiple of the depth beyond the stop.
  std::optional<ContactSlopes> linear_slopes(int set) const override {
    if (layer(set) != 0) return std::nullopt;
    return spring_slopes(laws_[static_cast<std::size_t>(set)].stiffness, reads());
  }

 private:
  void set_lanes(std::span<const Parameters> lanes) override {
    laws_.clear();
    thickness_.clear();
    for (const Parameters& lane : lanes) {
      laws_.push_back({lane.real("stiffness"), 1});
      thickness_.push_back(lane.real("thickness"));
    }
  }
  PointForce at(const ContactState& state) const override {
    return laws_[static_cast<std::size_t>(state.set)].at(state.depth);
  }
  PointForce gradient(const ContactState& state) const override {
    return laws_[static_cast<std::size_t>(state.set)].between(state.depth, state.before);
  }
  double stored(double depth, int set) const override { return laws_[static_cast<std::size_t>(set)].stored(depth); }

  std::vector<PowerLaw> laws_;
  std::vector<double> thickness_;
};

void register_layer(Registry& registry) {
  ParameterSpec thickness = real_parameter("thickness", "m", 1e-3, {.low = 0},
                                           "D, distance before the stop at which the layer is first touched");
  thickness.per_lane = true;
  registry.add_contact(
      {.name = "layer",
       .summary = "a compliant layer in front of each stop",
       .text = R"(Each stop is covered by a layer of thickness D that pushes back with k times its compression: from D
          before the stop on, and beyond it with the same stiffness. Penetration is measured at the stop, and is zero
          as long as the layer holds. With D = 0 it is the penalty. )" +
               std::string(evaluation_text) +
               R"(With stops at all nodes the stiffness per metre grows as the mesh is refined. The restitution of the
          time scheme has no part in it.)",
       .source = "Winkler (1867), elastic foundation, one spring per contact point; " + std::string(evaluation_source),
       .parameters = {with_role(stiffness_parameter("N/m", "k, stiffness of the layer at each contact point"),
                                ParameterRole::stiffness),
                      thickness, evaluation_parameter()}},
      [](const Parameters& p) { return std::make_unique<Layer>(evaluation_of(p)); });
}

}  // namespace

RICOCHET_PLUGIN(contact, layer, register_layer)
