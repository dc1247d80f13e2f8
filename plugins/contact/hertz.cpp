#include "power_law.hpp"

namespace {

using namespace ricochet;

/// p = k δ₊ⁿ at each point and side, U = k δ₊ⁿ⁺¹/(n+1).
class Hertz final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  std::optional<ContactSlopes> linear_slopes(int set) const override {
    if (law(set).exponent != 1) return std::nullopt;
    return spring_slopes(law(set).stiffness, reads());
  }

 private:
  void set_lanes(std::span<const Parameters> lanes) override { laws_ = power_laws(lanes); }
  PointForce at(const ContactState& state) const override { return law(state.set).at(state.depth); }
  PointForce gradient(const ContactState& state) const override {
    return law(state.set).between(state.depth, state.before);
  }
  double stored(double depth, int set) const override { return law(set).stored(depth); }
  const PowerLaw& law(int set) const { return laws_[static_cast<std::size_t>(set)]; }

  std::vector<PowerLaw> laws_;
};

void register_hertz(Registry& registry) {
  registry.add_contact(
      {.name = "hertz",
       .summary = "elastic contact whose force grows with a power of the depth",
       .text =
           R"(A point that passes a stop by δ is pushed back with k δⁿ, as a sphere on a plane is for n = 3/2; n = 1
          is the penalty. Nothing is lost: a mass m that arrives at speed v goes in by ((n+1) m v²/(2k))^(1/(n+1)) and
          leaves at v. )" +
           std::string(evaluation_text) +
           R"(The restitution of the time scheme has no part in it. For n = 1 hybrid never gives energy; for other n
          it may, little.)",
       .source = "Hertz (1881), Über die Berührung fester elastischer Körper; " + std::string(evaluation_source),
       .parameters = {stiffness_parameter("N/m^n", "k, force at a depth of 1 m at each contact point"),
                      exponent_parameter(), evaluation_parameter()},
       .words = "Hertz"},
      [](const Parameters& p) { return std::make_unique<Hertz>(evaluation_of(p)); });
}

}  // namespace

RICOCHET_PLUGIN(contact, hertz, register_hertz)
