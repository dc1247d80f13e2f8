// What a scene does not need is left out: motions at rest, bounds that nothing reaches, supports that rest, held dofs.
// The motion is the same as with it.
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

// Stops with parameters of their own, in the place of those of the law and of the scheme.

namespace {

Place own_place(double x) {
  Place place;
  place.x = x;
  return place;
}

/// Two stops on a beam that is thrown at both.
SceneSpec thrown_beam(StopParameters middle = {}, StopParameters end = {}) {
  SceneSpec scene = working_set();
  scene.stops = {};
  scene.stops.named = {{"middle", own_place(0.7505), {}, -0.02, 0.05, "", {}, {}, middle},
                       {"end", own_place(1.501), {}, -0.05, 0.1, "", {}, {}, end}};
  return scene;
}

/// Two masses that do not know of each other; each is thrown at a stop of its own.
SceneSpec thrown_pair(StopParameters first, StopParameters second) {
  const std::string head = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n";
  SceneSpec scene = assembled_scene(assembled({head + "1 1 100\n2 2 100\n", head + "1 1 1\n2 2 1\n",
                                               "dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n2,B,ux,0,0,0,\n"}),
                                    {});
  scene.initial.dofs = {{1, 0, 1}, {2, 0, 1}};
  scene.stops.named = {{"a", at_node("A", "ux"), {}, {}, 0.01, "", {}, {}, first},
                       {"b", at_node("B", "ux"), {}, {}, 0.01, "", {}, {}, second}};
  return scene;
}

std::string own_refused(const SceneSpec& scene, const Methods& methods) {
  const auto program = compiled(problem_of(scene, 4, methods.mass, methods.contact), methods, 1e-5);
  return std::holds_alternative<Refusal>(program) ? std::get<Refusal>(program).sentence.text : "";
}

std::string own_left_out(const SceneSpec& scene, const Methods& methods, const std::string& item) {
  const auto program = compiled(problem_of(scene, 4, methods.mass, methods.contact), methods, 1e-5);
  REQUIRE(std::holds_alternative<Program>(program));
  for (const LeftOut& one : std::get<Program>(program).left_out)
    if (one.item == item) return one.reason;
  return "";
}

Methods under_law(const Choice& contact, const Choice& time = {"newmark-dumont-paoli", {{"beta", 0.5}}}) {
  return {{"consistent"}, contact, time};
}

Choice own_spring(double stiffness, const char* evaluation = "implicit") {
  return {"penalty", {{"stiffness", stiffness}, {"evaluation", std::string(evaluation)}}};
}

}  // namespace

TEST_CASE("an own parameter equal to the law's changes no bit") {
  const Choice damped{"kelvin-voigt", {{"stiffness", 2e5}, {"viscosity", 10.0}}};
  const Choice laid{"layer", {{"stiffness", 2e5}, {"thickness", 1e-3}}};
  for (const Choice& law : {own_spring(2e5), own_spring(2e5, "averaged"), own_spring(2e5, "midpoint"), damped, laid}) {
    INFO(law.name);
    StopParameters own{.stiffness = 2e5};
    if (law.name == "kelvin-voigt") own.damping = 10.0;
    const auto plain = contact_history(thrown_beam(), 8, under_law(law), 1e-5, 0.1),
               same = contact_history(thrown_beam({}, own), 8, under_law(law), 1e-5, 0.1);
    CHECK(plain == same);
    CHECK(std::any_of(plain.begin(), plain.end(), [](const auto& u) { return u[1] < -0.04; }));
  }
  const Choice rebounding{"moreau-jean", {{"restitution", 0.7}}};
  CHECK(contact_history(thrown_beam(), 8, under_law({"signorini"}, rebounding), 1e-5, 0.1) ==
        contact_history(thrown_beam({.restitution = 0.7}, {}), 8, under_law({"signorini"}, rebounding), 1e-5, 0.1));
}

TEST_CASE("each of two masses meets its own stop as it would alone") {
  const auto column = [](const std::vector<Eigen::VectorXd>& rows, int at) {
    std::vector<double> out;
    for (const Eigen::VectorXd& row : rows) out.push_back(row[at]);
    return out;
  };
  struct Law {
    Choice soft, hard;
    StopParameters own;  // of the hard one
  };
  const Choice newmark{"newmark-dumont-paoli", {{"beta", 0.5}}}, jean{"moreau-jean", {{"restitution", 0.2}}},
      lively{"moreau-jean", {{"restitution", 0.9}}};
  const std::vector<Law> laws = {{own_spring(1e4), own_spring(9e4), {.stiffness = 9e4}},
                                 {own_spring(1e4, "conserving"), own_spring(9e4, "conserving"), {.stiffness = 9e4}},
                                 {{"kelvin-voigt", {{"stiffness", 1e4}, {"viscosity", 20.0}}},
                                  {"kelvin-voigt", {{"stiffness", 9e4}, {"viscosity", 50.0}}},
                                  {.stiffness = 9e4, .damping = 50.0}}};
  for (const Law& law : laws) {
    INFO(law.soft.name);
    const auto mixed = contact_history(thrown_pair({}, law.own), 1, under_law(law.soft), 1e-5, 0.3);
    // Uncoupled rows of the active set and of Newton: round-off of the search alone.
    CHECK(largest_gap(column(mixed, 0),
                      column(contact_history(thrown_pair({}, {}), 1, under_law(law.soft), 1e-5, 0.3), 0)) < 1e-13);
    CHECK(largest_gap(column(mixed, 1),
                      column(contact_history(thrown_pair({}, {}), 1, under_law(law.hard), 1e-5, 0.3), 1)) < 1e-13);
    CHECK(largest_gap(column(mixed, 0), column(mixed, 1)) > 1e-3);
  }
  const auto mixed =
      contact_history(thrown_pair({}, {.restitution = 0.9}), 1, under_law({"signorini"}, jean), 1e-5, 0.3);
  CHECK(column(mixed, 0) ==
        column(contact_history(thrown_pair({}, {}), 1, under_law({"signorini"}, jean), 1e-5, 0.3), 0));
  CHECK(column(mixed, 1) ==
        column(contact_history(thrown_pair({}, {}), 1, under_law({"signorini"}, lively), 1e-5, 0.3), 1));
}

TEST_CASE("lanes beside each other have the sets of their points, bit for bit as alone") {
  constexpr int count = 5;
  const auto softened = [](const LaneSpec& base) {
    std::vector<LaneSpec> lanes;
    for (int k = 0; k < count; ++k) {
      lanes.push_back(base);
      lanes.back().law.set("stiffness", 5e4 * (k + 1));
      lanes.back().velocity *= 1 + 0.02 * k;
    }
    return lanes;
  };
  const SceneSpec scene = thrown_beam({}, {.stiffness = 3e5, .damping = 20.0});
  for (const Choice& law :
       {own_spring(1e5), own_spring(1e5, "conserving"), Choice{"layer", {{"stiffness", 1e5}, {"thickness", 1e-3}}},
        Choice{"kelvin-voigt", {{"stiffness", 1e5}, {"viscosity", 5.0}}}}) {
    INFO(law.name);
    const Methods methods = under_law(law);
    Marcher block = marcher(scene, 6, methods, 1e-5, {}, softened);
    run(block, 0.1);
    for (int k = 0; k < count; ++k) {
      Marcher single = marcher(scene, 6, methods, 1e-5, {}, [&](const LaneSpec& base) {
        return std::vector<LaneSpec>{softened(base)[static_cast<std::size_t>(k)]};
      });
      run(single, 0.1);
      REQUIRE(single.status(0).running);
      CHECK(single.position(0) == block.position(k));
    }
    CHECK(block.position(0) != block.position(1));
  }
}

TEST_CASE("the energy of stops of their own stiffness is in the balance") {
  // conserving gives the stored energy back to round-off, with the stiffness that each stop has.
  Marcher made = marcher(thrown_beam({.stiffness = 4e4}, {.stiffness = 3e5}), 8,
                         {{"consistent"}, own_spring(1e5, "conserving"), {"midpoint"}}, 1e-5);
  const EnergyAudit audit = audited(made, 0.1);
  REQUIRE(made.status(0).running);
  CHECK(audit.contact(0).impacts > 2);
  const double first = audit.totals(0).first.common();
  CHECK(std::abs(audit.energy(0).common() - first) <= 1e-8 * first);
}

TEST_CASE("parameters of stops that a method does not have are said, or refused") {
  const StopParameters stiff{.stiffness = 1e5};
  CHECK(own_left_out(thrown_beam({}, stiff), under_law({"signorini"}), "stiffness of stops") ==
        "the contact law is rigid");
  CHECK(own_left_out(thrown_beam({}, {.damping = 1.0}), under_law(own_spring(1e5)), "damping of stops") ==
        "the contact law has none");
  CHECK(own_left_out(thrown_beam({}, {.restitution = 0.5}), under_law(own_spring(1e5)), "restitution of stops") ==
        "a compliant law rebounds by its own force");
  CHECK(own_left_out(thrown_beam(), under_law(own_spring(1e5)), "stiffness of stops").empty());
  CHECK(own_refused(thrown_beam({}, stiff), under_law({"nitsche"})) ==
        "the contact law has one set of parameters for all stops: leave stiffness of stop end out");
  CHECK(own_refused(thrown_beam({}, stiff), under_law({"hertz", {{"stiffness", 1e7}}})) ==
        "the contact law has no stiffness in N/m: leave stiffness of stop end out");
  CHECK(own_refused(thrown_beam({.restitution = 0.5}, {}), under_law({"signorini"})) ==
        "the time scheme has one restitution in its step: leave restitution of stop middle out, or use a "
        "scheme that closes contact by velocities");
  CHECK(own_left_out(thrown_beam({}, {.restitution = 0.5}), under_law({"signorini"}, {"midpoint"}),
                     "restitution of stops") == "the time scheme has none");
}
