#pragma once

// What the plan says of its step before anything runs, against closed forms, against marching, and against itself.
#include <fmt/format.h>

#include <ricochet/measure/stability/stability.hpp>
#include <ricochet/measure/stability/step_map.hpp>
#include <ricochet/measure/stability/structure_physics.hpp>

#include "tests/amplification_roots.hpp"
#include "tests/eigen.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace stability_tests {
using Catch::Matchers::Contains;
using Eigen::MatrixXd;
using Eigen::VectorXd;

using Problem = std::shared_ptr<const SemiDiscrete>;

inline StepPlan plan(const Choice& time, double h, const ProblemFacts& facts = {}) {
  auto made = plan_of(time, h, facts);
  INFO((std::holds_alternative<Refusal>(made) ? std::get<Refusal>(made).sentence.text : ""));
  REQUIRE(std::holds_alternative<StepPlan>(made));
  return std::get<StepPlan>(made);
}

inline Choice dumont_paoli(double beta, double restitution = 0) {
  return {"newmark-dumont-paoli",
          {{"beta", beta}, {"restitution", restitution}, {"start", std::string("first-order")}}};
}

inline Choice penalty(double stiffness, const std::string& evaluation) {
  return {"penalty", {{"stiffness", stiffness}, {"evaluation", evaluation}}};
}

inline LinearLaw linear(const Choice& contact, int points) {
  const auto* entry = registry().contact(contact.name);
  return linear_law(*make(entry, contact), points, complete(entry->manual.parameters, contact.values));
}

inline StabilityPredictor predictor(const Problem& problem, const Choice& contact) {
  return StabilityPredictor(problem, linear(contact, problem->points()));
}

inline StepSpectrum known(const SpectrumOrRefusal& spectrum) {
  INFO((std::holds_alternative<Refusal>(spectrum) ? std::get<Refusal>(spectrum).sentence.text : ""));
  REQUIRE(std::holds_alternative<StepSpectrum>(spectrum));
  return std::get<StepSpectrum>(spectrum);
}

inline double last_pulsation(const SemiDiscrete& problem) {
  const StructureModes modes = open_modes(problem);
  return modes.pulsation(modes.regular - 1);
}

inline LinearProblem nodal(const SemiDiscrete& problem, const std::vector<int>& closed) {
  LinearProblem out;
  out.mass = dense_mass(problem.inertia);
  out.stiffness = problem.stiffness;
  out.damping = problem.damping.stiffness * out.stiffness + problem.damping.mass * out.mass;
  out.contact.resize(static_cast<Eigen::Index>(closed.size()), problem.dofs());
  for (std::size_t i = 0; i < closed.size(); ++i)
    out.contact.row(static_cast<Eigen::Index>(i)) = Eigen::RowVectorXd(problem.contact.row(closed[i]));
  return out;
}

/// One point mass m on a spring k with a stop: the smallest semi-discrete problem.
inline Problem point_mass(double m, double k, double damping = 0) {
  SemiDiscrete problem;
  const auto number = [](double value) {
    SparseMatrix matrix(1, 1);
    if (value != 0) matrix.insert(0, 0) = value;
    return matrix;
  };
  problem.inertia.mass = number(m);
  problem.inertia.kernel_dimension = m == 0 ? 1 : 0;
  problem.stiffness = number(k);
  problem.damping.stiffness = damping;
  problem.contact.resize(1, 1);
  problem.contact.insert(0, 0) = 1;
  problem.tip = problem.contact;
  problem.contact_x = {0};
  problem.lower = VectorXd::Constant(1, -1);
  problem.upper = VectorXd::Constant(1, 1);
  problem.support_shape = problem.position = problem.velocity = VectorXd::Zero(1);
  return std::make_shared<const SemiDiscrete>(std::move(problem));
}

inline std::vector<double> decades(double from, double to, int per_decade = 4) {
  std::vector<double> steps;
  const int count = static_cast<int>(std::lround(per_decade * std::log10(to / from)));
  for (int i = 0; i <= count; ++i) steps.push_back(from * std::pow(10.0, static_cast<double>(i) / per_decade));
  return steps;
}

inline StepLimit open_limit(const StabilityPredictor& predicted, const Choice& time, const std::vector<double>& steps) {
  return step_limit([&](double h) { return predicted.open(plan(time, h), h); }, steps);
}
inline StepLimit closed_limit(const StabilityPredictor& predicted, const Choice& time,
                              const std::vector<double>& steps) {
  return step_limit([&](double h) { return predicted.worst_closed(plan(time, h), h); }, steps);
}

inline SceneSpec damped_scene(double alpha, StopsSpec::Place place = StopsSpec::Place::tip) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = alpha;
  scene.stops.place = place;
  return scene;
}

/// State of a lane as step_map() orders it, slots first; past efforts, at the start of an integration, are zero.
inline VectorXd state(const Marcher& marcher, int lane, Eigen::Index size) {
  VectorXd x = VectorXd::Zero(size);
  const int rows = marcher.program().model->rows();
  for (int j = 0; j < marcher.slot_count(); ++j)
    for (int i = 0; i < rows; ++i) x[j * rows + i] = marcher.slot(j)[i * marcher.width() + lane];
  return x;
}

// Dumont–Paoli with β < ¼ has no step on the kernel of a singular mass; all others run.
inline bool refused(const Choice& mass, const Choice& time) {
  return mass.name == "singular" && time.name == "newmark-dumont-paoli" &&
         std::get<double>(time.values.at("beta")) < 0.25;
}

inline const std::vector<Choice>& schemes() {
  static const std::vector<Choice> all = {dumont_paoli(0),
                                          dumont_paoli(0.25),
                                          dumont_paoli(0.5),
                                          {"newmark", {}},
                                          {"newmark", {{"beta", 0.3}, {"gamma", 0.6}}},
                                          {"moreau-jean", {{"theta", 0.7}}}};
  return all;
}

}  // namespace stability_tests
