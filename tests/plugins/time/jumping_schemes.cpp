// Schemes whose velocities jump beside a smooth acceleration: nonsmooth generalised α, and Kane's for any β and γ.
#include <complex>
#include <ricochet/measure/stability/plan_restitution.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace jumping_schemes_tests {
namespace {

Choice alpha(double rho, const std::string& position = "half", double e = 0) {
  return {"nonsmooth-generalised-alpha", {{"rho_inf", rho}, {"restitution", e}, {"position", position}}};
}
Choice kane(double beta, double gamma, const std::string& impulse = "energy") {
  return {"kane", {{"beta", beta}, {"gamma", gamma}, {"impulse", impulse}}};
}

struct Thrown {
  double gain = 0, common_gain = 0;  // over the first energy
  double force = 0;                  // mean over the contact, N
};

// Largest gain of a step, of the scheme's own energy and of ½|v|²_M + ½|q|²_K; mean force over the contact.
Thrown thrown(const Choice& time, double h = 0.005) {
  Marcher bar = marcher(thrown_bar(), 20, {{"consistent"}, {"signorini"}, time}, h);
  EnergyAudit audit(bar);
  bar.start(&audit);
  Thrown found;
  double before = 0, first = 0;
  int steps = 0;
  while (bar.time() < 1.5) {
    bar.march(1, &audit);
    const double now = audit.energy(0).common();
    if (first == 0) first = before = now;
    found.common_gain = std::max(found.common_gain, (now - before) / first);
    before = now;
    if (bar.time() < 0.55 || bar.time() > 1.1) continue;
    found.force += audit.contact(0).force;
    ++steps;
  }
  found.gain = audit.totals(0).largest_step_gain / audit.totals(0).scheme_start;
  found.force /= steps;
  return found;
}

StepPlan plan(const Choice& time, double h, bool contact) {
  auto made = plan_of(time, h, {1, 0, false, contact});
  REQUIRE(std::holds_alternative<StepPlan>(made));
  return std::get<StepPlan>(made);
}

std::string values_of(const Choice& time) {
  std::string text;
  for (const auto& [key, value] : time.values)
    if (const auto* number = std::get_if<double>(&value)) text += key + " = " + std::to_string(*number) + " ";
  return text;
}

SceneSpec beam_between_stops() {
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  return scene;
}

}  // namespace

TEST_CASE("nonsmooth generalised α: at ρ∞ = 1 positions that move by half of a jump are those that move by β/γ of it") {
  for (const double e : {0.0, 0.8}) {
    Marcher half = marcher(thrown_bar(), 20, {{"consistent"}, {"signorini"}, alpha(1, "half", e)}, 0.005);
    Marcher beta = marcher(thrown_bar(), 20, {{"consistent"}, {"signorini"}, alpha(1, "beta", e)}, 0.005);
    run(half, 1.5);
    run(beta, 1.5);
    CHECK((half.position(0) - beta.position(0)).norm() <= 1e-10 * half.position(0).norm());
  }
  // Below they are two schemes.
  Marcher half = marcher(thrown_bar(), 20, {{"consistent"}, {"signorini"}, alpha(0.8)}, 0.005);
  Marcher beta = marcher(thrown_bar(), 20, {{"consistent"}, {"signorini"}, alpha(0.8, "beta")}, 0.005);
  run(half, 1.5);
  run(beta, 1.5);
  CHECK((half.position(0) - beta.position(0)).norm() > 1e-5 * half.position(0).norm());
}

TEST_CASE("nonsmooth generalised α restitutes e at every phase of the impact") {
  for (const char* position : {"half", "beta", "projected"})
    for (const double rho : {0.0, 0.5, 0.8, 1.0})
      for (const double e : {0.0, 0.3, 0.8, 1.0}) {
        const auto range = restitution_range(plan(alpha(rho, position, e), 1e-3, true), 1e-3);
        INFO(position << " ρ∞ = " << rho << " e = " << e);
        REQUIRE(range);
        CHECK(range->least == Approx(e).margin(1e-11));
        CHECK(range->most == Approx(e).margin(1e-11));
      }
}

TEST_CASE("nonsmooth generalised α and Kane's scheme are of second order in free motion, damped and forced") {
  const double m = 1.7, c = 0.4, k = 23, F = 3, omega = 2.2, psi = 0.3;
  SceneSpec scene;
  scene.structure = OscillatorSpec{m, k, c, {F, omega, psi}};
  scene.initial.displacement = Formula(0.3);
  scene.initial.velocity = Formula(-1.1);
  using Complex = std::complex<double>;
  const Complex i(0, 1), forced = F * std::exp(i * psi) / (k - m * omega * omega + i * omega * c);
  const double decay = c / (2 * m), turn = std::sqrt(k / m - decay * decay);
  const double a = 0.3 - forced.real(), b = (-1.1 - (i * omega * forced).real() + decay * a) / turn;
  const auto exact = [&](double t) {
    return (forced * std::exp(i * omega * t)).real() +
           std::exp(-decay * t) * (a * std::cos(turn * t) + b * std::sin(turn * t));
  };
  std::vector<Choice> all;
  for (const char* position : {"half", "beta", "projected"})
    for (const double rho : {0.0, 0.8, 1.0}) all.push_back(alpha(rho, position));
  for (const double beta : {0.0, 0.2, 0.25, 0.4}) all.push_back(kane(beta, 0.5));
  for (const Choice& time : all) {
    std::vector<double> log_h, log_error;
    for (const double h : {0.02, 0.01, 0.005, 0.0025}) {
      Marcher mass = marcher(scene, 1, {{"consistent"}, {"none"}, time}, h);
      mass.start();
      double worst = 0;
      while (mass.time() < 2 - h / 2) {
        mass.march(1);
        worst = std::max(worst, std::abs(mass.tip(0) - exact(mass.time())));
      }
      log_h.push_back(std::log(h));
      log_error.push_back(std::log(worst));
    }
    INFO(time.name << " " << values_of(time));
    CHECK(fitted_slope(log_h, log_error) == Approx(2).margin(0.02));
  }
}

TEST_CASE("nonsmooth generalised α: half of a jump never gains in the scheme's energy, β/γ of it does") {
  // Largest gain of ½|v|²_M + ½|q|²_K in one step, as measured here and by an independent march of the published form.
  struct Gain {
    double rho, half, beta;
  };
  for (const Gain& of : {Gain{0.8, 1.74e-5, 3.59e-4}, Gain{0.5, 1.20e-4, 2.63e-3}, Gain{0.2, 4.67e-4, 6.89e-3},
                         Gain{0.0, 5.72e-4, 7.39e-3}}) {
    const Thrown half = thrown(alpha(of.rho)), beta = thrown(alpha(of.rho, "beta"));
    INFO("ρ∞ = " << of.rho);
    CHECK(half.gain < 1e-11);  // round-off of 500 J in each of 300 steps
    CHECK(half.common_gain == Approx(of.half).epsilon(0.05));
    CHECK(beta.common_gain == Approx(of.beta).epsilon(0.05));
    CHECK(beta.gain > 0.5 * of.beta);
    for (const Thrown* bar : {&half, &beta}) CHECK(bar->force == Approx(300).epsilon(0.02));
  }
  for (const double rho : {0.0, 0.5, 1.0})
    for (const double e : {0.0, 0.8}) {
      Marcher beam = marcher(beam_between_stops(), 10, {{"consistent"}, {"signorini"}, alpha(rho, "half", e)}, 1e-4);
      const EnergyAudit audit = audited(beam, 0.3);
      CHECK(audit.contact(0).impacts > 0);
      CHECK(audit.totals(0).largest_step_gain <= 1e-12 * audit.totals(0).scheme_start);
    }
}

TEST_CASE("nonsmooth generalised α: a projection keeps the stop at the end of each step") {
  const auto deepest = [](const char* position) {
    Marcher bar = marcher(thrown_bar(), 20, {{"consistent"}, {"signorini"}, alpha(0.8, position)},
                          0.0047);  // the bar meets the wall within a step
    return audited(bar, 1.5).contact(0).deepest_penetration;
  };
  CHECK(deepest("projected") <= 1e-12);
  for (const char* position : {"half", "beta"}) {
    CHECK(deepest(position) > 1e-4);
    CHECK(deepest(position) < 0.05);  // the way of a step
  }
}

TEST_CASE(
    "Kane's contact gives no energy whatever β and γ, with the R that the energy has, and does with the mass alone") {
  for (const auto& [beta, gamma, mass] :
       {std::tuple(0.3, 0.5, 1.67e-3), {0.5, 0.5, 8.63e-3}, {0.0, 0.5, 1.91e-3}, {0.4, 0.6, 2.00e-3}}) {
    INFO("β = " << beta << " γ = " << gamma);
    CHECK(thrown(kane(beta, gamma)).gain < 1e-11);
    CHECK(thrown(kane(beta, gamma, "mass")).gain == Approx(mass).epsilon(0.05));
    Marcher beam =
        marcher(beam_between_stops(), 10, {{"consistent"}, {"signorini"}, kane(beta, gamma)}, beta == 0 ? 1e-6 : 1e-4);
    const EnergyAudit audit = audited(beam, beta == 0 ? 0.06 : 0.3);
    CHECK(audit.contact(0).impacts > 0);
    CHECK(audit.totals(0).largest_step_gain <= 1e-12 * audit.totals(0).scheme_start);
    CHECK(audit.contact(0).deepest_penetration <= 1e-12);
  }
  // At β = γ/2 the jump is what the two solves of that form give.
  Marcher near = marcher(thrown_bar(), 20, {{"consistent"}, {"signorini"}, kane(0.25 + 1e-12, 0.5)}, 0.005);
  Marcher at = marcher(thrown_bar(), 20, {{"consistent"}, {"signorini"}, kane(0.25, 0.5)}, 0.005);
  run(near, 1.5);
  run(at, 1.5);
  CHECK((near.position(0) - at.position(0)).norm() <= 1e-8 * at.position(0).norm());
}

TEST_CASE("an effort that jumps velocities conserves with laws that conserve") {
  for (const Choice& time : {alpha(1), alpha(1, "beta"), kane(0.3, 0.5), kane(0.0, 0.5)}) {
    const Choice penalty{"penalty", {{"stiffness", 2e3}, {"evaluation", std::string("conserving")}}};
    Marcher bar = marcher(thrown_bar(), 20, {{"consistent"}, penalty, time}, 0.005);
    EnergyAudit audit(bar);
    bar.start(&audit);
    double first = 0, worst = 0;
    while (bar.time() < 1.5) {
      bar.march(1, &audit);
      const double now = audit.energy(0).scheme + audit.energy(0).contact;
      if (first == 0) first = now;
      worst = std::max(worst, std::abs(now - first) / first);
    }
    INFO(time.name);
    CHECK(audit.contact(0).impacts > 0);
    CHECK(worst < 1e-10);
  }
}

TEST_CASE("a velocity that jumps needs a regular mass") {
  for (const char* position : {"half", "beta", "projected"}) {
    const auto refused = plan_of(alpha(0.8, position), 1e-3, {12, 3, false, true});
    REQUIRE(std::holds_alternative<Refusal>(refused));
    CHECK_THAT(std::get<Refusal>(refused).sentence.text,
               Catch::Contains("singular") && Catch::Contains("or a regular mass"));
  }
  CHECK(std::holds_alternative<Refusal>(plan_of(kane(0.3, 0.5), 1e-3, {12, 3, false, true})));
}
}  // namespace jumping_schemes_tests
