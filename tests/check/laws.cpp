// Laws with one thing wrong, each caught by the check that looks at it.
#include <catch2/catch.hpp>
#include <cfenv>
#include <cmath>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contact_solvers/pointwise_solver.hpp>
#include <ricochet/contract/contact_law.hpp>

#include "runners/check/allocation_count.hpp"
#include "runners/check/law_checks.hpp"
#include "tests/check/sound_schemes.hpp"
#include "tests/dented_stop.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using checking::CheckResult;
using checking::Finding;

namespace {

enum class Wrong {
  nothing,
  effort,         // three times what it should be
  allocates,      // by operator new
  allocates_raw,  // by malloc, as Eigen does
  stiffness,      // the slope it tells
  constant,       // the one stiffness it declares
  potential,
  dissipation,
  pulls,
  neighbour,       // writes a lane that is not touched
  lane_before,     // depends on the lane before it
  memory_of_last,  // adds the effort of the last step
  residual,        // owns up to nothing while it stops early
  no_number,
  no_number_alone,  // where no effort moves the one point
  unanswered_alone  // says there that it did not converge
};

constexpr double kappa = 2e4;

class FlawedLaw final : public ContactLaw {
 public:
  FlawedLaw(bool rigid, Wrong wrong) : rigid_(rigid), wrong_(wrong) {}
  std::optional<Evaluation> reads() const override {
    return rigid_ ? std::nullopt : std::optional(Evaluation::implicit_end);
  }
  void prepare(int points, std::span<const Parameters>) override { solver_.prepare(points); }
  void solve(ReducedProblem& problem) override {
    if (wrong_ == Wrong::allocates) kept_.assign(static_cast<std::size_t>(problem.points) + ++calls_, 0.0);
    if (wrong_ == Wrong::allocates_raw) {
      void* volatile raw = std::malloc(64);
      std::free(raw);
    }
    double lane_before = 0;
    for (const int lane : problem.touched) {
      const auto at = [&](int i) { return i * problem.lanes + lane; };
      const double last = problem.effort[lane];
      problem.outcome[lane] = solver_.solve(*problem.delassus, problem.reach, rigid_ ? 0.0 : 1 / kappa,
                                            problem.free + lane, problem.lower + lane, problem.upper + lane,
                                            problem.effort + lane, problem.points, problem.lanes);
      for (int i = 0; i < problem.points; ++i) {
        double& p = problem.effort[at(i)];
        if (wrong_ == Wrong::effort) p *= 3;
        if (wrong_ == Wrong::pulls) p = -p;
        if (wrong_ == Wrong::lane_before) p += lane_before;
        if (wrong_ == Wrong::memory_of_last && last != 0) p += 0.1 * last;
        if (wrong_ == Wrong::residual) p *= 0.99;
        if (wrong_ == Wrong::no_number) p = std::nan("");
        const bool alone = problem.points == 1 && problem.reach == 0;
        if (wrong_ == Wrong::no_number_alone && alone) p = std::nan("");
        if (wrong_ == Wrong::unanswered_alone && alone) problem.outcome[lane].converged = false;
      }
      lane_before += 1e-9 * problem.effort[at(0)];
      if (wrong_ == Wrong::dissipation) problem.outcome[lane].dissipation = 1;
    }
    if (wrong_ == Wrong::neighbour) problem.effort[0] = 0;
  }
  double potential(const StopState& at) const override {
    const double depth = at.depth;
    if (rigid_) return wrong_ == Wrong::potential ? depth : 0;
    return (wrong_ == Wrong::potential ? 1.0 : 0.5) * kappa * depth * depth;
  }
  std::optional<ContactSlopes> linear_slopes(int) const override {
    if (rigid_) return std::nullopt;
    return ContactSlopes{.stiffness = wrong_ == Wrong::constant ? 2 * kappa : kappa};
  }
  bool offers_slopes() const override { return !rigid_; }
  ContactSlopes slopes(int, int) const override {
    return {.stiffness = wrong_ == Wrong::stiffness ? 0.5 * kappa : kappa};
  }

 private:
  bool rigid_;
  Wrong wrong_;
  BoxSolver solver_;
  std::vector<double> kept_;
  std::size_t calls_ = 0;
};

Entry<ContactLaw> law_entry(bool rigid, Wrong wrong) {
  Entry<ContactLaw> entry{full_manual("made-here"), {}, ""};
  entry.make = [=](const Parameters&) { return std::make_unique<FlawedLaw>(rigid, wrong); };
  return entry;
}

enum class Softened { none, sound, indefinite, skew, changing, poor_refusal };

/// Springs by a mean over the step, on a structure that they soften.
class SofteningLaw final : public PointwiseContact {
 public:
  SofteningLaw(StepForce force, bool says, Softened change)
      : PointwiseContact({Evaluation::conserving, force}), says_(says), change_(change) {}
  bool changes_problem() const override { return change_ != Softened::none; }
  std::optional<Refusal> prepare_problem(ContactStructure& structure) override {
    static int calls = 0;
    if (change_ == Softened::poor_refusal) return Refusal{"this cannot be done at all"};
    const double left = change_ == Softened::indefinite ? -0.1 : change_ == Softened::changing ? 0.9 / ++calls : 0.9;
    structure.stiffness *= left;
    if (change_ == Softened::skew && structure.stiffness.rows() > 1) structure.stiffness.coeffRef(0, 1) *= 1.5;
    return std::nullopt;
  }

 private:
  void set_lanes(std::span<const Parameters>) override {}
  PointForce at(const ContactState& state) const override {
    return state.depth > 0 ? PointForce{.value = kappa * state.depth, .stiffness = kappa} : PointForce{};
  }
  // One that says more than it keeps takes the force at the end.
  PointForce gradient(const ContactState& state) const override {
    if (!says_) return at(state);
    const double work = stored(std::max(state.depth, 0.0), 0) - stored(std::max(state.before, 0.0), 0);
    const double way = state.depth - state.before;
    return way == 0 ? at(state) : PointForce{.value = work / way};
  }
  double stored(double depth, int) const override { return 0.5 * kappa * depth * depth; }

  bool says_;
  Softened change_;
};

CheckResult of_softening(StepForce force, bool says, Softened change, const std::string& check) {
  Entry<ContactLaw> entry{full_manual("made-here"), {}, ""};
  entry.make = [=](const Parameters&) { return std::make_unique<SofteningLaw>(force, says, change); };
  return one_check(checking::law_checks(), entry, check);
}

void caught(bool rigid, Wrong wrong, const std::string& check, const std::string& words) {
  const CheckResult result = one_check(checking::law_checks(), law_entry(rigid, wrong), check);
  INFO(text_of({result}));
  CHECK(result.finding == Finding::fails);
  REQUIRE_FALSE(result.sentences.empty());
  CHECK_THAT(result.sentences.front(), Contains(words));
}

}  // namespace

TEST_CASE("check: laws that do what they say pass every check") {
  for (const bool rigid : {true, false})
    for (const auto& check : checking::law_checks()) {
      const CheckResult result = one_check(checking::law_checks(), law_entry(rigid, Wrong::nothing), check.name);
      INFO(text_of({result}));
      CHECK(result.finding != Finding::fails);
    }
}

TEST_CASE("check: wrong efforts of rigid laws are caught") {
  caught(true, Wrong::effort, "complementarity", "the law owns up to");
  caught(true, Wrong::residual, "complementarity", "the law owns up to");
  caught(true, Wrong::pulls, "complementarity", "of the deepest violation");
  caught(true, Wrong::no_number, "complementarity", "not finite");
}

TEST_CASE("check: wrong efforts of compliant laws are caught") {
  caught(false, Wrong::effort, "solution", "differ by");
  caught(false, Wrong::effort, "potential", "its potential grows by");
  caught(false, Wrong::effort, "constant stiffness", "declares that its force is 20000 N/m");
  caught(false, Wrong::pulls, "force law", "pulls");
  caught(false, Wrong::no_number, "force law", "no finite force");
  caught(false, Wrong::no_number_alone, "solution", "answers one point no force");
  caught(false, Wrong::unanswered_alone, "solution", "answers one point no force");
  for (const char* check : {"slopes", "potential", "constant stiffness", "dissipation"})
    caught(false, Wrong::no_number_alone, check, "");
}

TEST_CASE("check: wrong slopes, stiffness, potential and dissipation are caught") {
  caught(false, Wrong::stiffness, "slopes", "differences give");
  caught(false, Wrong::constant, "constant stiffness", "40000 N/m");
  caught(false, Wrong::potential, "potential", "its potential grows by");
  caught(true, Wrong::potential, "potential", "a rigid law stores nothing");
  caught(false, Wrong::dissipation, "dissipation", "reports 1 W");
}

TEST_CASE("check: an allocation in solve() is caught, whoever makes it") {
  if (!checking::allocations_are_counted()) return;
  for (const bool rigid : {true, false}) {
    caught(rigid, Wrong::allocates, "no allocation", "size what it needs in prepare()");
    caught(rigid, Wrong::allocates_raw, "no allocation", "solve() allocates 1 time");
  }
}

TEST_CASE("check: a law that changes how its thread rounds, in whatever function, is caught") {
  class Rounding final : public PointwiseContact {
   public:
    explicit Rounding(bool puts_back)
        : PointwiseContact({Evaluation::implicit_end, StepForce::at_measure}), back_(puts_back) {}

   private:
    void set_lanes(std::span<const Parameters>) override {
      const int before = std::fegetround();
      std::fesetround(FE_UPWARD);
      if (back_) std::fesetround(before);
    }
    PointForce at(const ContactState& state) const override {
      return state.depth > 0 ? PointForce{.value = kappa * state.depth, .stiffness = kappa} : PointForce{};
    }
    PointForce gradient(const ContactState& state) const override { return at(state); }
    double stored(double depth, int) const override { return 0.5 * kappa * depth * depth; }
    bool back_;
  };
  for (const bool puts_back : {true, false})
    for (const bool child : {true, false}) {
      Registry registry;
      registry.add_contact(full_manual("made-here"),
                           [=](const Parameters&) { return std::make_unique<Rounding>(puts_back); });
      const auto results = checking::check_law(*registry.contact("made-here"), {.child = child});
      INFO(text_of(results));
      const CheckResult& state = results.back();
      CHECK(state.check == "floating-point state");
      CHECK((state.finding == Finding::ok) == puts_back);
      if (!puts_back) CHECK_THAT(state.sentences.at(0), Contains("prepare() leaves the rounding"));
      CHECK(std::fegetround() == FE_TONEAREST);
    }
}

TEST_CASE("check: lanes that know of each other, or of lanes that are not theirs, are caught") {
  caught(true, Wrong::neighbour, "untouched lanes", "which is not in `touched`");
  caught(false, Wrong::lane_before, "lanes independent", "lanes must not know of each other");
}

TEST_CASE("check: a solution that depends on where the search begins is caught") {
  caught(true, Wrong::memory_of_last, "warm start", "another solution");
  caught(false, Wrong::memory_of_last, "warm start", "another solution");
}

TEST_CASE("check: a law that conserves energy is measured, and one that only says so is caught") {
  const std::string check = "energy over a step";
  CHECK(of_softening(StepForce::gradient, true, Softened::none, check).finding == Finding::ok);
  const CheckResult wrong = of_softening(StepForce::gradient, false, Softened::none, check);
  CHECK(wrong.finding == Finding::fails);
  CHECK_THAT(text_of({wrong}), Contains("declares that it conserves energy"));
  // Half of it is kept where a step leaves the stop: nothing was declared, and what is so is said.
  const CheckResult hybrid = of_softening(StepForce::hybrid, true, Softened::none, check);
  CHECK(hybrid.finding == Finding::not_declared);
  CHECK_THAT(text_of({hybrid}), Contains("gives nothing") || Contains("keeps"));
}

TEST_CASE("check: a changed problem that is not symmetric, not positive or not the same twice is caught") {
  const auto result = [](Softened change) {
    return of_softening(StepForce::midpoint, true, change, "changed problem");
  };
  CHECK(result(Softened::none).finding == Finding::not_declared);
  CHECK(result(Softened::sound).finding == Finding::ok);
  for (const auto& [change, words] : {std::pair{Softened::indefinite, "not positive"},
                                      {Softened::skew, "not symmetric"},
                                      {Softened::changing, "another contact law"},
                                      {Softened::poor_refusal, "no remedy"}}) {
    const CheckResult wrong = result(change);
    INFO(text_of({wrong}));
    CHECK(wrong.finding == Finding::fails);
    CHECK_THAT(text_of({wrong}), Contains(words));
  }
}

TEST_CASE("check: a law that remembers stores what it gives back, and one that forgets its dent does not") {
  const auto of = [](bool forgets) {
    Entry<ContactLaw> entry{full_manual("made-here"), {}, ""};
    entry.make = [=](const Parameters&) { return std::make_unique<DentedStop>(forgets); };
    return one_check(checking::law_checks(), entry, "potential");
  };
  const CheckResult kept = of(false), forgotten = of(true);
  INFO(text_of({kept, forgotten}));
  CHECK(kept.finding == Finding::ok);
  CHECK(forgotten.finding == Finding::fails);
  REQUIRE_FALSE(forgotten.sentences.empty());
  CHECK_THAT(forgotten.sentences.front(), Contains("where it has let go"));
}
