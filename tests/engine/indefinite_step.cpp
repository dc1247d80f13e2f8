// Whose numbers make a step indefinite: that is a fault, where a singular step is a refusal.
#include <ricochet/contract/plan_algebra.hpp>
#include <ricochet/engine/indefinite_step.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

using Of = IndefiniteStep::Of;
using Catch::Matchers::Contains;

constexpr double h = 1e-4;

/// A law that leaves the structure a share of its stiffness.
class Softening final : public ContactLaw {
 public:
  explicit Softening(double left) : left_(left) {}
  bool changes_problem() const override { return true; }
  std::optional<Refusal> prepare_problem(ContactStructure& structure) override {
    structure.stiffness = left_ * structure.stiffness;
    structure.measured = *structure.contact;
    return std::nullopt;
  }
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched) problem.outcome[lane] = {};
  }

 private:
  double left_;
};

SceneSpec damped_beam(double alpha) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = alpha;
  return scene;
}

StepPlan newmark() {
  return std::get<StepPlan>(plan_of({"newmark"}, h, {}));
}

/// What compile() says with each operator, and whose fault it finds; nothing where it makes a program.
std::vector<std::pair<std::optional<Of>, std::string>> said(const std::shared_ptr<const SemiDiscrete>& problem,
                                                            const StepPlan& plan,
                                                            const std::function<std::unique_ptr<ContactLaw>()>& law) {
  std::vector<std::pair<std::optional<Of>, std::string>> all;
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse}) {
    CompileOptions options;
    options.kind = kind;
    try {
      auto result = compile(problem, plan, h, law(), {scene_lane(*problem, {})}, options);
      const auto* refusal = std::get_if<Refusal>(&result);
      all.emplace_back(std::nullopt, refusal ? refusal->sentence.text : "");
    } catch (const IndefiniteStep& wrong) {
      all.emplace_back(wrong.of, wrong.what());
    }
  }
  return all;
}

std::unique_ptr<ContactLaw> no_law() {
  return make(registry().contact("none"), {"none"});
}

}  // namespace

TEST_CASE("a plan that weighs a matrix negatively is at fault where its S is indefinite, and runs where it is not") {
  const auto problem = problem_of(damped_beam(1e-2), 6, {"consistent"});
  StepPlan plan = newmark();
  plan.stages[0].matrix.C *= -1;
  plan.stages[0].history[1].C *= -1;
  for (const auto& [of, sentence] : said(problem, plan, no_law)) {
    CHECK(of == Of::scheme);
    CHECK_THAT(sentence, Contains("S is indefinite") && Contains("the plan weighs C by -5e-05"));
  }
  // Little damping leaves the same plan an S that is positive.
  const auto light = problem_of(damped_beam(1e-9), 6, {"consistent"});
  for (const auto& [of, sentence] : said(light, plan, no_law)) {
    CHECK_FALSE(of);
    CHECK(sentence.empty());
  }
  plan = newmark();
  plan.stages[0].matrix = -1.0 * plan.stages[0].matrix;
  for (OperatorWeights& row : plan.stages[0].history) row = -1.0 * row;
  for (const auto& [of, sentence] : said(problem, plan, no_law)) {
    CHECK(of == Of::scheme);
    CHECK_THAT(sentence, Contains("M by -1, C by -5e-05, K by -2.5e-09"));
  }
}

TEST_CASE("a law that leaves a negative stiffness, and a structure whose C is negative, are told as such") {
  const SceneSpec scene = damped_beam(0);
  // βh²ω² of the highest mode is beyond 1: its stiffness decides.
  const auto softened = [&](double left) {
    Softening law(left);
    const Parameters none;
    return std::make_shared<const SemiDiscrete>(
        discretised(scene, 24, *make(registry().mass("consistent"), {"consistent"}), &law, &none));
  };
  for (const auto& [of, sentence] : said(softened(-1), newmark(), [] { return std::make_unique<Softening>(-1); })) {
    CHECK(of == Of::law);
    CHECK_THAT(sentence, Contains("S is indefinite") && Contains("the stiffness that the law leaves is negative"));
  }
  for (const auto& [of, sentence] : said(softened(0.5), newmark(), [] { return std::make_unique<Softening>(0.5); })) {
    CHECK_FALSE(of);
    CHECK(sentence.empty());
  }
  auto negative = std::make_shared<SemiDiscrete>(*problem_of(scene, 6, {"consistent"}));
  negative->damping.matrix = std::make_shared<const SparseMatrix>(-1e-2 * negative->stiffness);
  const auto all = said(negative, newmark(), no_law);
  for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) {  // modes know no such C
    CHECK(all[k].first == Of::structure);
    CHECK_THAT(all[k].second, Contains("S is indefinite") && Contains("C of the structure is negative"));
  }
}
