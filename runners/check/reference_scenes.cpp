#include "runners/check/reference_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <ricochet/contract/reference.hpp>
#include <ricochet/scene/observed_rows.hpp>
#include <ricochet/scene/semi_discrete.hpp>

#include "runners/check/bench.hpp"

namespace ricochet::checking {

HarmonicMotion::HarmonicMotion(double m, double c, double k, double constant, std::vector<Term> terms, double w,
                               double v, double start)
    : decay_(c / (2 * m)),
      ringing_(std::sqrt(k / m - decay_ * decay_)),
      rest_(constant / k),
      start_(start),
      response_(std::move(terms)) {
  // (k − mω²)A + cωB = a,  (k − mω²)B − cωA = b for A cos + B sin.
  for (Term& term : response_) {
    const double stiff = k - m * term.pulsation * term.pulsation, damp = c * term.pulsation;
    const double size = stiff * stiff + damp * damp;
    const double cosine = (stiff * term.cosine - damp * term.sine) / size;
    const double sine = (stiff * term.sine + damp * term.cosine) / size;
    term.cosine = cosine;
    term.sine = sine;
  }
  const double w_forced = displacement(start), v_forced = velocity(start);
  along_ = w - w_forced;
  across_ = (v - v_forced + decay_ * along_) / ringing_;
}

double HarmonicMotion::displacement(double t) const {
  const double s = t - start_, angle = ringing_ * s;
  double w = rest_ + std::exp(-decay_ * s) * (along_ * std::cos(angle) + across_ * std::sin(angle));
  for (const Term& term : response_)
    w += term.cosine * std::cos(term.pulsation * t) + term.sine * std::sin(term.pulsation * t);
  return w;
}

double HarmonicMotion::velocity(double t) const {
  const double s = t - start_, angle = ringing_ * s;
  double v = std::exp(-decay_ * s) * ((across_ * ringing_ - decay_ * along_) * std::cos(angle) -
                                      (along_ * ringing_ + decay_ * across_) * std::sin(angle));
  for (const Term& term : response_)
    v += term.pulsation * (term.sine * std::cos(term.pulsation * t) - term.cosine * std::sin(term.pulsation * t));
  return v;
}

MeasuredOrder measured_order(const std::vector<double>& steps, const std::vector<double>& errors, double scale) {
  MeasuredOrder result;
  result.finest = errors.back();
  result.exact = *std::max_element(errors.begin(), errors.end()) <= 1e-11 * scale;
  if (result.exact) return result;
  const std::size_t used = std::min<std::size_t>(3, errors.size()), first = errors.size() - used;
  double x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = first; i < errors.size(); ++i) {
    const double a = std::log(steps[i]), b = std::log(std::max(errors[i], 1e-13 * scale));
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const auto n = static_cast<double>(used);
  result.order = (n * xy - x * y) / (n * xx - x * x);
  return result;
}

namespace {

constexpr double no_stop = std::numeric_limits<double>::infinity();

SampleGrid grid_of(double duration, int samples, const std::vector<double>& places) {
  SampleGrid grid;
  for (int k = 0; k <= samples; ++k) grid.times.push_back(duration * k / samples);
  grid.places = places;
  grid.weights.assign(places.size(), places.empty() ? 0 : 1.0 / static_cast<double>(places.size()));
  return grid;
}

ReferenceScene described(std::string name, SceneSpec scene, int elements, double duration,
                         const std::vector<double>& places) {
  ReferenceScene described;
  described.name = std::move(name);
  described.grid = grid_of(duration, 40, places);
  const ProblemPointer problem = discretised(scene, elements);
  described.discrete = std::make_shared<DiscreteProblem>(discrete_problem(*problem, described.grid.places));
  ReferenceProblem& asked = described.problem;
  asked.discrete = described.discrete.get();
  asked.structure = problem->space.structure;
  asked.left_fixed = problem->space.left_fixed;
  asked.right_fixed = problem->space.right_fixed;
  asked.displacement = [formula = scene.initial.displacement](double x) { return formula(x); };
  asked.velocity = [formula = scene.initial.velocity](double x) { return formula(x); };
  asked.load_zero = true;
  asked.load = [](double, double) { return 0.0; };
  asked.stop_places = problem->contact_x;
  asked.stops_at_tip = !problem->contact_x.empty();
  const double lower = scene.stops.lower ? (*scene.stops.lower)(0) : -no_stop;
  asked.lower = [lower](double) { return lower; };
  asked.upper = [](double) { return no_stop; };
  asked.contact_absent = problem->contact_x.empty();
  return described;
}

ReferenceScene free_oscillator() {
  const SceneSpec scene =
      oscillator_scene({.mass = 2, .stiffness = 8, .damping = 0.4, .position = 0.3, .velocity = -1});
  ReferenceScene made = described("a free oscillator", scene, 1, 4, {});
  made.problem.stiffness = 8;
  made.problem.inertia = 2;
  made.problem.damping_mass = 0.2;
  const HarmonicMotion exact(2, 0.4, 8, 0, {}, 0.3, -1);
  made.exact = [exact](double t) { return exact.displacement(t); };
  return made;
}

ReferenceScene forced_oscillator() {
  SceneSpec scene = oscillator_scene({.mass = 2, .stiffness = 8, .damping = 0.4, .position = 0.3, .velocity = -1});
  std::get<OscillatorSpec>(scene.structure).force = {3, 1.3, 0.4};
  ReferenceScene made = described("a forced oscillator", scene, 1, 4, {});
  made.problem.stiffness = 8;
  made.problem.inertia = 2;
  made.problem.damping_mass = 0.2;
  made.problem.force_amplitude = 3;
  made.problem.force_pulsation = 1.3;
  made.problem.force_phase = 0.4;
  const HarmonicMotion exact(2, 0.4, 8, 0, {{3 * std::cos(0.4), -3 * std::sin(0.4), 1.3}}, 0.3, -1);
  made.exact = [exact](double t) { return exact.displacement(t); };
  return made;
}

// Let go at 0.5 m, it falls on a stop at 0 after a quarter of its period and rebounds with e times its speed.
ReferenceScene bouncing_oscillator() {
  constexpr double e = 0.8, height = 0.5, omega = 2, quarter = 0.5 * 1.5707963267948966;
  ReferenceScene made =
      described("a bouncing oscillator",
                oscillator_scene({.mass = 2, .stiffness = 8, .position = height, .stop = true}), 1, 2, {});
  made.problem.stiffness = 8;
  made.problem.inertia = 2;
  made.problem.restitution = e;
  made.exact = [](double t) {
    return t < quarter ? height * std::cos(omega * t) : e * height * std::sin(omega * (t - quarter));
  };
  return made;
}

ReferenceScene bar_on_its_stop() {
  StructureBench bench;
  bench.stops = true;
  SceneSpec scene = structure_scene(bench);
  scene.initial.velocity = Formula(0.0);
  scene.stops.lower = Formula(0.0);
  scene.stops.upper.reset();
  ReferenceScene made = described("a bar on its stop", scene, 6, 2.5, {0.25, 0.5, 0.75});
  made.problem.length = made.problem.stiffness = made.problem.inertia = 1;
  made.tip = 0;
  return made;
}

ReferenceScene cantilever() {
  SceneSpec scene = structure_scene({.beam = true, .stops = true});
  scene.initial.velocity = Formula(0.0);
  scene.stops.upper.reset();
  ReferenceScene made = described("a cantilever against a stop", scene, 4, 0.6, {0.25, 0.5, 0.75});
  made.problem.length = made.problem.stiffness = made.problem.inertia = 1;
  made.tip = 1;
  return made;
}

}  // namespace

std::vector<ReferenceScene> reference_scenes() {
  return {free_oscillator(), forced_oscillator(), bouncing_oscillator(), bar_on_its_stop(), cantilever()};
}

}  // namespace ricochet::checking
