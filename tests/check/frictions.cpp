// Friction laws with one thing wrong, each caught by the check that looks at it; exact friction passes all.
#include <catch2/catch.hpp>
#include <functional>
#include <ricochet/contact_solvers/friction_solver.hpp>

#include "tests/check/sound_schemes.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using checking::CheckResult;
using checking::Finding;

namespace {

using Change = std::function<void(FrictionProblem& problem)>;

// Exact friction, and what is changed before and after it is found.
class Changed final : public FrictionLaw {
 public:
  Changed(Change before, Change after, double way) : before_(std::move(before)), after_(std::move(after)), way_(way) {}
  void prepare(int points, int rows) override { solver_.prepare(points, rows); }
  LaneOutcome solve(FrictionProblem& problem) override {
    if (before_) before_(problem);
    const LaneOutcome outcome = solver_.solve(problem);
    if (after_) after_(problem);
    return outcome;
  }
  double gives_way() const override { return way_; }

 private:
  Change before_, after_;
  double way_;
  FrictionSolver solver_;
};

Entry<FrictionLaw> entry(const Change& before, const Change& after, double way = 0) {
  Entry<FrictionLaw> made{full_manual("made-here"), {}, ""};
  made.make = [=](const Parameters&) { return std::make_unique<Changed>(before, after, way); };
  return made;
}

void caught(const std::string& check, const std::string& words, const Change& before, const Change& after,
            double way = 0) {
  const CheckResult result = one_check(checking::friction_checks(), entry(before, after, way), check);
  INFO(text_of({result}));
  CHECK(result.finding == Finding::fails);
  REQUIRE(!result.sentences.empty());
  CHECK_THAT(result.sentences.front(), Contains(words));
}

}  // namespace

TEST_CASE("exact friction passes every check of a friction law") {
  for (const auto& check : checking::friction_checks()) {
    const CheckResult result = one_check(checking::friction_checks(), entry({}, {}), check.name);
    INFO(text_of({result}));
    CHECK(result.finding == Finding::ok);
  }
}

TEST_CASE("friction laws with one thing wrong are caught") {
  caught("effort within its bound", "beyond the bound", {},
         [](FrictionProblem& problem) { problem.effort[0] *= 1 + 1e-9; });
  caught("takes energy, never gives", "it gives", {}, [](FrictionProblem& problem) { problem.effort[0] *= -1; });
  caught("no direction is special", "another effort", {}, [](FrictionProblem& problem) {
    for (int i = 0; i < problem.rows(); ++i) problem.effort[i] = std::max(problem.effort[i], -0.5 * problem.bound[0]);
  });
  const char* found = "one effort, found without memory";
  caught(found, "a point that sticks slides", {}, [](FrictionProblem& problem) {
    for (int i = 0; i < problem.points; ++i)
      if (problem.sticks[i] != 0) problem.slid[i] += 1e-3;
  });
  caught(found, "and slides at", {}, [](FrictionProblem& problem) {
    for (int i = 0; i < problem.points; ++i) problem.slid[i] *= 10;
  });
  caught(found, "below 0", {}, [](FrictionProblem& problem) {
    for (int i = 0; i < problem.points; ++i) problem.slid[i] *= -1;
  });
  caught(found, "does not stick by what it says", {}, [](FrictionProblem& problem) {
    for (int i = 0; i < problem.points; ++i) problem.sticks[i] = 0;
  });
  caught("holds and slides", "by what it says", {}, [](FrictionProblem& problem) { problem.slid[0] = 0; });
  caught("holds and slides", "drifts", {}, [](FrictionProblem& problem) { problem.effort[0] *= 0.99; });
  // Exact friction that says it were a spring of 1e6 N/m.
  caught("holds and slides", "gives way by 0 m", {}, {}, 1e-6);
}
