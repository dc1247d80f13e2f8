// What a law touches beyond the arrays that it is given is named, and ends the check alone.
#include <catch2/catch.hpp>
#include <ricochet/contact_solvers/pointwise_solver.hpp>

#include "runners/check/law_checks.hpp"
#include "tests/check/sound_schemes.hpp"
#include "tests/dented_stop.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using checking::CheckResult;
using checking::Finding;

namespace guarded_arrays {
namespace {

using Trespass = void (*)(ReducedProblem&);

class Trespasser final : public ContactLaw {
 public:
  explicit Trespasser(Trespass trespass) : trespass_(trespass) {}
  std::optional<Evaluation> reads() const override { return inner_.reads(); }
  int memory_per_point() const override { return inner_.memory_per_point(); }
  void prepare(int points, std::span<const Parameters> lanes) override { inner_.prepare(points, lanes); }
  void solve(ReducedProblem& problem) override {
    inner_.solve(problem);
    trespass_(problem);
  }
  double potential(const StopState& at) const override { return inner_.potential(at); }

 private:
  Trespass trespass_;
  DentedStop inner_;
};

[[maybe_unused]] int numbers(const ReducedProblem& problem) {
  return problem.points * problem.lanes;
}

Entry<ContactLaw> entry_of(Trespass trespass) {
  Entry<ContactLaw> entry{full_manual("made-here"), {}, ""};
  entry.make = [=](const Parameters&) { return std::make_unique<Trespasser>(trespass); };
  return entry;
}

}  // namespace

#ifndef RICOCHET_SANITIZED  // which has a handler of its own
TEST_CASE("check: what a law writes beyond the arrays that it is given is named") {
  const std::pair<Trespass, const char*> all[] = {
      {[](ReducedProblem& p) { p.memory[2 * numbers(p)] = 1; }, "beyond the end of the array `memory`"},
      {[](ReducedProblem& p) { p.memory[100000] = 1; }, "beyond the end of the array `memory`"},
      {[](ReducedProblem& p) { p.memory[1000000] = 1; }, "beyond the end of the array `memory`"},
      {[](ReducedProblem& p) { p.memory[-1] = 1; }, "before the beginning of the array `memory`"},
      {[](ReducedProblem& p) { p.memory[-4000] = 1; }, "before the beginning of the array `memory`"},
      {[](ReducedProblem& p) { p.effort[numbers(p)] = 0; }, "beyond the end of the array `effort`"},
      {[](ReducedProblem& p) { p.effort[-3] = 0; }, "before the beginning of the array `effort`"},
      {[](ReducedProblem& p) { p.outcome[p.lanes].residual = 0; }, "beyond the end of the array `outcome`"},
      {[](ReducedProblem& p) { const_cast<double*>(p.free)[0] = 7; }, "into the array `free`"},
      {[](ReducedProblem& p) { const_cast<double*>(p.lower)[numbers(p)] = 7; }, "beyond the end of the array `lower`"},
      {[](ReducedProblem& p) { const_cast<double*>(p.delassus->column(0))[0] = 7; },
       "writes into, which it may only read, the array `column`"},
  };
  for (const auto& [trespass, words] : all) {
    const CheckResult result = one_check(checking::law_checks(), entry_of(trespass), "arrays");
    INFO(words << "\n" << text_of({result}));
    CHECK(result.finding == Finding::fails);
    REQUIRE_FALSE(result.sentences.empty());
    CHECK_THAT(result.sentences.front(), Contains(words));
  }
}

TEST_CASE("check: after a law went beyond an array, the others are checked") {
  const auto results = checking::check_law(entry_of([](ReducedProblem& p) { p.memory[5000] = 1; }), {.child = true});
  // And the floating-point state.
  CHECK(results.size() == checking::law_checks().size() + 1);
  CHECK_THAT(text_of(results), Contains("FAILS  arrays  reaches beyond the end of the array `memory`"));
}
#endif

TEST_CASE("check: a law that keeps to its arrays passes") {
  const CheckResult result = one_check(checking::law_checks(), entry_of([](ReducedProblem&) {}), "arrays");
  INFO(text_of({result}));
  CHECK(result.finding == Finding::ok);
}

}  // namespace guarded_arrays
