#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contact_solvers/pointwise_solver.hpp>
#include <utility>

#include "power_law.hpp"

namespace {

using namespace ricochet;

/// Linear springs behind the stops: p = κ (lower − g)₊ − κ (g − upper)₊. With g = g° + reach·W p this is the box
/// problem lower ≤ g + p/κ ⊥ p ≤ upper: a shifted diagonal, closed form when reach = 0. Stops that pass each other
/// leave no box: both springs push there, and each point is solved for as under any other law.
class Penalty final : public ContactLaw, private PointwiseLaw {
 public:
  explicit Penalty(Evaluation evaluation) : evaluation_(evaluation) {}
  std::optional<Evaluation> reads() const override { return evaluation_; }

  void prepare(int points, std::span<const Parameters> lanes) override {
    take(points, static_cast<int>(lanes.size()), lanes, false);
  }
  bool per_point() const override { return true; }
  void prepare_points(int points, int lanes, std::span<const Parameters> sets) override {
    take(points, lanes, sets, true);
  }

  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched) {
      crossed_[static_cast<std::size_t>(lane)] = crosses(problem.lane(lane));
      // Prepared once, at the first such stops: scenes without them need no such memory.
      if (crossed_[static_cast<std::size_t>(lane)] != 0 && !std::exchange(crosses_, true))
        both_sides_.prepare(problem.points, static_cast<int>(crossed_.size()), own_);
      problem.outcome[lane] = crossed_[static_cast<std::size_t>(lane)] != 0
                                  ? both_sides_.solve(*this, problem, lane)
                                  : solver_.solve(problem.lane(lane), compliance(lane));
    }
  }

  double potential(const StopState& at) const override { return 0.5 * stiffness(at.set) * at.depth * at.depth; }
  std::optional<ContactSlopes> linear_slopes(int set) const override {
    return ContactSlopes{.stiffness = stiffness(set)};
  }
  bool offers_slopes() const override { return true; }
  ContactSlopes slopes(int point, int lane) const override {
    if (crossed_[static_cast<std::size_t>(lane)] != 0) return both_sides_.slopes(point, lane);
    return {.stiffness = stiffness(own_ ? point * static_cast<int>(crossed_.size()) + lane : lane)};
  }
  bool closed_form(int points) const override { return points == 1; }
  std::string how_solved() const override { return "one point: closed form; more: active set with a finite fallback"; }

 private:
  void take(int points, int lanes, std::span<const Parameters> sets, bool own) {
    solver_.prepare(points);
    crossed_.assign(static_cast<std::size_t>(lanes), 0);
    crosses_ = false;
    own_ = own;
    stiffness_.clear();
    compliance_.clear();
    for (const Parameters& set : sets) {
      stiffness_.push_back(set.real("stiffness"));
      compliance_.push_back(1 / stiffness_.back());
    }
  }
  double stiffness(int set) const { return stiffness_[static_cast<std::size_t>(set)]; }
  // 1/κ of each point.
  Strided<const double> compliance(int lane) const {
    return {compliance_.data() + lane, own_ ? static_cast<int>(crossed_.size()) : 0};
  }
  static unsigned char crosses(const LaneProblem& lane) {
    for (int i = 0; i < lane.points; ++i)
      if (lane.lower[i] > lane.upper[i]) return 1;
    return 0;
  }
  PointForce force(const ContactState& state) const override {
    return PowerLaw{stiffness(state.set), 1}.at(state.depth);
  }
  Evaluation evaluation_;
  BoxSolver solver_;
  PointwiseSolver both_sides_;
  std::vector<unsigned char> crossed_;  // of each lane, whether its last solve had stops that pass each other
  bool crosses_ = false;                // whether any has, and the solver of both sides is there
  bool own_ = false;                    // whether each point has a set of its own
  std::vector<double> stiffness_, compliance_;
};

/// The same springs by a mean over the step (see StepForce), U = ½κδ₊². Within contact all of them are the mean of both
/// ends; where it begins or ends the force is not linear any more.
class MeanPenalty final : public PointwiseContact {
 public:
  using PointwiseContact::PointwiseContact;
  std::optional<ContactSlopes> linear_slopes(int set) const override {
    return spring_slopes(law(set).stiffness, reads());
  }

 private:
  void set_lanes(std::span<const Parameters> lanes) override {
    laws_.clear();
    for (const Parameters& lane : lanes) laws_.push_back({lane.real("stiffness"), 1});
  }
  PointForce at(const ContactState& state) const override { return law(state.set).at(state.depth); }
  PointForce gradient(const ContactState& state) const override {
    return law(state.set).between(state.depth, state.before);
  }
  double stored(double depth, int set) const override { return law(set).stored(depth); }
  const PowerLaw& law(int set) const { return laws_[static_cast<std::size_t>(set)]; }

  std::vector<PowerLaw> laws_;
};

void register_penalty(Registry& registry) {
  registry.add_contact(
      {.name = "penalty",
       .summary = "linear springs behind the stops",
       .text = "A point that passes a stop by δ is pushed back with κ δ. " + std::string(evaluation_text) +
               R"(Evaluated explicit, the step is limited by √(m/κ); hybrid never gives energy. The restitution of the
          time scheme has no part in it. The stiffness is per contact point: with stops at all nodes, the stop's
          stiffness per metre grows as the mesh is refined.)",
       .source = R"(Paoli and Schatzman (2002), penalty approximation; evaluation levels after Dumont and Paoli
          (2006); Armero and Petocz (1998); )" +
                 std::string(evaluation_source),
       .parameters = {with_role(stiffness_parameter("N/m", "κ, stiffness of the spring at each contact point"),
                                ParameterRole::stiffness),
                      evaluation_parameter()}},
      [](const Parameters& p) -> std::unique_ptr<ContactLaw> {
        const ForceEvaluation evaluation = evaluation_of(p);
        if (evaluation.force != StepForce::at_measure) return std::make_unique<MeanPenalty>(evaluation);
        return std::make_unique<Penalty>(evaluation.measure);
      });
}

}  // namespace

RICOCHET_PLUGIN(contact, penalty, register_penalty)
