#pragma once

// The semi-discrete motion, exact in time: against closed forms, conservation laws and the schemes that march it.
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/checks.hpp>

#include "tests/eigen.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace event_driven_semi_discrete_tests {

inline std::function<double(double)> constant(double value) {
  return [value](double) { return value; };
}

inline std::vector<double> times(double end, int count) {
  std::vector<double> result;
  for (int i = 0; i <= count; ++i) result.push_back(end * i / count);
  return result;
}

inline ReferenceOrRefusal solved_by(const std::string& name, const ReferenceProblem& problem, const SampleGrid& grid) {
  const auto* entry = registry().reference(name);
  REQUIRE(entry);
  return entry->make(complete(entry->manual.parameters, {}))->solve(problem, grid);
}

inline ReferenceMotion found(const ReferenceProblem& problem, const SampleGrid& grid,
                             const std::string& name = "event-driven-semi-discrete") {
  auto result = solved_by(name, problem, grid);
  INFO((std::holds_alternative<Refusal>(result) ? std::get<Refusal>(result).sentence.text : ""));
  REQUIRE(std::holds_alternative<ReferenceMotion>(result));
  return std::get<ReferenceMotion>(std::move(result));
}

inline std::string refusal(const ReferenceProblem& problem) {
  const auto result = solved_by("event-driven-semi-discrete", problem, {{0, 0.01}, {}, {}});
  const auto* refused = std::get_if<Refusal>(&result);
  return refused ? refused->sentence.text : std::string();
}

/// A scene on a mesh, as a reference sees it.
struct Case {
  Case(const SceneSpec& scene, int elements, const Choice& mass, const std::vector<double>& places = {})
      : semi(problem_of(scene, elements, mass)) {
    problem.structure = std::holds_alternative<BarSpec>(scene.structure) ? "bar" : "beam";
    problem.damping_stiffness = semi->damping.stiffness;
    problem.damping_mass = semi->damping.mass;
    problem.support_amplitude = scene.support.amplitude;
    problem.support_pulsation = scene.support.pulsation;
    problem.support_phase = scene.support.phase;
    problem.load_zero = scene.load.is_zero();
    problem.load_constant = !scene.load.uses_t();
    problem.stop_places = semi->contact_x;
    discrete.mass = dense_mass(semi->inertia);
    discrete.stiffness = semi->stiffness;
    discrete.contact = semi->contact;
    discrete.lower = semi->lower;
    discrete.upper = semi->upper;
    discrete.support_shape = semi->support_shape;
    discrete.position = semi->position;
    discrete.velocity = semi->velocity;
    discrete.load_constant.resize(semi->dofs());
    semi->load->assemble(0, discrete.load_constant.data());
    discrete.tip = Eigen::MatrixXd(semi->tip).row(0);
    discrete.places = displacement_rows(semi->space, places);
    discrete.strains = Eigen::MatrixXd::Zero(discrete.places.rows(), discrete.places.cols());
    for (std::size_t i = 0; i < places.size(); ++i)
      for (const auto& [dof, value] : strain_row(semi->space, places[i]))
        discrete.strains(static_cast<Eigen::Index>(i), dof) = value;
    problem.discrete = &discrete;
  }
  Case(const Case&) = delete;

  std::shared_ptr<const SemiDiscrete> semi;
  DiscreteProblem discrete;
  ReferenceProblem problem;
};

inline SceneSpec projected(SceneSpec scene) {
  scene.initial.projection = InitialSpec::Projection::constraint;
  return scene;
}

/// One dof as a mesh of its own: what a plugin of closed forms solves as well.
struct OneDof {
  explicit OneDof(double stiffness, double mass = 1) {
    problem.structure = "oscillator";
    problem.inertia = mass;
    problem.stiffness = stiffness;
    problem.displacement = problem.velocity = constant(0);
    problem.lower = constant(-INFINITY);
    problem.upper = constant(INFINITY);
    problem.stop_places = {0};
    problem.stops_at_tip = true;
  }
  /// The same numbers as matrices.
  const ReferenceProblem& whole() {
    const auto one = [](double value) { return Eigen::MatrixXd::Constant(1, 1, value); };
    const double t = problem.support_phase;
    discrete.mass = one(problem.inertia);
    discrete.stiffness = one(problem.stiffness);
    discrete.contact = one(1);
    discrete.tip = one(1);
    discrete.lower = one(problem.lower(0));
    discrete.upper = one(problem.upper(0));
    discrete.support_shape = one(problem.inertia);
    discrete.position = one(problem.displacement(0) - problem.support_amplitude * std::sin(t));
    discrete.velocity = one(problem.velocity(0) - problem.support_amplitude * problem.support_pulsation * std::cos(t));
    discrete.load_constant = one(0);
    discrete.places = discrete.strains = Eigen::MatrixXd(0, 1);
    problem.discrete = &discrete;
    return problem;
  }
  ReferenceProblem problem;
  DiscreteProblem discrete;
};

inline void push(ReferenceProblem& problem, double load) {
  problem.load_zero = false;
  problem.load = [load](double, double) { return load; };
}

/// Both roads to the same motion.
inline void agree(OneDof& one, double duration, double tolerance) {
  const SampleGrid grid{times(duration, 400), {}, {}};
  const SampledMotion a = found(one.whole(), grid).motion, b = found(one.whole(), grid, "exact").motion;
  const auto compare = [&](const std::vector<double>& x, const std::vector<double>& y, double size) {
    REQUIRE(x.size() == y.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO("t = " << grid.times[i]);
      CHECK(x[i] == Approx(y[i]).margin(tolerance * size));
    }
  };
  compare(a.tip, b.tip, 1);
  compare(a.tip_velocity, b.tip_velocity, 10);
  compare(a.energy, b.energy, 10);
  compare(a.impulse, b.impulse, 10);
  REQUIRE(a.events.size() == b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    CHECK(a.events[i].side == b.events[i].side);
    CHECK(a.events[i].begins == b.events[i].begins);
    CHECK(a.events[i].time == Approx(b.events[i].time).margin(tolerance));
    CHECK(a.events[i].velocity == Approx(b.events[i].velocity).margin(10 * tolerance));
  }
}

}  // namespace event_driven_semi_discrete_tests
