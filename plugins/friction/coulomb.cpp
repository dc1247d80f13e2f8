#include <ricochet/contact_solvers/friction_solver.hpp>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// −u in the normal cone of |p| ≤ s: what holds does not move, what moves is pushed back by s.
class Coulomb final : public FrictionLaw {
 public:
  explicit Coulomb(const Parameters& parameters) : settles_(parameters.word("ringing") == "refuse") {}
  void prepare(int points, int rows) override { solver_.prepare(points, rows); }
  LaneOutcome solve(FrictionProblem& problem) override { return solver_.solve(problem); }
  bool must_settle() const override { return settles_; }

 private:
  bool settles_;
  FrictionSolver solver_;
};

void register_coulomb(Registry& registry) {
  registry.add_friction(
      {.name = "coulomb",
       .summary = "Coulomb friction as it is: a point holds exactly, or slides against its bound",
       .text = R"(A point whose effort stays within μ times the normal force does not move at all, and drifts by
          nothing however long it is held. One that slides is pushed back by that bound, against its motion. Two
          tangents share one disc, so that no direction is special. No stiffness and no speed regularises it: the
          efforts of a stage are found together.)",
       .source = "Coulomb (1785); Moreau (1988), Unilateral contact and dry friction in finite freedom dynamics",
       .parameters = {word_parameter("ringing", {"refuse", "allow"}, "refuse",
                                     "whether schemes run under which efforts of a held point alternate for ever")},
       .words = "exact friction"},
      [](const Parameters& parameters) { return std::make_unique<Coulomb>(parameters); });
}

}  // namespace

RICOCHET_PLUGIN(friction, coulomb, register_coulomb)
