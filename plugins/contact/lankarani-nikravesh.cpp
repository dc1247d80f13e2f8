#include <limits>

#include "power_law.hpp"

namespace {

using namespace ricochet;

/// Hunt–Crossley's force with χ = 3(1 − e²)/(4v⁻), v⁻ the speed at which the point closed when this contact began.
///
/// Memory: one number per point, v⁻ while the point is pushed, −v⁻ once it has been let go. A point that closes again
/// from there begins a new contact; one that is still leaving the old indentation keeps its v⁻. Zero: never closed on
/// its stop, hence elastic.
class LankaraniNikravesh final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  bool reads_rate() const override { return true; }
  int memory_per_point() const override { return 1; }
  // v⁻ depends on the state as well, and that derivative is not carried.
  bool offers_slopes() const override { return false; }

  void solve(ReducedProblem& problem) override {
    problem_ = &problem;
    for (const int lane : problem.touched) note_entries(problem.lane(lane), problem.memory_of(lane));
    PointwiseContact::solve(problem);
    for (const int lane : problem.touched)
      for (int i = 0; i < problem.points; ++i) {
        double& kept = problem.memory_of(lane)[i];
        kept = problem.lane(lane).effort[i] != 0 ? std::abs(kept) : -std::abs(kept);
      }
  }

 private:
  static void note_entries(const LaneProblem& lane, Strided<double> memory) {
    for (int i = 0; i < lane.points; ++i) {
      if (memory[i] > 0) continue;
      const double lower = lane.lower[i] - lane.free[i], upper = lane.free[i] - lane.upper[i];
      if (!(std::max(lower, upper) > 0)) continue;
      const double closing = lower > upper ? -lane.rate_free[i] : lane.rate_free[i];
      if (closing > 0)
        memory[i] = closing;
      else if (memory[i] == 0)
        memory[i] = std::numeric_limits<double>::infinity();  // it begins within the stop, and has never closed on it
    }
  }

  void set_lanes(std::span<const Parameters> lanes) override {
    laws_ = power_laws(lanes);
    loss_.clear();
    for (const Parameters& lane : lanes) loss_.push_back(1 - lane.real("restitution") * lane.real("restitution"));
  }
  double damping(const ContactState& state) const {
    const double entry = std::abs(problem_->memory_of(state.lane)[state.point]);
    return entry > 0 ? 0.75 * loss_[static_cast<std::size_t>(state.set)] / entry : 0.0;
  }
  PointForce at(const ContactState& state) const override {
    return damped(laws_[static_cast<std::size_t>(state.set)].at(state.depth), damping(state), state.rate);
  }
  PointForce gradient(const ContactState& state) const override {
    return damped(laws_[static_cast<std::size_t>(state.set)].between(state.depth, state.before), damping(state),
                  state.rate);
  }
  double stored(double depth, int set) const override { return laws_[static_cast<std::size_t>(set)].stored(depth); }

  std::vector<PowerLaw> laws_;
  std::vector<double> loss_;
  const ReducedProblem* problem_ = nullptr;  // while it is solved
};

void register_lankarani_nikravesh(Registry& registry) {
  ParameterSpec restitution =
      real_parameter("restitution", "1", std::nullopt, {.low = 0, .high = 1}, "e, the restitution that is asked for");
  restitution.per_lane = true;
  registry.add_contact(
      {.name = "lankarani-nikravesh",
       .summary = "Hunt and Crossley's contact, its damping from a restitution coefficient",
       .text =
           R"(A point that passes a stop by δ is pushed back with k δⁿ (1 + χ δ̇), never pulled, χ = 3(1 − e²)/(4 v⁻)
          where v⁻ is the speed at which the point closed when this contact began. The formula for χ supposes e near
          1, and the law does not deliver the e that it is given: it asks for 0.8 and gives 0.847102, for 0.5 and
          gives 0.725241, whatever k, n, the mass and the speed. A point that is found beyond its stop without having
          closed on it is not damped. )" +
           std::string(damped_evaluation_text) +
           "As the law remembers v⁻, it offers no tangents: exponents are those of twins.",
       .source = R"(Lankarani and Nikravesh (1990), A contact force model with hysteresis damping for impact analysis
          of multibody systems)",
       .parameters = {stiffness_parameter("N/m^n", "k, force at rest at a depth of 1 m at each contact point"),
                      exponent_parameter(), restitution, evaluation_parameter()},
       .words = "Lankarani–Nikravesh"},
      [](const Parameters& p) { return std::make_unique<LankaraniNikravesh>(evaluation_of(p)); });
}

}  // namespace

RICOCHET_PLUGIN(contact, lankarani_nikravesh, register_lankarani_nikravesh)
