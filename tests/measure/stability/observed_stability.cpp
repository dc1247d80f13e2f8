// What marching shows, against what the plan predicts, and against what theory says of energy at impacts.
#include <numbers>
#include <ricochet/measure/stability/observed_stability.hpp>

#include "tests/eigen.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace observed_stability_tests {
using Catch::Matchers::Contains;

namespace {

using Problem = std::shared_ptr<const SemiDiscrete>;

Choice dumont_paoli(double beta, double restitution = 0) {
  return {"newmark-dumont-paoli", {{"beta", beta}, {"restitution", restitution}}};
}
Choice penalty(double stiffness, const std::string& evaluation) {
  return {"penalty", {{"stiffness", stiffness}, {"evaluation", evaluation}}};
}
const Choice singular{"singular", {{"velocity", std::string("P1")}}}, consistent{"consistent"};

/// One mass × law × scheme on the working set, at any step.
struct Cell {
  Problem problem;
  Choice contact, time;

  Cell(const SceneSpec& scene, int elements, const Choice& mass, Choice law, Choice scheme)
      : problem(problem_of(scene, elements, mass)), contact(std::move(law)), time(std::move(scheme)) {}

  Parameters parameters() const {
    return complete(registry().contact(contact.name)->manual.parameters, contact.values);
  }
  std::unique_ptr<ContactLaw> law() const { return make(registry().contact(contact.name), contact); }
  StepPlan plan(double h) const {
    auto made = plan_of(time, h, problem_facts(*problem, *law()));
    INFO((std::holds_alternative<Refusal>(made) ? std::get<Refusal>(made).sentence.text : ""));
    REQUIRE(std::holds_alternative<StepPlan>(made));
    return std::get<StepPlan>(made);
  }
  StabilityPredictor predictor() const {
    return StabilityPredictor(problem, linear_law(*law(), problem->points(), parameters()));
  }
  ObservedCell free(double h, const StabilityPredictor& predicted) const {
    return known(observe_free(problem, plan(h), h, predicted.excitation(h), {}));
  }
  /// The structure is pressed against the stop at the tip by 1 N and disturbed from rest by 10⁻⁶ of that state. Its
  /// contact does not open: this is the linear step of StabilityPredictor::closed().
  std::array<double, 3> held(double h, const Excitation& start, int tip) const;
  ObservedCell scene(double h, double duration) const {
    Horizon horizon;
    horizon.steps = std::llround(duration / h);
    return known(observe_scene(
        problem, plan(h), h, [this] { return law(); }, parameters(), horizon));
  }
  static ObservedCell known(const ObservedOrRefusal& cell) {
    INFO((std::holds_alternative<Refusal>(cell) ? std::get<Refusal>(cell).sentence.text : ""));
    REQUIRE(std::holds_alternative<ObservedCell>(cell));
    return std::get<ObservedCell>(cell);
  }
};

std::vector<double> steps_from(double from, double to, int count) {
  std::vector<double> steps;
  for (int i = 0; i < count; ++i) steps.push_back(from * std::pow(to / from, i / (count - 1.0)));
  return steps;
}

template <class Observe>
ObservedLimit limit_of(const std::vector<double>& steps, Observe observe) {
  std::vector<std::optional<ObservedCell>> known;
  for (const double h : steps) known.emplace_back(observe(h));
  return observed_limit(steps, known, [&](double h) { return std::optional<ObservedCell>(observe(h)); });
}

SceneSpec tip_scene(double alpha = 0) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = alpha;
  return scene;
}

}  // namespace

namespace {

// The largest size that any slot has of the disturbance, in each third of 3000 steps; infinite once contact opens.
class Disturbance final : public StepObserver {
 public:
  Disturbance(Eigen::VectorXd rest, int held) : rest_(std::move(rest)), held_(held) {}
  void stage_solved(const Marcher&, const StageView& view) override {
    if (view.effort && view.effort[0][held_] == 0) opened_ = true;
  }
  void step_done(Marcher& marcher) override {
    const auto third = static_cast<std::size_t>(std::min(2LL, marcher.step() / 1000));
    for (int j = 0; j < marcher.slot_count(); ++j) {
      const Eigen::Map<const Eigen::VectorXd> x(marcher.slot(j), rest_.size());
      slots_[third].resize(static_cast<std::size_t>(marcher.slot_count()));
      double& size = slots_[third][static_cast<std::size_t>(j)];
      size = opened_ || !marcher.status(0).running ? INFINITY : std::max(size, j == 0 ? (x - rest_).norm() : x.norm());
    }
  }
  /// Of the slot that grows most.
  std::array<double, 3> thirds() const {
    if (slots_[2].empty()) return {1, INFINITY, INFINITY};  // it blew up on the way
    std::array<double, 3> most = {1, 1, 1};
    for (std::size_t j = 0; j < slots_[0].size(); ++j) {
      const std::array<double, 3> slot = {1, slots_[1][j] / slots_[0][j], slots_[2][j] / slots_[0][j]};
      if (!(slot[2] <= most[2])) most = slot;
    }
    return most;
  }

 private:
  Eigen::VectorXd rest_;
  int held_;
  bool opened_ = false;
  std::array<std::vector<double>, 3> slots_;
};

std::array<double, 3> Cell::held(double h, const Excitation& start, int tip) const {
  const Eigen::VectorXd row = Eigen::RowVectorXd(problem->contact.row(tip)).transpose();
  const Eigen::VectorXd rest = eigen::ldlt_solve(problem->stiffness, row);
  auto pressing = law();
  const LinearLaw linear = linear_law(*pressing, problem->points(), parameters());
  LaneSpec lane = scene_lane(*problem, parameters());
  lane.upper.setConstant(INFINITY);
  lane.lower.setConstant(-INFINITY);
  lane.lower[tip] = row.dot(rest) + (linear.stiffness ? 1 / *linear.stiffness : 0.0);
  const double share = 1e-6 * std::sqrt(0.5 * row.dot(rest));
  lane.position = rest + share * start.position;
  lane.velocity = share * start.velocity;
  CompileOptions options;
  options.kind = OperatorKind::band;
  auto program = compile(problem, plan(h), h, std::move(pressing), {lane}, options);
  REQUIRE(std::holds_alternative<Program>(program));
  Marcher marcher(std::move(std::get<Program>(program)));
  Disturbance disturbance(rest, tip);
  marcher.start(&disturbance);
  marcher.march(3000, &disturbance);
  return disturbance.thirds();
}

}  // namespace

TEST_CASE("free cells blow up where the radius passes one, to 2 %") {
  for (const double alpha : {0.0, 1e-4})
    for (const Choice& time : {dumont_paoli(0), dumont_paoli(0.2), Choice{"newmark", {{"beta", 0.0}}},
                               Choice{"newmark", {{"beta", 0.1}, {"gamma", 0.6}}}}) {
      const Cell cell(tip_scene(alpha), 10, consistent, {"none"}, time);
      const auto predicted = cell.predictor();
      const auto steps = steps_from(1e-6, 1e-3, 7);
      const auto limit = step_limit([&](double h) { return predicted.open(cell.plan(h), h); }, steps);
      const auto observed = limit_of(steps, [&](double h) { return cell.free(h, predicted); });
      REQUIRE(limit.step);
      REQUIRE(observed.step);
      CHECK_FALSE(observed.returns);
      // The observed bracket is 1 % wide.
      CHECK(*observed.step == Approx(*limit.step).epsilon(0.02));
      if (time.values.at("beta") == ParameterValue(0.0) && time.name == "newmark-dumont-paoli" && alpha == 0)
        CHECK(*observed.step == Approx(0.0334014193 * 0.1501 * 0.1501 / std::sqrt(282.8125)).epsilon(0.02));
    }
}

TEST_CASE("where no limit is predicted none is observed, over six decades of the step") {
  for (const Choice& mass : {consistent, singular})
    for (const Choice& time :
         {dumont_paoli(0.25), dumont_paoli(0.5), Choice{"newmark", {}}, Choice{"moreau-jean", {{"theta", 1.0}}}})
      for (const double alpha : {0.0, 1e-4}) {
        const Cell cell(tip_scene(alpha), 5, mass, {"none"}, time);
        const auto predicted = cell.predictor();
        for (const double h : steps_from(1e-8, 1e-2, 7)) {
          const StepPlan plan = cell.plan(h);
          const auto spectrum = predicted.open(plan, h);
          REQUIRE(std::holds_alternative<StepSpectrum>(spectrum));
          const ObservedCell seen = cell.free(h, predicted);
          INFO(mass.name << " " << time.name << " alpha " << alpha << " h " << h << ": " << seen.cause);
          CHECK(seen.stable());
          // The double root −1 of β = ¼ on the kernel of a singular mass grows linearly, and nothing else does.
          const bool grows = std::get<StepSpectrum>(spectrum).grows_linearly;
          CHECK((seen.behaviour == Behaviour::linear_growth) == grows);
        }
      }
}

TEST_CASE("a held point marches to the limit that the closed step predicts, to 2 %") {
  struct Held {
    Choice contact, time;
    double from, to;
  };
  for (const Held& one : {Held{{"signorini"}, dumont_paoli(0), 1e-6, 1e-3},
                          Held{penalty(1e6, "explicit"), dumont_paoli(0.25), 1e-6, 1e-2},
                          Held{penalty(1e6, "explicit"), dumont_paoli(0.5), 1e-6, 1e-2},
                          Held{penalty(1e4, "explicit"), {"newmark", {}}, 1e-6, 1e-2},
                          Held{penalty(1e6, "explicit"), {"moreau-jean", {}}, 1e-6, 1e-2},
                          Held{penalty(1e5, "implicit"), dumont_paoli(0), 1e-6, 1e-3}}) {
    const Cell cell(tip_scene(), 5, consistent, one.contact, one.time);
    const auto predicted = cell.predictor();
    const ClosedSet& tip = predicted.sets().front();
    const auto steps = steps_from(one.from, one.to, 7);
    const auto limit = step_limit([&](double h) { return predicted.closed(cell.plan(h), h, tip); }, steps);
    INFO(one.contact.name << " " << one.time.name);
    REQUIRE(limit.step);
    // 2 % beyond the limit a root is 1.2 or more, 2 % below it none is above one.
    const auto grows = [&](double h) {
      const Excitation start = cell.law()->reads() ? predicted.excitation(h) : predicted.excitation(tip, h);
      return !(cell.held(h, start, tip.points[0])[2] < 100);
    };
    CHECK_FALSE(grows(0.98 * *limit.step));
    CHECK(grows(1.02 * *limit.step));
  }
}

TEST_CASE("a rigid point held by Newmark's accelerations grows linearly, held by Dumont–Paoli it rests") {
  for (const double h : {1e-3, 3e-4}) {
    const Cell newmark(tip_scene(), 5, consistent, {"signorini"}, {"newmark", {}});
    const auto predicted = newmark.predictor();
    const ClosedSet& tip = predicted.sets().front();
    // The tip reaches its stop with a speed, as in an impact.
    Excitation start = predicted.excitation(tip, h);
    start.velocity = predicted.excitation(h).velocity;
    const auto thirds = newmark.held(h, start, tip.points[0]);
    // Amplitudes like the number of steps: twice and three times those of the first third.
    CHECK(thirds[1] == Approx(2).epsilon(0.05));
    CHECK(thirds[2] == Approx(3).epsilon(0.05));
    const Cell rests(tip_scene(), 5, consistent, {"signorini"}, dumont_paoli(0.5));
    CHECK(rests.held(h, start, tip.points[0])[2] < 1.1);
  }
}

TEST_CASE("energy that nothing gave is seen where theory has it, and nowhere else") {
  SceneSpec scene = tip_scene();
  scene.stops.place = StopsSpec::Place::nodes;
  for (const Choice& mass : {consistent, singular})
    for (const double h : {1e-3, 1e-4}) {
      const ObservedCell calm = Cell(scene, 10, mass, {"signorini"}, dumont_paoli(0.5)).scene(h, 0.4);
      CHECK(calm.behaviour == Behaviour::stable);
      CHECK(calm.impacts > 0);
      // Its energy never increases: round-off of 4000 steps is left.
      CHECK(calm.gain < 1e-10);
      CHECK(calm.cause.empty());
    }
  // Newmark(¼, ½) with position-level stops gains energy; more than doubled within 0.4 s at this step.
  const ObservedCell gains = Cell(scene, 10, consistent, {"signorini"}, {"newmark", {}}).scene(1e-5, 0.4);
  CHECK(gains.behaviour == Behaviour::growing);
  CHECK(gains.gain > 1);
  CHECK(gains.first_bad_step > 0);
  CHECK_THAT(gains.cause, Contains("nothing gave"));
  // A spring of 1e9 N/m averaged over three levels throws back more than it got where steps are too long for it. The
  // same spring at the end of the step never does. How much, a chaotic run tells: the largest of four.
  double averaged = 0, implicit = 0;
  for (const double h : {2e-5, 4e-5, 2.5e-4, 6e-4}) {
    averaged = std::max(averaged,
                        Cell(scene, 10, consistent, penalty(1e9, "averaged"), dumont_paoli(0.25)).scene(h, 0.4).gain);
    implicit = std::max(implicit,
                        Cell(scene, 10, consistent, penalty(1e9, "implicit"), dumont_paoli(0.25)).scene(h, 0.4).gain);
  }
  CHECK(averaged > 0.1);
  CHECK(implicit < 1e-10);
}

TEST_CASE("two forms of one explicit scheme gain the same energy at a spring", "[stability]") {
  // Their energies stand half a step apart, and the spring's potential with them: only once it is slack are they one.
  const SceneSpec scene = tip_scene();
  const double h = 5e-5;
  for (const double stiffness : {1e5, 1e6}) {
    const auto gain = [&](const char* scheme) {
      const ObservedCell cell = Cell(scene, 4, {"lumped"}, penalty(stiffness, "explicit"), {scheme, {}}).scene(h, 0.2);
      CHECK(cell.impacts > 0);
      return cell.gain;
    };
    const double one = gain("central-difference"), other = gain("cd-lagrange");
    CHECK(one == Approx(other).epsilon(1e-3).margin(1e-9));
  }
}

TEST_CASE("a cell beyond the limit ends with the step where it went wrong") {
  const Cell cell(tip_scene(), 10, consistent, {"signorini"}, dumont_paoli(0));
  const ObservedCell gone = cell.scene(1e-4, 0.5);
  CHECK(gone.behaviour == Behaviour::diverged);
  CHECK(gone.first_bad_step > 0);
  CHECK(gone.first_bad_step < 100);
  // It is frozen a few steps after its energy has gone astray.
  CHECK(gone.steps >= gone.first_bad_step);
  CHECK_THAT(gone.cause, Contains("step " + std::to_string(gone.steps)));
  for (const double number : {gone.growth, gone.gain, gone.changes_per_impact, gone.fast_share})
    CHECK(std::isfinite(number));
}

TEST_CASE("energy that swells and falls again is no limit") {
  // Steps of hundreds of periods of the highest modes: near the root −1 amplitudes swell by ωh/2. Energies pass 1e9
  // times those of the start, and fall again where the scheme has no limit.
  for (const int elements : {10, 20})
    for (const double viscosity : {1e-6, 1e-5, 1e-4})
      for (const Choice& mass : {consistent, Choice{"lumped"}}) {
        const Cell cell(tip_scene(viscosity), elements, mass, {"none"}, dumont_paoli(0.25));
        const StabilityPredictor predicted = cell.predictor();
        for (const double h : {1e-3, 4.55e-3, 9.26e-3, 2e-2}) {
          INFO(elements << " elements, alpha " << viscosity << ", h = " << h << ", " << mass.name);
          const ObservedCell seen = cell.free(h, predicted);
          INFO(seen.cause);
          CHECK(seen.stable());
          CHECK(seen.steps == Horizon{}.steps);
        }
      }
}

TEST_CASE("a law that gives up is a failure of the law") {
  class Stubborn final : public ContactLaw {
   public:
    void prepare(int, std::span<const Parameters>) override {}
    void solve(ReducedProblem& problem) override {
      for (const int lane : problem.touched) problem.outcome[lane] = {false, 7, 0.25};
    }
  };
  const Cell cell(tip_scene(), 5, consistent, {"signorini"}, dumont_paoli(0.5));
  Horizon horizon;
  horizon.steps = 5000;
  const ObservedCell seen = Cell::known(observe_scene(
      cell.problem, cell.plan(1e-4), 1e-4, [] { return std::make_unique<Stubborn>(); }, {}, horizon));
  CHECK(seen.behaviour == Behaviour::failed);
  CHECK_THAT(seen.cause, Contains("did not converge"));
  // It fails at the first impact, at 0.0488 s.
  CHECK(seen.first_bad_step > 450);
  CHECK(seen.first_bad_step < 520);
}

TEST_CASE("a horizon can be cut short") {
  const Cell cell(tip_scene(), 5, consistent, {"signorini"}, dumont_paoli(0.5));
  int asked = 0;
  Horizon horizon;
  horizon.steps = 1000000;
  horizon.go_on = [&] { return ++asked < 3; };
  const ObservedCell seen = Cell::known(observe_scene(
      cell.problem, cell.plan(1e-5), 1e-5, [&] { return cell.law(); }, cell.parameters(), horizon));
  CHECK(seen.steps < 20000);
  CHECK(seen.stable());
}

TEST_CASE("the share of fast power is that of the spectrum") {
  const std::size_t n = 1024;
  std::vector<double> constant(n, 3.7), alternating(n), pulse(n, 0.0), slow(n), both(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / n;
    alternating[i] = i % 2 == 0 ? 5 : 2;
    slow[i] = std::sin(2 * std::numbers::pi * 10 * t);
    // Amplitudes 3 and 1, frequencies 1/16 and 3/8 of the sampling: powers 9 to 1.
    both[i] = 3 * std::cos(2 * std::numbers::pi * 64 * t) + std::sin(2 * std::numbers::pi * 384 * t);
  }
  pulse[100] = 1;
  CHECK(fast_power_share(constant) == 0);
  // Round-off of the transform.
  CHECK(fast_power_share(alternating) == Approx(1).epsilon(1e-12));
  CHECK(fast_power_share(slow) < 1e-12);
  CHECK(fast_power_share(both) == Approx(0.1).epsilon(1e-12));
  // 511 of the 1023 frequencies beside the mean.
  CHECK(fast_power_share(pulse) == Approx(511.0 / 1023).epsilon(1e-12));
}

TEST_CASE("the boundary is found to 1 %, and what is odd about it is said") {
  const auto cell = [](bool stable) {
    ObservedCell out;
    out.behaviour = stable ? Behaviour::stable : Behaviour::growing;
    return out;
  };
  const auto steps = steps_from(1e-6, 1e-2, 9);
  const double exact = 3.21e-4;
  const auto plain = limit_of(steps, [&](double h) { return cell(h < exact); });
  REQUIRE(plain.step);
  CHECK(*plain.step == Approx(exact).epsilon(0.01));
  CHECK_FALSE(plain.below_range);
  CHECK_FALSE(plain.returns);
  CHECK(limit_of(steps, [&](double h) { return cell(h < exact || h > 5e-3); }).returns);
  const auto below = limit_of(steps, [&](double h) { return cell(h < 2e-9); });
  REQUIRE(below.step);
  CHECK(*below.step == Approx(2e-9).epsilon(0.01));
  CHECK(below.below_range);
  CHECK_FALSE(limit_of(steps, [&](double) { return cell(true); }).step);
  CHECK_FALSE(limit_of(steps, [&](double) { return cell(false); }).step);
  const std::vector<std::optional<ObservedCell>> all_bad(steps.size(), cell(false));
  int marched = 0;
  const auto kept = observed_limit(
      steps, all_bad, [&](double) { return ++marched, std::optional(cell(false)); }, false);
  CHECK(kept.below_range);
  CHECK(marched == 0);
}

}  // namespace observed_stability_tests
