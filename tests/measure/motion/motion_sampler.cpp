#include <ricochet/measure/motion/motion_errors.hpp>
#include <ricochet/measure/motion/motion_sampler.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SceneSpec oscillator() {
  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = 1, .stiffness = 4, .damping = 0, .force = {}};
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(1.0);
  return scene;
}

SampleGrid times(double until, int count) {
  SampleGrid grid;
  for (int k = 0; k <= count; ++k) grid.times.push_back(until * k / count);
  return grid;
}

SampledMotion sampled(const SceneSpec& scene, int elements, const Methods& methods, double h, const SampleGrid& grid) {
  Marcher made = marcher(scene, elements, methods, h);
  MotionSampler sampler(made, grid);
  sampler.march([] { return true; });
  REQUIRE(sampler.sampled() == grid.times.size());
  return sampler.finish();
}

}  // namespace

TEST_CASE("sampled: an oscillator's cosine, at second order, at steps and between them, whatever the scheme") {
  const std::vector<Choice> schemes = {{"newmark-dumont-paoli", {{"beta", 0.25}}}, {"newmark"}, {"moreau-jean"}};
  for (const Choice& scheme : schemes)
    for (const double shift : {0.0, 0.37}) {
      INFO(scheme.name << " shift " << shift);
      std::vector<double> errors;
      for (const double h : {2e-2, 1e-2}) {
        SampleGrid grid = times(3, 30);
        for (double& t : grid.times)
          if (t > 0) t -= shift * h;
        const SampledMotion motion = sampled(oscillator(), 1, {{"consistent"}, {"none"}, scheme}, h, grid);
        double worst = 0;
        for (std::size_t k = 0; k < grid.times.size(); ++k) {
          const double t = grid.times[k];
          worst = std::max({worst, std::abs(motion.tip[k] - std::cos(2 * t)),
                            std::abs(motion.tip_velocity[k] + 2 * std::sin(2 * t)), std::abs(motion.energy[k] - 2)});
        }
        errors.push_back(worst);
      }
      // Halving the step divides the error by four; the next term is of relative size h.
      CHECK(errors[0] / errors[1] == Approx(4).margin(0.15));
    }
}

TEST_CASE("sampled: fields are those of the beam, clamp included, and their norms are exact for polynomials") {
  SceneSpec scene = working_set();
  scene.stops = {};
  scene.initial.displacement = Formula("0.01*x^3", "/scene/initial/displacement", "x");
  scene.initial.velocity = Formula(0.0);
  SampleGrid grid = times(1e-3, 2);
  sample_places(1.501, 64, grid);
  const SampledMotion motion = sampled(scene, 10, {{"consistent"}, {"none"}}, 1e-5, grid);
  double displaced = 0, strained = 0;
  for (std::size_t i = 0; i < grid.places.size(); ++i) {
    const double x = grid.places[i];
    CHECK(motion.displacement[i] == Approx(0.01 * x * x * x).margin(1e-15));
    CHECK(motion.strain[i] == Approx(0.06 * x).margin(1e-10));
    displaced += grid.weights[i] * motion.displacement[i] * motion.displacement[i];
    strained += grid.weights[i] * motion.strain[i] * motion.strain[i];
  }
  // ∫ 1e-4 x⁶ = 1e-4 L⁷/7 within the error of two Gauss points in 64 cells, (1/64)⁴; ∫ 0.0036 x² exactly.
  CHECK(displaced == Approx(1e-4 * std::pow(1.501, 7) / 7).epsilon(1e-6));
  CHECK(strained == Approx(0.0036 * std::pow(1.501, 3) / 3).epsilon(1e-8));
}

TEST_CASE("contact log: impacts and releases of the reference solution, within a step, with their speeds") {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  const double h = 1e-5;
  const SampledMotion motion =
      sampled(scene, 20, {{"singular"}, {"signorini"}, {"newmark-dumont-paoli"}}, h, times(0.15, 10));
  REQUIRE(motion.events.size() >= 2);
  // The continuous problem's figures; 20 elements and h = 1e-5 are within a few steps of it.
  CHECK(motion.events[0].begins);
  CHECK(motion.events[0].side == -1);
  CHECK(motion.events[0].time == Approx(0.0487745646).margin(3 * h));
  CHECK(motion.events[0].velocity == Approx(-3.85453013).epsilon(1e-3));
  CHECK_FALSE(motion.events[1].begins);
  CHECK(motion.events[1].time == Approx(0.0598140489).margin(5 * h));
  CHECK(motion.impulse.front() == 0);
  CHECK(motion.impulse.back() > 0);  // the lower stop pushes upwards
}

TEST_CASE("impulse: what the stop gave is what the momentum took, at the sampled times themselves") {
  // A free mass on a spring-loaded stop: m Δv = ∫p. A penalty makes the force smooth, so that half a step shows.
  SceneSpec scene = oscillator();
  std::get<OscillatorSpec>(scene.structure).stiffness = 0;
  scene.stops.lower = Formula(0.0);
  scene.initial.displacement = Formula(0.0);
  scene.initial.velocity = Formula(-1.0);
  for (const Choice& scheme :
       {Choice{"newmark-dumont-paoli", {{"beta", 0.25}}}, Choice{"moreau-jean"}, Choice{"newmark"}}) {
    INFO(scheme.name);
    const double h = 1e-4;
    const SampledMotion motion =
        sampled(scene, 1, {{"consistent"}, {"penalty", {{"stiffness", 100.0}}}, scheme}, h, times(0.2, 20));
    for (std::size_t k = 0; k < motion.tip.size(); ++k)
      // The force changes by at most 100·h·v per step: a shift by half a step would leave 10·h/2.
      CHECK(motion.impulse[k] == Approx(motion.tip_velocity[k] + 1).margin(0.02 * 10 * h));
  }
}
