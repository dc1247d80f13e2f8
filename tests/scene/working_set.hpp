#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <string>
#include <variant>

#include "tests/eigen.hpp"
#include "tests/places.hpp"
#include "tests/refusals.hpp"

/// \file
/// The beam most tests use, the mass plugins as a study would open them, and small dense checks.
namespace ricochet::testing {

/// Steel tube, L = 1.501 m, 10 mm × 0.5 mm, stops ±0.1 m at the tip, u0 = 0.04x², v0 = −2x, no load, fixed support.
inline SceneSpec working_set() {
  BeamSpec beam;
  beam.length = 1.501;
  beam.young = 2e11;
  beam.density = 8000;
  beam.section.type = Section::Type::tube;
  beam.section.outer_diameter = 0.01;
  beam.section.wall = 0.0005;
  SceneSpec scene;
  scene.structure = beam;
  scene.stops.lower = Formula(-0.1);
  scene.stops.upper = Formula(0.1);
  scene.stops.place = StopsSpec::Place::tip;
  scene.support.pulsation = 10;
  scene.initial.displacement = Formula("0.04*x^2", "/scene/initial/displacement", "x");
  scene.initial.velocity = Formula("-2*x", "/scene/initial/velocity", "x");
  return scene;
}

inline BeamSpec& beam_of(SceneSpec& scene) {
  return std::get<BeamSpec>(scene.structure);
}

/// EI = ρS = L = 1: eigenvalues are then (βL)⁴.
inline SceneSpec unit_beam() {
  SceneSpec scene = working_set();
  beam_of(scene).length = 1;
  beam_of(scene).section.type = Section::Type::given;
  beam_of(scene).section.EI = 1;
  beam_of(scene).section.rhoS = 1;
  scene.initial = {};
  return scene;
}

/// A bar of ρA = 1 held at its right end, let go from `shape` towards a rigid stop at 0 at its free end. With EA = 1e4
/// and 0.05 (1 − x) it arrives after 0.01 s.
inline SceneSpec released_bar(double EA, const char* shape) {
  SceneSpec scene;
  scene.structure = BarSpec{.length = 1, .EA = EA, .rhoA = 1, .fixed = BarSpec::Fixed::right, .damping = {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(shape, "/scene/initial/displacement", "x");
  return scene;
}

/// A free bar of 10 m (EA = 900 N, ρA = 1 kg/m: waves of 30 m/s) thrown at 10 m/s at a stop at 0 from 5 m: contact on
/// [0.5, 1.1667] s, force 300 N, impulse 200 N s. `later` (m) keeps the front off a tie between two steps.
inline SceneSpec thrown_bar(double later = 0) {
  SceneSpec scene;
  scene.structure = BarSpec{.length = 10, .EA = 900, .rhoA = 1, .fixed = BarSpec::Fixed::none, .damping = {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(5 + later);
  scene.initial.velocity = Formula(-10.0);
  return scene;
}

/// A mass plugin, its library opened as a study would; word parameters as given, the others at their defaults.
inline std::unique_ptr<MassStrategy> mass(const std::string& name, std::map<std::string, ParameterValue> values = {}) {
  static Catalogue catalogue(tests::places().plugins, {}, {});
  static Registry registry;
  REQUIRE(catalogue.require(Role::mass, name, registry));
  const auto* entry = registry.mass(name);
  REQUIRE(entry);
  for (const auto& spec : entry->manual.parameters)
    if (spec.fallback && !values.contains(spec.key)) values[spec.key] = *spec.fallback;
  return entry->make(Parameters(values));
}

inline Inertia built(const MassStrategy& strategy, const FiniteElementSpace& space) {
  auto result = strategy.build(space);
  INFO((std::holds_alternative<Refusal>(result) ? std::get<Refusal>(result).sentence.text : ""));
  REQUIRE(std::holds_alternative<Inertia>(result));
  return std::get<Inertia>(result);
}

inline SemiDiscrete discretised(const SceneSpec& scene, int elements, const MassStrategy& strategy,
                                ContactLaw* law = nullptr, const Parameters* parameters = nullptr) {
  auto result = discretise(scene, elements, strategy, law, parameters);
  REQUIRE(std::holds_alternative<SemiDiscrete>(result));
  return std::get<SemiDiscrete>(result);
}

/// μ of M x = μ K x, ascending: 1/ω² of the structure, zeros where M has a kernel.
inline Eigen::VectorXd compliances(const SparseMatrix& stiffness, const Inertia& inertia) {
  const Eigen::MatrixXd K = stiffness, M = dense_mass(inertia);
  return eigen::modes(M, K).values;
}

/// Slope of the least-squares line through (x_i, y_i).
inline double fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
  const Eigen::Map<const Eigen::VectorXd> a(x.data(), static_cast<Eigen::Index>(x.size()));
  const Eigen::Map<const Eigen::VectorXd> b(y.data(), static_cast<Eigen::Index>(y.size()));
  const Eigen::VectorXd centred = a.array() - a.mean();
  return centred.dot(b) / centred.squaredNorm();
}

}  // namespace ricochet::testing
