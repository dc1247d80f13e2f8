// The marching code against closed forms on the two small structures: bouncing ball, springs in contact, period-3 bar,
// static rest, and the scaling of units.
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SceneSpec ball(double height, double gravity) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = 2, .stiffness = 0, .damping = 0, .force = {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.load = Formula(-2 * gravity);
  scene.initial.displacement = Formula(height);
  return scene;
}

}  // namespace

TEST_CASE("a ball falls as parabolas do, and bounces to e² of its height") {
  const double g = 9.81, height = 1.3, e = 0.8, fall = std::sqrt(2 * height / g);
  for (const Choice& time :
       {Choice{"newmark-dumont-paoli", {{"restitution", e}}}, Choice{"moreau-jean", {{"restitution", e}}}}) {
    INFO(time.name);
    for (const double h : {1e-3, 1e-4}) {
      Marcher free = marcher(ball(height, g), 1, {{"consistent"}, {"signorini"}, time}, h);
      run(free, 0.4);
      CHECK(free.tip(0) ==
            Approx(height - 0.5 * g * 0.16).margin(1e-11));  // exact for a constant force, up to round-off
      Marcher bounced = marcher(ball(height, g), 1, {{"consistent"}, {"signorini"}, time}, h);
      // At the top of the first bounce: impact times are known to a step, hence heights to h·v.
      run(bounced, std::round((fall + e * fall) / h) * h);
      CHECK(bounced.tip(0) == Approx(e * e * height).margin(10 * h));
    }
  }
}

TEST_CASE("a mass on a penalty spring stays in contact for half a period and goes as deep as its energy") {
  // v = 1 m/s towards the stop from the stop itself, m = 2 kg, k = 5000 N/m: π√(m/k) and v√(m/k).
  SceneSpec scene = ball(0, 0);
  scene.load = Formula(0.0);
  scene.initial.velocity = Formula(-1.0);
  const double k = 5000, h = 1e-6, omega = std::sqrt(k / 2);
  for (const Choice& time :
       {Choice{"newmark-dumont-paoli", {{"beta", 0.25}}}, Choice{"moreau-jean"}, Choice{"newmark"}}) {
    INFO(time.name);
    Choice law{"penalty", {{"stiffness", k}}};
    Marcher made = marcher(scene, 1, {{"consistent"}, law, time}, h);
    const EnergyAudit audit = audited(made, 0.1);
    // An effort taken at the end of the step damps like h ω = 5e-5.
    CHECK(audit.contact(0).deepest_penetration == Approx(1 / omega).epsilon(5e-5));
    CHECK(audit.contact(0).first_release == Approx(3.14159265358979 / omega).margin(3 * h));
    CHECK(audit.totals(0).last.common() == Approx(1).epsilon(3e-4));  // ½·2·1², less π h ω
  }
}

TEST_CASE("the period-3 bar: contact from 1 to 2 with stress one half, energy one eighth, for a massless end") {
  const double h = 1e-3;
  Marcher bar = marcher(released_bar(1, "(1-x)/2"), 100,
                        {{"redistributed"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.25}}}}, h);
  const EnergyAudit audit = audited(bar, 2.5);
  // The front is smeared over a few elements by dispersion, (1/100)^(2/3) of the length.
  CHECK(audit.contact(0).first_impact == Approx(1).margin(0.03));
  CHECK(audit.contact(0).impulse == Approx(0.5).epsilon(0.03));  // stress ½ over one second
  CHECK(audit.totals(0).last.common() == Approx(0.125).epsilon(0.02));
  // The end stands at τ/2 on its way back, half a second after the release. β = ¼ leaves the massless end its sawtooth;
  // the mean of two steps has none.
  const double before = bar.tip(0);
  bar.march(1);
  CHECK(0.5 * (before + bar.tip(0)) == Approx(0.25).margin(0.01));
}

TEST_CASE("a mass that rests on its stop weighs what it weighs, for a hundred thousand steps") {
  for (const double e : {0.0, 0.5}) {
    for (const std::string scheme : {"newmark-dumont-paoli", "moreau-jean"}) {
      INFO(scheme << " e = " << e);
      Marcher rest = marcher(ball(0, 9.81), 1, {{"consistent"}, {"signorini"}, {scheme, {{"restitution", e}}}}, 1e-3);
      const EnergyAudit audit = audited(rest, 100);
      CHECK(audit.contact(0).force == Approx(2 * 9.81).epsilon(1e-12));
      // A velocity-level scheme falls for the one or two steps that it takes to feel the stop, g h² each.
      CHECK(std::abs(rest.tip(0)) <= 2 * 9.81 * 1e-6);
      CHECK(audit.totals(0).last.common() <= 1e-15);
    }
  }
}

TEST_CASE("results scale with the units: lengths in millions, times in thousandths, masses in billionths") {
  // u → λu, x → λx, t → τt, m → μm:  EI → μλ³/τ², ρS → μ/λ, stops → λ, speeds → λ/τ.
  const double L = 1e6, T = 1e-3, M = 1e-9;
  const auto scene = [](double l, double t, double m) {
    SceneSpec beam = working_set();
    const auto base = section_properties(beam_of(beam).section, beam_of(beam).young, beam_of(beam).density);
    beam_of(beam).section = Section{};
    beam_of(beam).section.type = Section::Type::given;
    beam_of(beam).section.EI = base.EI * m * l * l * l / (t * t);
    beam_of(beam).section.rhoS = base.rhoS * m / l;
    beam_of(beam).length *= l;
    beam_of(beam).damping.stiffness = 1e-4 * t;
    beam.stops.lower = Formula(-0.1 * l);
    beam.stops.upper = Formula(0.1 * l);
    const std::string text = std::to_string(0.04) + "*x^2/" + std::to_string(l);
    beam.initial.displacement = Formula(text, "/scene/initial/displacement", "x");
    beam.initial.velocity = Formula("-2*x/" + std::to_string(t), "/scene/initial/velocity", "x");
    return beam;
  };
  for (const std::string name : {"consistent", "singular"}) {
    for (const double stiffness : {0.0, 1e6}) {
      const Choice law = stiffness > 0 ? Choice{"penalty", {{"stiffness", stiffness}}} : Choice{"signorini"};
      const Choice scaled_law = stiffness > 0 ? Choice{"penalty", {{"stiffness", stiffness * M / (T * T)}}} : law;
      Marcher plain = marcher(scene(1, 1, 1), 8, {{name}, law}, 1e-4);
      Marcher scaled = marcher(scene(L, T, M), 8, {{name}, scaled_law}, 1e-4 * T);
      run(plain, 0.1);
      run(scaled, 0.1 * T);
      INFO(name << ' ' << stiffness);
      REQUIRE(scaled.status(0).running);
      // Round-off of a thousand steps through a handful of contacts, each of which magnifies it.
      CHECK(scaled.tip(0) / L == Approx(plain.tip(0)).margin(1e-8));
    }
  }
}

TEST_CASE("a load that starts from nothing does not pass for divergence") {
  SceneSpec scene = working_set();
  scene.initial = {};
  scene.stops.lower = Formula("-1e-9*x", "/scene/stops/lower", "x");
  scene.stops.upper = Formula("1e-9*x", "/scene/stops/upper", "x");
  scene.load = Formula("2*sin(40*t)*x", "/scene/load", "xt");
  Marcher beam = marcher(scene, 6, {{"consistent"}, {"none"}}, 1e-4);
  run(beam, 0.2);
  CHECK(beam.status(0).running);
}
