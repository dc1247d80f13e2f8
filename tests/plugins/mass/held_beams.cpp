// Every mass matrix on beams whose supports stand anywhere.
#include <ricochet/contract/check_inertia.hpp>

#include "tests/marching.hpp"
#include "tests/refusals.hpp"
#include "tests/scene/beam_numbers.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

struct Strategy {
  Choice mass;
  double error;  ///< of the first frequency on 8 elements per span
};

// kℓ = 0.49: order 4 leaves (kℓ)⁴/1440 = 4e-5 of ω, up to twenty times that; order 2 leaves (kℓ)²/24 or so, 1e-2.
const std::vector<Strategy>& strategies() {
  static const std::vector<Strategy> all = {
      {{"consistent"}, 5e-5},
      {{"singular", {{"velocity", std::string("P1")}}}, 2e-4},
      {{"singular", {{"velocity", std::string("P0")}}}, 2e-2},
      {{"hybrid-singular"}, 1e-3},
      {{"lumped", {{"rotation", std::string("scaled")}}}, 2e-2},
      {{"lumped", {{"rotation", std::string("none")}}}, 2e-2},
      {{"hrz"}, 2e-2},
      {{"mixed"}, 2e-2},
      {{"mass-scaling"}, 5e-2},
      {{"reciprocal"}, 2e-2},
      {{"redistributed", {{"form", std::string("projected")}}}, 2e-2},
  };
  return all;
}

SceneSpec spans_with_stop(std::vector<BeamSupport> supports) {
  SceneSpec scene = held_beam(2, std::move(supports));
  scene.stops = {Formula(-1.0), Formula(1.0), StopsSpec::Place::positions, {0.5}};
  return scene;
}

}  // namespace

TEST_CASE(
    "every mass stands on supports between the ends: definite, of its rank, its first frequency that of the beam") {
  // Two spans pinned at 0, 1, 2: ω = π². Clamped at 0 and 2, pinned at 1: a half is clamped–pinned, λ = 3.926602.
  const std::vector<std::pair<std::vector<BeamSupport>, double>> beams = {
      {{pinned("a", 0), pinned("b", 1), pinned("c", 2)}, std::numbers::pi},
      {{clamped("a", 0), pinned("b", 1), clamped("c", 2)}, 3.926602312},
  };
  for (const auto& [supports, root] : beams)
    for (const auto& [choice, error] : strategies()) {
      INFO(choice.name);
      const auto problem = problem_of(spans_with_stop(supports), 16, choice);
      const auto wrong = check_inertia(problem->inertia, problem->space);
      CHECK(wrong.value_or("") == "");
      CHECK(std::sqrt(pulsations(*problem)[0]) == Approx(root).epsilon(error / 2));
    }
}

TEST_CASE("a singular mass has a velocity where the displacement is free: its kernel has one dimension per element") {
  for (const auto& supports : {pinned_at_each(2), std::vector{clamped("a", 0), pinned("b", 1), pinned("c", 2)},
                               std::vector{elastic("a", 0, 10), pinned("b", 1)}}) {
    const auto problem = problem_of(spans_with_stop(supports), 16, {"singular"});
    int free_nodes = 0;
    for (const auto& element : problem->space.elements) free_nodes += element.dof[0] >= 0 ? 1 : 0;
    free_nodes += problem->space.elements.back().dof[2] >= 0 ? 1 : 0;
    CHECK(problem->inertia.coupling.rows() == free_nodes);
    CHECK(problem->inertia.kernel_dimension == problem->dofs() - free_nodes);
  }
}

TEST_CASE("an element between two supports has no velocity P1: refused with a remedy") {
  const auto refused = discretise(held_beam(2, pinned_at_each(2)), 2, *make(registry().mass("singular"), {"singular"}));
  REQUIRE(std::holds_alternative<Refusal>(refused));
  CHECK_THAT(std::get<Refusal>(refused).sentence.text, names_cause_and_remedy());
}

TEST_CASE("rotary inertia leaves no motion without mass: the singular masses refuse it, others take it") {
  SceneSpec scene = spans_with_stop(pinned_at_each(2));
  BeamSpec& beam = beam_of(scene);
  beam.section = {.type = Section::Type::rectangle, .width = 0.1, .height = 0.1};
  beam.young = 2e11;
  beam.density = 8000;
  beam.shear = BeamShear{0.3, std::nullopt, true};
  const double first = pulsations(*problem_of(scene, 32, {"consistent"}))[0];
  for (const auto& [choice, error] : strategies()) {
    INFO(choice.name);
    const auto built = discretise(scene, 32, *make(registry().mass(choice.name), choice));
    const bool massless =
        choice.name.find("singular") != std::string::npos ||
        (choice.name == "lumped" && choice.values.at("rotation") == ParameterValue(std::string("none")));
    REQUIRE(std::holds_alternative<Refusal>(built) == massless);
    if (massless)
      CHECK_THAT(std::get<Refusal>(built).sentence.text, names_cause_and_remedy());
    else
      CHECK(pulsations(std::get<SemiDiscrete>(built))[0] == Approx(first).epsilon(error));
  }
}
