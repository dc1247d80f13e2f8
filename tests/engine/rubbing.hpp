#pragma once
#include <cmath>
#include <memory>
#include <ricochet/measure/contact/friction_watch.hpp>
#include <string>

#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

/// \file
/// Scenes that rub, and what watches them.
namespace ricochet::testing {

inline const Choice moreau{"moreau-jean", {{"theta", 0.5}}}, dumont{"newmark-dumont-paoli", {{"beta", 0.5}}},
    alpha{"generalised-alpha", {{"rho_inf", 0.8}}};

inline CompileOptions with_friction(const Choice& law) {
  CompileOptions options;
  options.make_friction = [law] { return make(registry().friction(law.name), law); };
  return options;
}

inline NamedStop friction_damper(double normal_force, const FrictionSpec& mu) {
  NamedStop damper{.name = "damper", .at = {}, .to = {}, .lower = {}, .upper = {}};
  damper.at.x = 0;
  damper.normal_force = normal_force;
  damper.friction = mu;
  return damper;
}

/// A block on a spring whose own motion is damped by a friction damper.
inline SceneSpec damped_block(double mass, double stiffness, double normal_force, const FrictionSpec& mu) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = mass, .stiffness = stiffness, .damping = 0, .force = {}};
  scene.stops.named = {friction_damper(normal_force, mu)};
  return scene;
}

/// A stop uy ≥ 0 of the node P that rubs along ux.
inline NamedStop rubbing_floor(double mu) {
  NamedStop floor{.name = "floor", .at = at_node("P"), .to = {}, .lower = 0.0, .upper = {}};
  floor.tangent = TangentSpec{.slope_radius = 0, .direction = {}, .component = "ux", .speed = 0};
  floor.friction = FrictionSpec{mu, mu};
  return floor;
}

/// A structure of these matrices, whose dofs stand in the text of a table; C in the format of Matrix Market.
inline SceneSpec given_scene(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, const std::string& dofs,
                             const std::string& C = "", const Damping& damping = {}) {
  BeamFiles files{matrix_market(SparseMatrix(K.sparseView())), matrix_market(SparseMatrix(M.sparseView())), dofs};
  return assembled_scene(assembled(files, 1, C), damping);
}

/// Dofs uy (n) and ux (t) of one node over such a floor; started at ux = 0 with `speed`.
inline SceneSpec pressed_block(const Eigen::Matrix2d& M, double mu, const std::string& load, double speed,
                               const std::string& pull = "0", double height = 0, double fall = 0) {
  SceneSpec scene =
      given_scene(Eigen::Matrix2d::Zero(), M, "dof,node,component,x,y,z,held\n1,P,uy,0,0,0,\n2,P,ux,0,0,0,\n");
  scene.stops.named = {rubbing_floor(mu)};
  scene.load.terms = {{true, {}, {}, Formula(load, "", "t"), at_node("P")},
                      {true, {}, {}, Formula(pull, "", "t"), at_node("P", "ux")}};
  scene.initial.dofs = {{1, height, fall}, {2, 0, speed}};
  return scene;
}

inline double along(const Marcher& made) {
  return made.position(0)[1];
}

struct Watched {
  EnergyAudit audit;
  FrictionWatch watch;
  Watched(const Marcher& made, double begin, double end) : audit(made), watch(made, audit, {begin, end, 1}) {}
};

/// Marches to the end under both observers; friction counts from `begin`.
inline std::unique_ptr<Watched> watched(Marcher& made, double end, double begin = 0) {
  auto all = std::make_unique<Watched>(made, begin, end);
  const Observers observers{&all->audit, &all->watch};
  made.start(observers);
  made.march(std::llround(end / made.program().h) - made.step(), observers);
  return all;
}

/// What friction does at the first stop from `begin` to `end`.
inline FrictionTotals rubbed_over(const SceneSpec& scene, const Methods& methods, double h, double begin, double end,
                                  const CompileOptions& options = {}) {
  Marcher made = marcher(scene, 1, methods, h, options);
  const auto all = watched(made, end, begin);
  REQUIRE(made.status(0).running);
  return all->watch.totals(0);
}

}  // namespace ricochet::testing
