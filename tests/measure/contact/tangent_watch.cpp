// Wear power of surfaces that slide under a force, in closed form.
#include <numbers>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/contact/tangent_watch.hpp>

#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double pi = std::numbers::pi, swing = 1e-3, turning = 20 * pi, force = 10;

/// A mass of 1 kg that a force of 10 N holds on a stop below while it swings along it, at 10 Hz.
SceneSpec sliding(const TangentSpec& tangent) {
  BeamFiles files;
  files.mass = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1\n2 2 1\n";
  files.stiffness = fmt::format("%%MatrixMarket matrix coordinate real symmetric\n2 2 1\n2 2 {}\n", turning * turning);
  files.dofs = "dof,node,component,x,y,z,held\n1,N,uy,0,0,0,\n2,N,ux,0,0,0,\n";
  SceneSpec scene = assembled_scene(assembled(files));
  scene.stops.named = {{"floor", at_node("N"), {}, 0.0, {}}};
  scene.stops.named[0].tangent = tangent;
  scene.load.terms = {{true, {}, {}, Formula(-force), at_node("N")}};
  scene.initial.dofs = {{2, 0, swing * turning}};
  return scene;
}

struct Watched {
  Marcher march;
  TangentWatch tangents;
  ImpactRecorder recorder;

  Watched(Marcher made, const WindowParts& window, double duration)
      : march(std::move(made)), tangents(march, window), recorder(march) {
    recorder.tell(&tangents);
    march.start({&tangents, &recorder});
    march.march(std::llround(duration / march.program().h) - march.step(), {&tangents, &recorder});
    tangents.finish(march);
    recorder.finish(march);
  }
};

}  // namespace

TEST_CASE("a mass held on a floor wears it by force times mean speed, 4 F a f") {
  const auto time = GENERATE(Choice{"newmark-dumont-paoli", {{"beta", 0.5}}}, Choice{"moreau-jean"});
  const auto tangent = GENERATE(TangentSpec{0, {}, "ux"}, TangentSpec{0, {-3, 0, 0}, ""});
  for (const double h : {4e-4, 1e-4}) {
    INFO(time.name << ", h = " << h);
    const Watched run(marcher(sliding(tangent), 1, {{"consistent"}, {"signorini"}, time}, h), {0, 1, 4}, 1);
    // ∫|v| over a period is 4 a; at the ends of a swing a sub-step turns within, by (ωh)²/8 of it at most.
    const double power = force * 2 * swing * 20, share = std::pow(turning * h, 2);
    CHECK(power == Approx(0.4).epsilon(1e-15));
    CHECK(run.tangents.power(0) == Approx(power).epsilon(std::max(share, 3 * h)));
    if (h < 2e-4) CHECK(run.tangents.power(0) == Approx(power).epsilon(1e-4));
    double parts = 0;
    for (int part = 0; part < 4; ++part) parts += run.tangents.work(0, part);
    CHECK(parts == Approx(run.tangents.power(0)).epsilon(1e-12));
    // Half a second is five swings.
    CHECK(run.tangents.work(0, 0) + run.tangents.work(0, 1) == Approx(power / 2).epsilon(2e-3));
  }
}

TEST_CASE("a surface that runs under a mass at rest wears by force times its speed, without friction") {
  TangentSpec runs{0, {}, "ux"};
  runs.speed = 0.4;
  SceneSpec scene = sliding(runs);
  scene.initial.dofs = {};
  const Watched run(marcher(scene, 1, {{"consistent"}, {"signorini"}, {"moreau-jean"}}, 1e-3), {0, 1}, 1);
  CHECK(run.tangents.power(0) == Approx(force * runs.speed).epsilon(3e-3));  // a step of a thousand
}

TEST_CASE("a window counts what slides in it alone, and a stop without a tangent has none") {
  const Watched run(marcher(sliding({0, {}, "ux"}), 1, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}}, 1e-4),
                    {0.5, 0.6}, 1);
  CHECK(run.tangents.power(0) == Approx(0.4).epsilon(2e-3));
  SceneSpec plain = sliding({0, {}, "ux"});
  plain.stops.named[0].tangent.reset();
  const Marcher without = marcher(plain, 1, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}}, 1e-4);
  const TangentWatch none(without, {0, 1});
  CHECK_FALSE(none.any());
  CHECK_FALSE(none.has(0));
}

// A free mass thrown obliquely at a wall that has no friction keeps its speed along it: I is 2 m v, V is w.
TEST_CASE("an oblique impact wears by impulse times speed along the surface, whatever the step") {
  BeamFiles files;
  files.mass = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 3\n2 2 3\n";
  files.stiffness = "%%MatrixMarket matrix coordinate real symmetric\n2 2 0\n";
  files.dofs = "dof,node,component,x,y,z,held\n1,N,uy,0,0,0,\n2,N,ux,0,0,0,\n";
  SceneSpec scene = assembled_scene(assembled(files));
  scene.stops.named = {{"wall", at_node("N"), {}, {}, 0.1}};
  scene.stops.named[0].tangent = TangentSpec{0, {}, "ux"};
  scene.initial.dofs = {{1, 0, 2}, {2, 0, -0.7}};
  for (const double h : {1e-3, 1.7e-4}) {
    const Watched run(
        marcher(scene, 1, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"restitution", 1.0}}}}, h),
        {0, 0.1}, std::round(0.1 / h) * h);
    const double impulse = 2 * 3 * 2;
    CHECK(run.tangents.power(0) == Approx(impulse * 0.7 / 0.1).epsilon(1e-9));
    CHECK(run.tangents.speed_at(0) == Approx(-0.7).epsilon(1e-9));
    CHECK(std::isnan(run.tangents.speed_at(1)));
    // A surface that runs the other way is met so much faster.
    SceneSpec running = scene;
    running.stops.named[0].tangent->speed = 0.5;
    const Watched faster(
        marcher(running, 1, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"restitution", 1.0}}}}, h),
        {0, 0.1}, std::round(0.1 / h) * h);
    CHECK(faster.tangents.speed_at(0) == Approx(-1.2).epsilon(1e-9));
    CHECK(faster.tangents.power(0) == Approx(impulse * 1.2 / 0.1).epsilon(1e-9));
  }
}
