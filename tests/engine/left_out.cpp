// What a scene does not need is left out, and the motion is that with it: motions at rest, bounds that nothing reaches,
// supports that rest, held dofs.
#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace left_out_tests {
namespace {

constexpr int elements = 6;
const Methods rigid{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}},
    spring{{"consistent"}, {"penalty", {{"stiffness", 1e4}}}, {"newmark"}},
    gated{{"consistent"}, {"signorini"}, {"moreau-jean"}};

std::vector<double> tips(const SceneSpec& scene, const Methods& methods) {
  return tip_history(scene, 1, methods, 1e-3, 1);
}

/// A beam's files, pushed onto its stop.
SceneSpec pushed(const std::string& held = "fixed", double mass_of_held = 0) {
  BeamFiles files =
      beam_files(beam_of(*std::make_unique<SceneSpec>(unit_beam())), elements, {1, mass_of_held > 0 ? "" : held, {}});
  if (mass_of_held > 0) {
    FiniteElementSpace space = free_space(beam_of(*std::make_unique<SceneSpec>(unit_beam())), elements);
    space.point_masses = {{0, mass_of_held}, {1, mass_of_held, true}};
    files.mass = matrix_market(consistent_mass(space));
  }
  SceneSpec scene = assembled_scene(assembled(files), {1e-3, 0});
  scene.stops.named = {{"end", at_node("N6"), {}, {}, 0.02}};
  scene.load.terms = {{true, {}, {}, Formula("0.4*sin(5*t)", "", "t"), at_node("N6")}};
  return scene;
}

}  // namespace

TEST_CASE("motions that rest are no motions, and a support that rests is a dof that is fixed") {
  for (const Methods& methods : {rigid, spring, gated}) {
    const std::vector<double> lean = tips(pushed(), methods);
    CHECK(*std::max_element(lean.begin(), lean.end()) > 0.019);
    SceneSpec still = pushed("clamp");
    CHECK(largest_gap(lean, tips(still, methods)) == 0);
    still.motions = {{.supports = {"clamp"}, .history = std::make_shared<const HarmonicMotion>(0, 3, 0)}};
    CHECK(largest_gap(lean, tips(still, methods)) == 0);
  }
}

TEST_CASE("bounds and stops that nothing reaches change nothing") {
  for (const Methods& methods : {rigid, spring, gated}) {
    SceneSpec lean = pushed(), two_sided = lean, more = lean;
    two_sided.stops.named.front().lower = -1e3;
    more.stops.named.push_back({"far", at_node("N3"), {}, -1e3, 1e3});
    CHECK(largest_gap(tips(lean, methods), tips(two_sided, methods)) == 0);
    // One more point has no closed form: round-off of 0.02 m.
    CHECK(largest_gap(tips(lean, methods), tips(more, methods)) < 1e-13);
  }
}

TEST_CASE("held dofs are eliminated: a mass beyond measure in their place holds as well") {
  // The clamp's reaction of 10 N and 10 N m moves 1e14 kg by 5e-14 m in 1 s.
  CHECK(largest_gap(tips(pushed(), spring), tips(pushed("", 1e14), spring)) < 1e-10);
}

}  // namespace left_out_tests
