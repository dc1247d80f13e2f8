// Without contact: the order in h of each scheme, and what a step leaves of frequencies far above 1/h.
#include <complex>
#include <ricochet/measure/stability/step_map.hpp>

#include "tests/amplification_roots.hpp"
#include "tests/plugins/time/family.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

using Complex = std::complex<double>;

// m x'' + c x' + k x = F cos(ωt + ψ), underdamped.
struct ForcedOscillator {
  double m = 1.7, c = 0.4, k = 23, F = 3, omega = 2.2, phase = 0.3, x = 0.3, v = -1.1;

  SceneSpec scene() const {
    SceneSpec scene;
    scene.structure = OscillatorSpec{m, k, c, {F, omega, phase}};
    scene.initial.displacement = Formula(x);
    scene.initial.velocity = Formula(v);
    return scene;
  }
  double exact(double t) const {
    const Complex forced = F * std::exp(Complex(0, phase)) / Complex(k - m * omega * omega, c * omega);
    const double decay = c / (2 * m), pulsation = std::sqrt(k / m - decay * decay);
    const double from = x - forced.real(), speed = v - (Complex(0, omega) * forced).real();
    return (forced * std::exp(Complex(0, omega * t))).real() +
           std::exp(-decay * t) *
               (from * std::cos(pulsation * t) + (speed + decay * from) / pulsation * std::sin(pulsation * t));
  }
};

// Slope of the largest error over [0, 2] s against h.
double measured_order(const ForcedOscillator& oscillator, const Choice& time) {
  std::vector<double> log_h, log_error;
  for (const double h : {0.02, 0.01, 0.005, 0.0025}) {
    Marcher mass = marcher(oscillator.scene(), 1, {{"consistent"}, {"none"}, time}, h);
    double worst = 0;
    mass.start();
    while (mass.time() < 2 - h / 2) {
      mass.march(1);
      worst = std::max(worst, std::abs(mass.tip(0) - oscillator.exact(mass.time())));
    }
    log_h.push_back(std::log(h));
    log_error.push_back(std::log(worst));
  }
  return fitted_slope(log_h, log_error);
}

std::vector<Choice> second_order_schemes() {
  return {scheme("newmark"),
          scheme("newmark-dumont-paoli"),
          scheme("newmark-dumont-paoli", {{"beta", 0.25}}),
          scheme("moreau-jean"),
          scheme("midpoint"),
          worded("midpoint", "constraint", "middle"),
          scheme("kane"),
          scheme("laursen-chawla"),
          scheme("hht-alpha"),
          scheme("hht-alpha", {{"alpha", -0.3}}),
          worded("hht-alpha", "contact", "weighted"),
          scheme("wbz-alpha"),
          scheme("wbz-alpha", {{"rho_inf", 0.0}}),
          scheme("generalised-alpha", {{"rho_inf", 1.0}}),
          scheme("generalised-alpha"),
          scheme("generalised-alpha", {{"rho_inf", 0.0}}),
          scheme("bathe"),
          scheme("bathe", {{"rho_inf", 0.8}}),
          scheme("bathe", {{"split", 0.5}}),
          scheme("contact-stabilised-newmark"),
          worded("contact-stabilised-newmark", "velocity", "corrected"),
          scheme("carpenter-taylor-katona"),
          scheme("paoli-schatzman", {{"restitution", 0.8}}),
          scheme("central-difference"),
          scheme("noh-bathe"),
          scheme("sdirk")};
}

// Slots that only the energy of the scheme reads have roots of their own, which are none of the motion: left out.
StepPlan motion_of(StepPlan plan, std::size_t slots) {
  plan.slots.resize(slots);
  plan.initial.resize(slots);
  plan.start.clear();
  plan.energy.clear();
  for (Stage& stage : plan.stages) {
    stage.update.resize(slots);
    for (const Combination& update : stage.update)
      for (std::size_t j = slots; j < update.slots.size(); ++j) REQUIRE(update.slots[j] == 0);
    stage.work.reset();
    stage.loss.clear();
  }
  return plan;
}

double radius_far_above(const Choice& time, std::size_t slots) {
  const double h = 1e-3, pulsation = 1e4 / h;
  const auto roots = amplification_roots(motion_of(plan_made(time, h), slots), 1, 0, pulsation * pulsation);
  return std::abs(roots.at(0));
}

}  // namespace

TEST_CASE("on the forced oscillator, damped or not, a scheme of order two has a slope of two") {
  ForcedOscillator oscillator;
  oscillator.c = GENERATE(0.4, 0.0);
  for (const Choice& time : second_order_schemes()) {
    INFO(label(time) << " c = " << oscillator.c);
    // hω ≤ 0.07: the next term of the error turns the slope by a few (hω)² = 0.005, most where ρ∞ = 0.
    CHECK(measured_order(oscillator, time) == Approx(2).margin(0.006));
  }
}

TEST_CASE("on the forced oscillator, schemes of other orders have theirs") {
  struct Row {
    Choice time;
    double damped, undamped, declared_damped, declared_undamped;
  };
  // cd-lagrange takes C w half a step late: of second order only where C = 0. Slopes of order one are of four steps
  // that still see the next term, most where the error of first order is small.
  const std::vector<Row> rows = {{scheme("sdirk", {{"order", 3LL}}), 2.994, 2.993, 3, 3},
                                 {scheme("cd-lagrange"), 1.103, 2.0, 1, 2},
                                 {scheme("newmark", {{"beta", 0.3025}, {"gamma", 0.6}}), 0.991, 0.991, 1, 1},
                                 {scheme("kane", {{"beta", 0.3}, {"gamma", 0.6}}), 0.991, 0.991, 1, 1},
                                 {scheme("moreau-jean", {{"theta", 0.7}}), 0.979, 0.979, 1, 1}};
  ForcedOscillator damped, undamped;
  undamped.c = 0;
  for (const Row& row : rows) {
    INFO(label(row.time));
    CHECK(measured_order(damped, row.time) == Approx(row.damped).margin(0.003));
    CHECK(measured_order(undamped, row.time) == Approx(row.undamped).margin(0.003));
    CHECK(plan_made(row.time, 0.01, {1, 0, true, false}).facts.order == row.declared_damped);
    CHECK(plan_made(row.time, 0.01, {1, 0, false, false}).facts.order == row.declared_undamped);
  }
}

TEST_CASE("at hω = 10⁴ a step leaves of an amplitude what the scheme is known for") {
  struct Row {
    Choice time;
    std::size_t slots;
    double radius, margin;
  };
  // Where the roots at infinity are one double root, they are 1/(hω) off it: hence 0.8017 of Chung–Hulbert's 0.8;
  // where three are zero, (hω)^(−2/3).
  const std::vector<Row> rows = {{scheme("generalised-alpha"), 3, 0.8017, 5e-5},
                                 {scheme("generalised-alpha", {{"rho_inf", 0.5}}), 3, 0.5017, 5e-5},
                                 {scheme("generalised-alpha", {{"rho_inf", 0.0}}), 3, 2.16e-3, 1e-5},
                                 {scheme("generalised-alpha", {{"rho_inf", 1.0}}), 3, 1, 1e-6},
                                 {scheme("wbz-alpha"), 3, 0.8, 1e-4},
                                 {scheme("wbz-alpha", {{"rho_inf", 0.0}}), 3, 2.16e-3, 1e-5},
                                 {scheme("hht-alpha"), 3, 0.9 / 1.1, 1e-4},
                                 {scheme("hht-alpha", {{"alpha", -0.3}}), 3, 0.7 / 1.3, 1e-4},
                                 {scheme("bathe"), 4, 4.8e-4, 1e-5},
                                 {scheme("bathe", {{"split", 0.5}}), 4, 5e-4, 1e-5},
                                 {scheme("bathe", {{"rho_inf", 0.8}}), 4, 0.8, 1e-4},
                                 {scheme("moreau-jean", {{"theta", 0.7}}), 2, 3.0 / 7, 1e-4},
                                 {scheme("sdirk"), 3, 4.8e-4, 1e-5},
                                 {scheme("sdirk", {{"order", 3LL}}), 3, std::sqrt(3.0) - 1, 1e-4},
                                 // β = γ/2 is the least β that is stable: two real roots, −1 and (1 − 1/γ).
                                 {scheme("kane", {{"beta", 0.3}, {"gamma", 0.6}}), 3, 1, 1e-6},
                                 {scheme("kane"), 2, 1, 1e-9},
                                 {scheme("midpoint"), 2, 1, 1e-9},
                                 {scheme("laursen-chawla"), 2, 1, 1e-9},
                                 {scheme("contact-stabilised-newmark"), 3, 1, 1e-9}};
  for (const Row& row : rows) {
    INFO(label(row.time));
    CHECK(radius_far_above(row.time, row.slots) == Approx(row.radius).margin(row.margin));
  }
}

TEST_CASE("the two Runge–Kutta schemes have the stability functions of their tableaux") {
  // R(z) = (1 + (1−2γ)z + n z²)/(1 − γz)² on x' = λx, z = ±iωh: n = 0 for order 2, ½ − 2γ + γ² for order 3.
  const double h = 1e-2;
  for (const long long order : {2LL, 3LL})
    for (const double frequency : {0.1, 1.0, 7.0, 300.0}) {
      const double gamma = order == 2 ? 1 - std::sqrt(0.5) : (3 + std::sqrt(3.0)) / 6;
      const double n = order == 2 ? 0 : 0.5 - 2 * gamma + gamma * gamma;
      const Complex z(0, frequency), pole = 1.0 - gamma * z;
      const Complex expected = (1.0 + (1 - 2 * gamma) * z + n * z * z) / (pole * pole);
      INFO("order " << order << " hω = " << frequency);
      const StepPlan plan = plan_made(scheme("sdirk", {{"order", order}}), h);
      const auto roots = amplification_roots(plan, 1, 0, std::pow(frequency / h, 2));
      REQUIRE(roots.size() == 3);
      // The slot a is rewritten before it is read: one root is zero.
      CHECK(std::abs(roots[2]) <= 1e-12);
      for (std::size_t k = 0; k < 2; ++k) {
        CHECK(roots[k].real() == Approx(expected.real()).margin(1e-10));
        CHECK(std::abs(roots[k].imag()) == Approx(std::abs(expected.imag())).margin(1e-10));
      }
    }
}
