// The ledger of a step is that of its definition. Every term is worked out again with whole matrices, at every step,
// and so are the energies of every step between them.
#include <numeric>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>

#include "tests/plugins/with_defaults.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

/// The terms of one lane as a plan declares them, in the coordinates of the integration.
class DefinedLedger final : public StepObserver {
 public:
  DefinedLedger(const Marcher& marcher, int lane, EnergyAudit& audit) : lane_(lane), audit_(audit) {
    const MarchModel& model = *marcher.program().model;
    const Damping& damping = model.problem().damping;
    K_ = Eigen::MatrixXd(model.stiffness());
    M_ = model.modal() ? Eigen::MatrixXd(model.inertia().mass) : dense_mass(model.inertia());
    C_ = damping.stiffness * K_ + damping.mass * M_;
  }

  void stage_solved(const Marcher& marcher, const StageView& view) override {
    if (view.plan->work || !view.starting) {
      if (!begun_) start_ = energy(marcher) - sums_.contact - sums_.loads;
      begun_ = true;
      for (const LossTerm& term : view.plan->loss)
        sums_.scheme += term.coefficient * form(term.matrix, combined(marcher, view, term.value));
    }
    if (view.plan->work)
      add_work(marcher, view, *view.plan->work);
    else if (view.starting)
      add_start(marcher, view);
    audit_.stage_solved(marcher, view);
  }

  void step_done(Marcher& marcher) override {
    audit_.step_done(marcher);
    if (!begun_) return;
    const Works& w = sums_;
    worst_ = std::max(worst_, std::abs(energy(marcher) - start_ - w.loads + w.damping + w.scheme - w.contact));
    size_ = std::max({size_, std::abs(start_), std::abs(w.loads), std::abs(w.contact), w.damping});
  }

  const Works& sums() const { return sums_; }
  /// Largest part of the energy, at any step, that the terms do not explain; and the largest of these.
  double worst() const { return worst_; }
  double size() const { return size_; }

 private:
  double form(EnergyMatrix matrix, const Eigen::VectorXd& x) const {
    return x.dot((matrix == EnergyMatrix::M ? M_ : K_) * x);
  }
  Eigen::VectorXd lane_of(const Marcher& marcher, const double* block) const {
    Eigen::VectorXd x(M_.rows());
    for (int i = 0; i < x.size(); ++i) x[i] = block[i * marcher.width() + lane_];
    return x;
  }
  Eigen::VectorXd combined(const Marcher& marcher, const StageView& view, const Combination& c) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(M_.rows());
    for (std::size_t j = 0; j < c.slots.size(); ++j) sum += c.slots[j] * lane_of(marcher, view.slots[j]);
    if (c.z != 0) sum += c.z * lane_of(marcher, view.z);
    if (c.w != 0 && view.w) sum += c.w * lane_of(marcher, view.w);
    return sum;
  }
  double energy(const Marcher& marcher) const {
    double sum = 0;
    for (const QuadraticTerm& term : marcher.program().plan.energy) {
      Eigen::VectorXd x = Eigen::VectorXd::Zero(M_.rows());
      for (std::size_t j = 0; j < term.slots.size(); ++j)
        x += term.slots[j] * lane_of(marcher, marcher.slot(static_cast<int>(j)));
      sum += term.coefficient * form(term.matrix, x);
    }
    return sum;
  }
  void add_work(const Marcher& marcher, const StageView& view, const WorkForm& work) {
    const MarchModel& model = *marcher.program().model;
    const double t = view.time, omega = model.problem().support.pulsation;
    const Eigen::VectorXd s = combined(marcher, view, work.displacement);
    sums_.damping += s.dot(C_ * combined(marcher, view, work.rate));
    sums_.loads += omega * omega * marcher.support_levels(lane_, t, work.load) * model.support_shape().dot(s);
    if (const double* F = const_cast<Marcher&>(marcher).distributed_load(work.load, t))
      sums_.loads += Eigen::Map<const Eigen::VectorXd>(F, s.size()).dot(s);
    if (!view.effort) return;
    const double lift = marcher.support_levels(lane_, t, work.support);
    const std::vector<double>& weights = view.program->work_effort;
    for (int j = 0; j < model.problem().points(); ++j) {
      double effort = 0;
      for (std::size_t k = 0; k < weights.size() && static_cast<int>(k) < view.efforts; ++k)
        if (view.effort[k]) effort += weights[k] * view.effort[k][j * marcher.width() + lane_];
      sums_.contact += effort * (model.measured().times(j, s.data()) + lift);
      sums_.loads -= effort * lift;
    }
  }

  // What contact works in a start rule without work form: the momentum given within it, times the mean velocity.
  void add_start(const Marcher& marcher, const StageView& view) {
    if (!view.effort || view.plan->matrix.M == 0) return;
    const MarchModel& model = *marcher.program().model;
    const StepPlan& plan = marcher.program().plan;
    double given = 0;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(M_.rows());
    for (std::size_t j = 0; j < plan.velocity.slots.size(); ++j) {
      const double weight = plan.velocity.slots[j];
      given += weight * view.plan->update[j].z / view.plan->matrix.M;
      mean += weight / 2 * (lane_of(marcher, view.slots[j]) + combined(marcher, view, view.plan->update[j]));
    }
    const StageFacts& facts = view.program->facts;
    const bool moves = facts.to > facts.from;
    const double h = marcher.program().h, from = view.time + h * (moves ? facts.from : facts.from - 0.5),
                 to = view.time + h * (moves ? facts.to : facts.from + 0.5);
    const double lift = (marcher.support(lane_, to) - marcher.support(lane_, from)) / (to - from);
    for (int j = 0; j < model.problem().points(); ++j) {
      const double impulse = given * view.effort[0][j * marcher.width() + lane_];
      sums_.contact += impulse * (model.measured().times(j, mean.data()) + lift);
      sums_.loads -= impulse * lift;
    }
  }

  int lane_;
  EnergyAudit& audit_;
  Eigen::MatrixXd M_, K_, C_;
  Works sums_;
  bool begun_ = false;
  double start_ = 0, worst_ = 0, size_ = 0;
};

SceneSpec busy_scene(const Damping& damping, bool loaded) {
  SceneSpec scene = working_set();
  beam_of(scene).damping = damping;
  scene.support.amplitude = 0.03;
  scene.support.phase = 0.4;
  if (loaded) scene.load = Formula("0.5*x*cos(20*t) - 0.2", "/scene/load");
  scene.stops.place = StopsSpec::Place::nodes;
  return scene;
}

std::vector<LaneSpec> two_lanes(const LaneSpec& lane) {
  std::vector<LaneSpec> lanes(2, lane);
  lanes[0].amplitude *= 1.3;
  return lanes;
}

/// Whether every stage pays for its energy, by the plan.
bool balances(const StepPlan& plan) {
  return !plan.energy.empty() &&
         std::all_of(plan.stages.begin(), plan.stages.end(), [](const Stage& stage) { return stage.work.has_value(); });
}

}  // namespace

TEST_CASE("works are those of the definition, and explain the energy of every step: every scheme with every law") {
  constexpr double h = 2e-5;  // below the limits of explicit schemes on this mesh
  constexpr long long steps = 3000;
  const Damping damping = GENERATE(Damping{2e-5, 0}, Damping{0, 0.4}, Damping{2e-5, 0.4}, Damping{});
  const bool loaded = GENERATE(false, true);
  const auto kind = GENERATE(OperatorKind::band, OperatorKind::modal);
  // Half of the combinations, in which any two choices still meet in every way.
  const bool alone = ((damping.stiffness > 0) + (damping.mass > 0) + loaded + (kind == OperatorKind::modal)) % 2 == 0;
  int balanced = 0, touched = 0;
  for (const std::string& time : registry().names(Role::time))
    for (const std::string& law : registry().names(Role::contact)) {
      INFO(time << " × " << law << ", α = " << damping.stiffness << ", η = " << damping.mass
                << (loaded ? ", loaded" : "") << (alone ? "" : ", two lanes"));
      CompileOptions options;
      options.kind = kind;
      const Methods methods{{"consistent"}, with_defaults(*registry().manual(Role::contact, law)), {time}};
      const auto problem = problem_of(busy_scene(damping, loaded), 4, methods.mass, methods.contact);
      auto program = compiled(problem, methods, h, options, alone ? one_lane : Lanes(two_lanes));
      if (std::holds_alternative<Refusal>(program)) continue;
      Marcher beam(std::move(std::get<Program>(program)));
      EnergyAudit audit(beam, SamplingMode::seldom);
      const int lane = beam.lanes() - 1;
      DefinedLedger ledger(beam, lane, audit);
      audit.sample_after(steps);
      beam.start(&ledger);
      beam.march(steps - beam.step(), &ledger);
      REQUIRE(beam.status(lane).running);
      const EnergyTotals& totals = audit.totals(lane);
      const Works& defined = ledger.sums();
      // Entries of K s are larger than what is left of their sum, but steps are small.
      const double slack = 1e-12 * ledger.size();
      CHECK(totals.work_of_damping == Approx(defined.damping).epsilon(0).margin(slack));
      CHECK(totals.work_of_loads == Approx(defined.loads).epsilon(0).margin(slack));
      CHECK(totals.work_of_contact == Approx(defined.contact).epsilon(0).margin(slack));
      CHECK(totals.work_of_scheme == Approx(defined.scheme).epsilon(0).margin(slack));
      touched += audit.contact(lane).impacts > 0;
      if (!balances(beam.program().plan)) continue;
      ++balanced;
      CHECK(ledger.worst() <= 1e-8 * ledger.size());
      CHECK(std::abs(totals.balance_residual()) <= 1e-8 * ledger.size());
    }
  CHECK(balanced > 50);
  CHECK(touched > 50);
}

namespace {

/// Is shown every step, so that nobody else misses one.
struct EveryStep final : StepObserver {
  void stage_solved(const Marcher&, const StageView&) override { ++seen; }
  void step_done(Marcher&) override {}
  int seen = 0;
};

/// Shows another observer every step and asks for nothing: no operator adds up its squares.
struct NoSquares final : StepObserver {
  explicit NoSquares(StepObserver& of) : one(of) {}
  void stage_solved(const Marcher& marcher, const StageView& view) override { one.stage_solved(marcher, view); }
  void step_done(Marcher& marcher) override {
    one.step_done(marcher);
    if (marcher.program().flight) asks_.next_shown = one.asks().next_shown;
  }
  void interval(Marcher& marcher, const StepInterval& steps) override {
    one.interval(marcher, steps);
    asks_.next_shown = one.asks().next_shown;
  }
  StepObserver& one;
};

struct Observed {
  Marcher marcher;
  EnergyAudit audit;
  ImpactRecorder recorder;
  explicit Observed(Marcher made) : marcher(std::move(made)), audit(marcher, SamplingMode::seldom), recorder(marcher) {}
  /// In parts, the last of which ends where energies are asked for.
  void march(const Observers& observers, const std::vector<int>& parts) {
    marcher.start(observers);
    audit.sample_after(std::accumulate(parts.begin(), parts.end(), marcher.step()));
    for (const int steps : parts) marcher.march(steps, observers);
  }
};

}  // namespace

TEST_CASE(
    "steps that nobody was shown add up what they would have, bit for bit, wherever an integration was interrupted") {
  const auto kind = GENERATE(OperatorKind::band, OperatorKind::modal);
  const auto place = GENERATE(StopsSpec::Place::nodes, StopsSpec::Place::tip);
  const auto mass = GENERATE(Choice{"consistent"}, Choice{"singular", {{"velocity", std::string("P1")}}});
  const auto damping = GENERATE(Damping{1e-4, 0}, Damping{0, 0.4}, Damping{});
  const bool shaken = GENERATE(true, false);
  const int elements = GENERATE(5, 6);
  SceneSpec scene = busy_scene(damping, false);
  scene.stops.place = place;
  if (!shaken) scene.support = {};
  CompileOptions options;
  options.kind = kind;
  const auto made = [&] {
    return marcher(scene, elements, {mass, {"signorini"}, {"newmark-dumont-paoli"}}, 2e-5, options);
  };
  INFO(operator_name(kind) << ", " << mass.name << ", α = " << damping.stiffness << ", η = " << damping.mass
                           << (shaken ? ", shaken, " : ", ") << elements << " elements");
  Observed shown(made()), passed(made()), unseen(made()), parted(made());
  EveryStep every;
  NoSquares none(passed.audit);
  shown.march({&shown.audit, &shown.recorder, &every}, {9000});
  passed.march({&none, &passed.recorder}, {9000});
  unseen.march({&unseen.audit, &unseen.recorder}, {9000});
  parted.march({&parted.audit, &parted.recorder}, {1, 7, 40, 3001, 16, 5935});
  REQUIRE(every.seen >= 9000);
  REQUIRE(shown.audit.contact(0).impacts > 2);
  const EnergyTotals& a = shown.audit.totals(0);
  for (const Observed* other : {&passed, &unseen, &parted}) {
    CHECK(other->marcher.position(0) == shown.marcher.position(0));
    const EnergyTotals& b = other->audit.totals(0);
    const double slack = other == &passed ? 1e-13 * (a.brought_in() + a.work_of_damping) : 0;
    CHECK(std::abs(b.work_of_damping - a.work_of_damping) <= slack);
    CHECK(std::abs(b.work_of_loads - a.work_of_loads) <= slack);
    CHECK(b.work_of_contact == a.work_of_contact);
    CHECK(b.work_of_scheme == a.work_of_scheme);
    CHECK(std::abs(b.largest_step_gain - a.largest_step_gain) <= EnergyAudit::confirmed * a.brought_in());
    CHECK(b.last.kinetic == a.last.kinetic);
    CHECK(b.last.elastic == a.last.elastic);
    CHECK(b.last.scheme == a.last.scheme);
    CHECK(other->audit.tip_velocity(0) == shown.audit.tip_velocity(0));
    CHECK(other->audit.penetration(0) == shown.audit.penetration(0));
    const ContactTotals &c = shown.audit.contact(0), &d = other->audit.contact(0);
    CHECK(d.impacts == c.impacts);
    CHECK(d.contact_steps == c.contact_steps);
    CHECK(d.impulse == c.impulse);
    CHECK(d.deepest_penetration == c.deepest_penetration);
    CHECK(d.first_release == c.first_release);
    REQUIRE(other->recorder.impacts(0).size() == shown.recorder.impacts(0).size());
    for (std::size_t k = 0; k < shown.recorder.impacts(0).size(); ++k) {
      const Impact &x = shown.recorder.impacts(0)[k], &y = other->recorder.impacts(0)[k];
      CHECK(y.time == x.time);
      CHECK(y.speed_in == x.speed_in);
      CHECK(y.speed_out == x.speed_out);
      CHECK(y.impulse == x.impulse);
    }
  }
}

TEST_CASE("squares that a visited step adds up leave an integration by flights what it is") {
  const auto place = GENERATE(StopsSpec::Place::nodes, StopsSpec::Place::tip);
  SceneSpec scene = busy_scene({1e-4, 0}, false);
  scene.stops.place = place;
  CompileOptions options;
  options.kind = OperatorKind::modal;
  options.march = MarchWay::flights;
  options.expected_steps = 20000;
  const auto made = [&] {
    return marcher(scene, 6, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}}, 1e-5, options);
  };
  Observed with(made()), without(made());
  const auto march = [](Observed& observed, const Observers& observers) {
    observed.marcher.start(observers);
    observed.audit.sample_after(20000);
    observed.marcher.march(20000 - observed.marcher.step(), observers);
  };
  NoSquares apart(without.audit);
  march(with, {&with.audit, &with.recorder});
  march(without, {&apart, &without.recorder});
  REQUIRE(with.audit.contact(0).impacts > 2);
  REQUIRE(with.marcher.steps_visited() < 10000);
  CHECK(with.marcher.steps_visited() == without.marcher.steps_visited());
  CHECK(with.marcher.position(0) == without.marcher.position(0));
  const EnergyTotals &a = with.audit.totals(0), &b = without.audit.totals(0);
  CHECK(a.last.scheme == b.last.scheme);
  CHECK(a.work_of_damping == Approx(b.work_of_damping).epsilon(1e-13));
  CHECK(std::abs(a.work_of_loads - b.work_of_loads) <= 1e-13 * a.brought_in());
  CHECK(a.work_of_contact == b.work_of_contact);
}
