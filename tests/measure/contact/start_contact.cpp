// Contact that is there from the start is no impact, whoever counts; a point thrown at the stop it lies on is one.
#include <fmt/format.h>

#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/motion/motion_sampler.hpp>

#include "tests/plugins/contact/impacts.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double weight = 5, h = 1e-3, duration = 0.3;

/// Everybody who counts contact, at one integration.
struct Counted {
  Marcher march;
  EnergyAudit audit;
  ImpactRecorder recorder;
  ContactLog log;

  explicit Counted(Marcher made, double until = duration)
      : march(std::move(made)), audit(march), recorder(march), log(march) {
    const Observers all{&audit, &recorder, &log};
    march.start(all);
    march.march(std::llround(until / march.program().h) - march.step(), all);
    recorder.finish(march);
    REQUIRE(march.status(0).running);
  }
  int logged() const {
    return static_cast<int>(std::count_if(log.events().begin(), log.events().end(),
                                          [](const ContactEvent& event) { return event.begins; }));
  }
  /// All say so many impacts.
  void impacts(long long expected) const {
    CHECK(audit.contact(0).impacts == expected);
    CHECK(recorder.count(0) == expected);
    CHECK(static_cast<long long>(recorder.impacts(0).size()) == expected);
    CHECK(recorder.totals(0, 0, StopSide::lower).impacts == expected);
    CHECK(logged() == expected);
    CHECK((audit.contact(0).first_impact < 0) == (expected == 0));
  }
};

/// A mass on its stop at 0, with a weight that presses it down, thrown down at `speed`.
SceneSpec pressed(double speed, const std::string& load = "-5") {
  SceneSpec scene = thrown_mass(0.0, speed);
  scene.load = Formula(load, "/scene/load");
  return scene;
}

Choice on_spring(const char* law, const char* evaluation) {
  Choice choice{law, {{"stiffness", 1e4}, {"evaluation", std::string(evaluation)}}};
  if (choice.name == "kelvin-voigt") choice.values["viscosity"] = 20.0;
  return choice;
}

}  // namespace

TEST_CASE("a mass that is pressed on its rigid stop at t = 0 hits nothing, whatever the scheme") {
  const auto time =
      GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"newmark-dumont-paoli", {{"restitution", 0.5}}},
               Choice{"newmark-dumont-paoli", {{"start", std::string("first-order")}}}, Choice{"moreau-jean"},
               Choice{"moreau-jean", {{"restitution", 0.5}}}, Choice{"paoli-schatzman"}, Choice{"cd-lagrange"},
               Choice{"nonsmooth-generalised-alpha"}, Choice{"contact-stabilised-newmark"});
  INFO(time.name << " " << time.values.size());
  const Counted run(marcher(pressed(0), 1, {{"consistent"}, {"signorini"}, time}, h));
  run.impacts(0);
  const StopTotals& totals = run.recorder.totals(0, 0, StopSide::lower);
  CHECK(totals.fastest == 0);
  // Contact for as long as the integration, but for what the start rule does not ask.
  CHECK(totals.contact_time == Approx(duration).margin(2 * h));
  CHECK(totals.impulse == Approx(weight * duration).margin(2 * weight * h));
  CHECK(totals.impulse == Approx(run.audit.contact(0).impulse).epsilon(1e-12));
}

TEST_CASE("a mass that is pressed into a spring from its surface is in contact from the start") {
  const auto law = GENERATE(on_spring("penalty", "implicit"), on_spring("penalty", "explicit"),
                            on_spring("penalty", "averaged"), on_spring("penalty", "conserving"),
                            on_spring("kelvin-voigt", "implicit"), Choice{"hertz", {{"stiffness", 1e8}}});
  const auto time = GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"newmark"}, Choice{"moreau-jean"},
                             Choice{"newmark-dumont-paoli", {{"start", std::string("first-order")}}},
                             Choice{"generalised-alpha"}, Choice{"bathe"});
  INFO(law.name << ", " << time.name);
  // It goes down 2·weight/k and comes back to the surface at rest: half of that is watched.
  const double half = law.name == "hertz" ? 0.004 : M_PI / 100;
  auto program = compiled(problem_of(pressed(0), 1, {"consistent"}, law), {{"consistent"}, law, time}, h / 10);
  if (std::holds_alternative<Refusal>(program)) return;
  const Counted run(Marcher(std::move(std::get<Program>(program))), half);
  run.impacts(0);
  const StopTotals& totals = run.recorder.totals(0, 0, StopSide::lower);
  CHECK(totals.impulse > 0.5 * weight * half);
  CHECK(totals.contact_time == Approx(half).margin(3 * h / 10));
}

TEST_CASE("a mass that starts on its stop and moves into it hits it at t = 0, with its speed") {
  const double e = GENERATE(0.0, 0.5);
  const auto methods = GENERATE(
      Methods{{"consistent"}, {"signorini"}, {"moreau-jean"}},
      Methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"start", std::string("first-order")}}}},
      Methods{{"consistent"}, on_spring("penalty", "implicit"), {"newmark"}},
      Methods{{"consistent"}, on_spring("penalty", "explicit"), {"newmark-dumont-paoli"}});
  Methods with = methods;
  if (with.contact.name == "signorini") with.time.values["restitution"] = e;
  INFO(with.contact.name << ", " << with.time.name << ", e = " << e);
  const Counted run(marcher(pressed(0.7), 1, with, h), 0.02);
  REQUIRE_FALSE(run.recorder.impacts(0).empty());
  const Impact& impact = run.recorder.impacts(0).front();
  CHECK(impact.speed_in == Approx(0.7).margin(2 * weight * h));
  CHECK(impact.time <= 2 * h);
  CHECK(run.audit.contact(0).first_impact == impact.time);
  CHECK(run.audit.contact(0).impacts == run.recorder.count(0));
  CHECK(run.logged() >= 1);
}

TEST_CASE("what was lifted from its stop and falls back hits it") {
  // Pressed until sin(20 t) = ½, lifted, and back.
  const auto time = GENERATE(Choice{"moreau-jean"}, Choice{"newmark-dumont-paoli"});
  INFO(time.name);
  const Counted run(marcher(pressed(0, "-5 + 10*sin(20*t)"), 1, {{"consistent"}, {"signorini"}, time}, h / 10));
  run.impacts(1);
  CHECK(run.recorder.impacts(0).front().speed_in > 0.05);
  CHECK(std::any_of(run.log.events().begin(), run.log.events().end(), [](const ContactEvent& event) {
    return !event.begins && std::abs(event.time - std::asin(0.5) / 20) < 2 * h;
  }));
}

TEST_CASE("a load that begins to press later has not thrown what lay on its stop") {
  // Nothing presses at t = 0 itself.
  const auto methods = GENERATE(Methods{{"consistent"}, {"signorini"}, {"moreau-jean"}},
                                Methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}},
                                Methods{{"consistent"}, on_spring("penalty", "explicit"), {"newmark"}});
  INFO(methods.contact.name << ", " << methods.time.name);
  const Counted run(marcher(pressed(0, "-5*sin(10*t)"), 1, methods, h), 0.05);
  run.impacts(0);
  CHECK(run.audit.contact(0).impulse > 0);
}

TEST_CASE("a beam that is bent and lies on its stop with its tip") {
  // Under q = −2 N/m with the tip held at −0.01 m by R = 3qL/8 − 3EIδ/L³.
  const auto mass = GENERATE(Choice{"consistent"}, Choice{"singular"});
  const auto time = GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"moreau-jean"}, Choice{"bathe"});
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-3;
  const SectionProperties section =
      section_properties(beam_of(scene).section, beam_of(scene).young, beam_of(scene).density);
  const double L = beam_of(scene).length, q = 2, drop = 0.01;
  const double reaction = 3 * q * L / 8 - 3 * section.EI * drop / std::pow(L, 3);
  scene.stops = {};
  scene.stops.lower = Formula(-drop);
  scene.stops.place = StopsSpec::Place::tip;
  scene.load = Formula(-q);
  const std::string shape =
      fmt::format("(-{0:.17g}*x^2*(6*{1:.17g}^2 - 4*{1:.17g}*x + x^2)/24 + {2:.17g}*x^2*(3*{1:.17g} - x)/6)/{3:.17g}",
                  q, L, reaction, section.EI);
  scene.initial.displacement = Formula(shape, "/scene/initial/displacement", "x");
  scene.initial.velocity = Formula(0.0);
  INFO(mass.name << ", " << time.name);
  auto program = compiled(problem_of(scene, 8, mass), {mass, {"signorini"}, time}, 1e-4);
  if (std::holds_alternative<Refusal>(program)) return;
  const Counted run(Marcher(std::move(std::get<Program>(program))), 0.1);
  run.impacts(0);
  // At rest but for what the mesh does to a quartic.
  CHECK(run.audit.contact(0).impulse == Approx(0.1 * reaction).epsilon(0.02));
}
