// The α-methods have a quadratic energy that never grows, and say what they take from it.
#include "tests/plugins/time/family.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

struct Weights {
  double mass = 0, force = 0;  // α_m, α_f
};

Weights weights_of(const Choice& time) {
  const auto value = [&](const char* key) { return std::get<double>(time.values.at(key)); };
  if (time.name == "hht-alpha") return {0, -value("alpha")};
  const double rho = value("rho_inf");
  if (time.name == "wbz-alpha") return {(rho - 1) / (rho + 1), 0};
  return {(2 * rho - 1) / (rho + 1), rho / (rho + 1)};
}

// What a step takes, −ΔE = ¼ε³h²|Δa|²_M + ((½−α_f)(½−α_m)/ε)|Δσ|²_K, ε = α_f − α_m, from the slots q, v, a, s alone; σ
// is s, and εd where the slot is d = Δq.
class DeclaredLoss final : public StepObserver {
 public:
  DeclaredLoss(const Marcher& marcher, const Choice& time)
      : audit(marcher),
        mass_(dense_mass(marcher.program().problem->inertia)),
        stiffness_(marcher.program().problem->stiffness),
        weights_(weights_of(time)),
        filter_(time.name == "hht-alpha" ? weights_.force : 1) {}
  EnergyAudit audit;
  double worst = 0, taken = 0;  // largest |ΔE + taken in a step|, and the sum of what is taken

  void stage_solved(const Marcher& marcher, const StageView& view) override {
    audit.stage_solved(marcher, view);
    if (view.starting) return;
    acceleration_ = slot(marcher, 2);
    filtered_ = slot(marcher, 3);
    energy_ = audit.energy(0).scheme;
  }
  void step_done(Marcher& marcher) override {
    audit.step_done(marcher);
    if (acceleration_.size() == 0) return;
    const Eigen::VectorXd da = slot(marcher, 2) - acceleration_, ds = filter_ * (slot(marcher, 3) - filtered_);
    const double h = marcher.program().h, e = weights_.force - weights_.mass;
    const double loss = 0.25 * e * e * e * h * h * da.dot(mass_ * da) +
                        (0.5 - weights_.force) * (0.5 - weights_.mass) / e * ds.dot(stiffness_ * ds);
    worst = std::max(worst, std::abs(audit.energy(0).scheme - energy_ + loss));
    taken += loss;
  }

 private:
  Eigen::VectorXd slot(const Marcher& marcher, int j) const {
    return Eigen::Map<const Eigen::VectorXd>(marcher.slot(j), mass_.rows());
  }
  Eigen::MatrixXd mass_, stiffness_;
  Weights weights_;
  double filter_, energy_ = 0;
  Eigen::VectorXd acceleration_, filtered_;
};

}  // namespace

TEST_CASE("what an α-method takes from the energy of a free beam in a step is its sum of squares, to round-off") {
  const auto time =
      GENERATE(scheme("hht-alpha", {{"alpha", -0.1}}), scheme("hht-alpha", {{"alpha", -1.0 / 3}}),
               scheme("wbz-alpha", {{"rho_inf", 0.8}}), scheme("wbz-alpha", {{"rho_inf", 0.0}}),
               scheme("generalised-alpha", {{"rho_inf", 0.9}}), scheme("generalised-alpha", {{"rho_inf", 0.5}}),
               scheme("generalised-alpha", {{"rho_inf", 0.0}}));
  const double h = GENERATE(1e-3, 1e-5);
  SceneSpec scene = compared_beam(0);
  scene.stops = {};
  CompileOptions nodal;
  nodal.kind = OperatorKind::band;
  Marcher beam = marcher(scene, 10, {{"consistent"}, {"none"}, time}, h, nodal);
  DeclaredLoss watched(beam, time);
  beam.start(&watched);
  beam.march(500, &watched);
  const EnergyTotals& totals = watched.audit.totals(0);
  INFO(label(time) << " h = " << h);
  CHECK(totals.largest_step_gain <= 1e-12 * totals.scheme_start);
  // 10 elements: K q is a sum of terms up to 10⁴ times larger than itself, each known to 10⁻¹⁶.
  CHECK(watched.worst <= 1e-11 * totals.scheme_start);
  CHECK(totals.last.scheme == Approx(totals.scheme_start - watched.taken).epsilon(1e-10));
  // What is compared is not nothing.
  CHECK(watched.taken > (h == 1e-3 ? 1e-3 : 1e-9) * totals.scheme_start);
}

TEST_CASE("with loads, a moving support and rigid stops the balance of schemes that damp closes") {
  const auto time = GENERATE(
      scheme("newmark", {{"beta", 0.3025}, {"gamma", 0.6}}), scheme("newmark", {{"beta", 0.5}, {"gamma", 0.9}}),
      scheme("newmark", {{"beta", 0.3}, {"gamma", 0.6}}), scheme("hht-alpha"), scheme("hht-alpha", {{"alpha", -0.3}}),
      worded("hht-alpha", "contact", "weighted"), scheme("kane", {{"beta", 0.3}, {"gamma", 0.6}}),
      scheme("kane", {{"beta", 0.5}, {"gamma", 1.0}}), scheme("moreau-jean", {{"theta", 0.7}}));
  const double alpha = GENERATE(0.0, 1e-5);
  SceneSpec scene = compared_beam(alpha);
  scene.stops.place = StopsSpec::Place::nodes;
  scene.support = {0.02, 10, 0.4};
  scene.load = Formula("0.5*x*cos(20*t) - 0.2", "/scene/load");
  Marcher beam = marcher(scene, 8, {{"consistent"}, {"signorini"}, time}, 1e-4);
  const EnergyAudit audit = audited(beam, 0.2);
  const EnergyTotals& totals = audit.totals(0);
  INFO(label(time) << " α = " << alpha);
  REQUIRE(beam.status(0).running);
  CHECK(audit.balances());
  CHECK(audit.contact(0).impacts > 0);
  CHECK(totals.work_of_scheme > 1e-3 * totals.scheme_start);
  CHECK(std::abs(totals.work_of_loads) > 1e-3 * totals.scheme_start);
  // 2000 steps of round-off, each of 10⁻¹⁶ of terms up to 10⁴ times the energy, signs at random.
  CHECK(std::abs(totals.balance_residual()) <= 1e-10 * (totals.scheme_start + std::abs(totals.work_of_loads)));
}

TEST_CASE("schemes whose energy is ½|v|² + ½|q|² alone keep it in free flight") {
  const auto time = GENERATE(scheme("newmark"), scheme("midpoint"), scheme("kane"), scheme("laursen-chawla"),
                             scheme("contact-stabilised-newmark"), scheme("moreau-jean"),
                             scheme("generalised-alpha", {{"rho_inf", 1.0}}), scheme("hht-alpha", {{"alpha", 0.0}}),
                             scheme("wbz-alpha", {{"rho_inf", 1.0}}));
  SceneSpec scene = compared_beam(0);
  scene.stops = {};
  Marcher beam = marcher(scene, 10, {{"consistent"}, {"none"}, time}, 1e-3);
  const EnergyAudit audit = audited(beam, 1.0);
  INFO(label(time));
  CHECK(audit.energy(0).common() == Approx(audit.totals(0).first.common()).epsilon(1e-11));
  CHECK(audit.energy(0).scheme == Approx(audit.totals(0).scheme_start).epsilon(1e-11));
}
