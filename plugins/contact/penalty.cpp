#include <ricochet/algebra/box_problem.hpp>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

Evaluation evaluation_of(const std::string& word) {
  if (word == "averaged") return Evaluation::averaged;
  if (word == "explicit") return Evaluation::explicit_start;
  return Evaluation::implicit_end;
}

/// Linear springs behind the stops: p = κ (lower − g)₊ − κ (g − upper)₊. With g = g° + reach·W p this is the box
/// problem lower ≤ g + p/κ ⊥ p ≤ upper: a shifted diagonal, closed form when reach = 0.
class Penalty final : public ContactLaw {
 public:
  explicit Penalty(Evaluation evaluation) : evaluation_(evaluation) {}
  std::optional<Evaluation> reads() const override { return evaluation_; }

  void prepare(int points, std::span<const Parameters> lanes) override {
    solver_.prepare(points);
    stiffness_.clear();
    for (const Parameters& lane : lanes) stiffness_.push_back(lane.real("stiffness"));
  }

  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched)
      problem.outcome[lane] = solver_.solve(*problem.delassus, problem.reach, 1 / stiffness(lane), problem.free + lane,
                                            problem.lower + lane, problem.upper + lane, problem.effort + lane,
                                            problem.points, problem.lanes);
  }

  double potential(double depth, int lane) const override { return 0.5 * stiffness(lane) * depth * depth; }
  std::optional<double> constant_stiffness(int lane) const override { return stiffness(lane); }
  bool offers_slopes() const override { return true; }
  ContactSlopes slopes(int, int lane) const override { return {.stiffness = stiffness(lane)}; }
  bool closed_form(int points) const override { return points == 1; }
  std::string how_solved() const override { return "one point: closed form; more: active set with a finite fallback"; }

 private:
  double stiffness(int lane) const { return stiffness_[static_cast<std::size_t>(lane)]; }
  Evaluation evaluation_;
  BoxSolver solver_;
  std::vector<double> stiffness_;
};

void register_all(Registry& registry) {
  ParameterSpec stiffness = real_parameter("stiffness", "N/m", std::nullopt, {.low = 0, .low_open = true},
                                           "κ, stiffness of the spring at each contact point");
  stiffness.per_lane = true;
  stiffness.role = ParameterRole::stiffness;
  registry.add_contact(
      {.name = "penalty",
       .summary = "linear springs behind the stops",
       .text =
           "A point that passes a stop by δ is pushed back with κ δ. Where in the step δ is measured is `evaluation`: "
           "implicit at the end of the step, averaged over the levels over which the scheme averages the elastic "
           "force, "
           "explicit at what is known when the step begins (then the step is limited by √(m/κ)). The restitution of "
           "the time scheme has no part in it. The stiffness is per contact point: with stops at all nodes, the "
           "stop's stiffness per metre grows as the mesh is refined.",
       .source = "Paoli and Schatzman (2002), penalty approximation; evaluation levels after Dumont and Paoli (2006)",
       .parameters = {stiffness, word_parameter("evaluation", {"implicit", "averaged", "explicit"}, "implicit",
                                                "the level at which the spring force is evaluated")}},
      [](const Parameters& p) { return std::make_unique<Penalty>(evaluation_of(p.word("evaluation"))); });
}

}  // namespace

RICOCHET_PLUGIN(contact, penalty, register_all)
