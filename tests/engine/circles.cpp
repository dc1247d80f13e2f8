// Places that move within the circle itself, as compliant laws meet it.
#include <fmt/format.h>

#include <numbers>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "tests/engine/contact_march.hpp"
#include "tests/marching.hpp"
#include "tests/scene/structure/beam_files.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

struct Hole {
  double radius = 1e-3;
  std::array<double, 2> offset = {0, 0};
  int sides = 16;
};

/// A mass on springs in a plane, within a hole.
SceneSpec mass_in(const Hole& hole, double mass, double stiffness, double damping = 0) {
  const auto diagonal = [](double value) {
    return fmt::format("%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 {0}\n2 2 {0}\n", value);
  };
  BeamFiles files;
  files.stiffness = stiffness > 0 ? diagonal(stiffness) : "%%MatrixMarket matrix coordinate real symmetric\n2 2 0\n";
  files.mass = diagonal(mass);
  files.dofs = "dof,node,component,x,y,z,held\n1,N1,uy,0,0,0,\n2,N1,uz,0,0,0,\n";
  SceneSpec scene = assembled_scene(assembled(files), {damping, 0});
  Place node;
  node.node = "N1";
  scene.stops.named = clearance_rows({.name = "hole", .at = node, .to = {}, .lower = {}, .upper = {}},
                                     {.radius = hole.radius, .sides = hole.sides, .offset = hole.offset});
  return scene;
}

void push(SceneSpec& scene, double along_y, double along_z) {
  for (const auto& [component, force] : {std::pair("uy", along_y), {"uz", along_z}}) {
    LoadTerm term{.force = true, .at = {}, .shape = Formula(), .history = Formula(force)};
    term.place = at_node("N1", component);
    scene.load.terms.push_back(term);
  }
}

void begin(SceneSpec& scene, std::array<double, 2> place, std::array<double, 2> speed) {
  scene.initial.dofs = {{1, place[0], speed[0]}, {2, place[1], speed[1]}};
}

std::array<double, 2> turned(double angle, double first, double second) {
  return {std::cos(angle) * first - std::sin(angle) * second, std::sin(angle) * first + std::cos(angle) * second};
}

struct InHole {
  std::vector<Impact> impacts;
  StopTotals totals;
  Eigen::VectorXd position;
  double deepest = 0, wear = 0;
};

InHole in_hole(const SceneSpec& scene, const Methods& methods, double h, double duration,
               const CompileOptions& options = {}) {
  const ContactMarch done(scene, 1, methods, h, duration, options);
  return {done.contacts.impacts(), done.contacts.totals(0, StopSide::upper), done.made.position(0),
          done.audit.contact(0).deepest_penetration, done.wear};
}

const Choice averaged{"penalty", {{"stiffness", 1e6}, {"evaluation", std::string("averaged")}}};
const Choice quarter_beta{"newmark-dumont-paoli", {{"beta", 0.25}}};
constexpr double half_turn = std::numbers::pi;

}  // namespace

TEST_CASE("a mass that is pushed into its hole rests at (F + κr)/(k + κ), whatever the sides and the direction") {
  const double k = 8000, kappa = 1e6, F = 200, r = 1e-3, rests = (F + kappa * r) / (k + kappa);
  for (const int sides : {3, 8, 128})
    for (const double angle : {0.0, 0.7, 2.4, -1.1}) {
      SceneSpec scene = mass_in({.radius = r, .sides = sides}, 2, k);
      push(scene, F * std::cos(angle), F * std::sin(angle));
      scene.initial.equilibrium = true;
      const Eigen::VectorXd q =
          problem_of(scene, 1, {"consistent"}, Choice{"penalty", {{"stiffness", kappa}}})->position;
      // A linear problem: round-off of its numbers.
      CHECK(std::abs(q[0] - rests * std::cos(angle)) <= 1e-13 * rests);
      CHECK(std::abs(q[1] - rests * std::sin(angle)) <= 1e-13 * rests);
    }
}

TEST_CASE("in a hole that is off its axis, springs of mass and hole balance the force, in any direction") {
  const double k = 8000, kappa = 1e6;
  for (const double angle : {0.3, 1.9, 4.0}) {
    SceneSpec scene = mass_in({.radius = 1e-3, .offset = {4e-4, -7e-4}}, 2, k);
    push(scene, 300 * std::cos(angle), 300 * std::sin(angle));
    scene.initial.equilibrium = true;
    for (const Choice& law : {Choice{"penalty", {{"stiffness", kappa}}}, Choice{"hertz", {{"stiffness", 1e9}}}}) {
      const Eigen::VectorXd q = problem_of(scene, 1, {"consistent"}, law)->position;
      const Eigen::Vector2d from(q[0] - 4e-4, q[1] + 7e-4);
      const double depth = from.norm() - 1e-3;
      const double N = law.name == "penalty" ? kappa * depth : 1e9 * std::pow(depth, 1.5);
      const Eigen::Vector2d left =
          k * q.head<2>() + N * from.normalized() - 300 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      CHECK(left.norm() <= 1e-8);  // the stiff spring times round-off of the place, 1e6 to 1e7 N/m times 1e-16 m
    }
  }
}

TEST_CASE("a shock in a round hole has v√(κm) and lasts π√(m/κ), in any direction") {
  const double m = 0.3, v = 0.05, kappa = 1e6;
  for (const int sides : {8, 128})
    for (const double angle : {0.0, 0.4, 2.9}) {
      SceneSpec scene = mass_in({.radius = 2e-4, .sides = sides}, m, 1e-6);
      begin(scene, {0, 0}, turned(angle, v, 0));
      const InHole made = in_hole(scene, {{"consistent"}, averaged, quarter_beta}, 2e-6, 0.008);
      REQUIRE(made.impacts.size() == 1);
      // Of second order in hω = 3.7e-3; the duration counts whole steps.
      CHECK(made.impacts[0].peak_force == Approx(v * std::sqrt(kappa * m)).epsilon(1e-5));
      CHECK(std::abs(made.impacts[0].duration - half_turn * std::sqrt(m / kappa)) <= 2 * 2e-6);
      CHECK(made.impacts[0].impulse == Approx(2 * m * v).epsilon(1e-6));
      CHECK(made.impacts[0].speed_in == Approx(v).epsilon(1e-9));
      CHECK(made.impacts[0].speed_out == Approx(v).epsilon(3e-6));  // (hω)²/8 and its shares
      CHECK(made.totals.normal_work == Approx(m * v * v).epsilon(1e-4));
    }
}

TEST_CASE("along a radius, a sphere in a hole goes (5mv²/4k)^(2/5) deep") {
  const double m = 2, v = 0.4, k = 1e9;
  for (const double angle : {0.0, 1.0, 3.5}) {
    SceneSpec scene = mass_in({.radius = 1e-3, .offset = {2e-4, 0}}, m, 0);
    begin(scene, {2e-4, 0}, turned(angle, v, 0));
    const InHole made = in_hole(
        scene, {{"consistent"}, {"hertz", {{"stiffness", k}, {"evaluation", std::string("averaged")}}}, quarter_beta},
        1e-7, 4e-3);
    REQUIRE(made.impacts.size() == 1);
    // Depths are seen once a step: the last 1e-4 of the shock.
    CHECK(made.deepest == Approx(std::pow(5 * m * v * v / (4 * k), 0.4)).epsilon(1e-4));
  }
}

TEST_CASE("a frictionless round hole keeps angular momentum about its centre, and energy, at any step") {
  const std::array<double, 2> centre = {3e-4, -1e-4};
  for (const Choice& law : {Choice{"penalty", {{"stiffness", 1e6}, {"evaluation", std::string("conserving")}}},
                            Choice{"hertz", {{"stiffness", 1e9}, {"evaluation", std::string("conserving")}}}})
    for (const double angle : {0.0, 0.9, 4.4})
      for (const double h : {1e-4, 3.3e-5}) {
        INFO(law.name << " " << angle << " " << h);
        SceneSpec scene = mass_in({.radius = 1e-3, .offset = centre}, 2, 0);
        const auto place = turned(angle, 0, 6e-4), speed = turned(angle, 0.5, 0.1);
        begin(scene, {centre[0] + place[0], centre[1] + place[1]}, speed);
        Marcher made = marcher(scene, 1, {{"consistent"}, law, {"midpoint"}}, h);
        EnergyAudit audit(made);
        made.start(&audit);
        const auto momentum = [&] {
          // m (q − c) × v, with the slots q and v of the scheme.
          const double *q = made.slot(0), *rate = made.slot(1);
          return 2 * ((q[0] - centre[0]) * rate[1] - (q[1] - centre[1]) * rate[0]);
        };
        const auto energy = [&] {
          const double *q = made.slot(0), *rate = made.slot(1);
          return rate[0] * rate[0] + rate[1] * rate[1] + made.stored(0, q);
        };
        const double first = momentum(), begun = energy();
        CHECK(first == Approx(2 * (place[0] * speed[1] - place[1] * speed[0])).epsilon(1e-12));
        for (int k = 0; k < 2000; ++k) {
          made.march(1, &audit);
          REQUIRE(std::abs(momentum() - first) <= 1e-12 * std::abs(first));
          REQUIRE(std::abs(energy() - begun) <= 1e-11 * begun);  // round-off of 2000 steps
        }
        CHECK(audit.contact(0).impacts >= 5);
      }
}

TEST_CASE("a scene that is turned moves as it did, and one whose hole and start are moved as well") {
  const auto run = [](double angle, std::array<double, 2> away, const Choice& law, const Choice& scheme) {
    SceneSpec scene = mass_in({.radius = 1e-3, .offset = away}, 2, 0);
    const auto place = turned(angle, 1e-4, 5e-4), speed = turned(angle, 0.5, 0.2);
    begin(scene, {away[0] + place[0], away[1] + place[1]}, speed);
    return in_hole(scene, {{"consistent"}, law, scheme}, 1e-5, 0.05);
  };
  const Choice damped{"hunt-crossley", {{"stiffness", 1e8}, {"damping", 0.1}}};
  for (const auto& [law, scheme] : {std::pair(averaged, quarter_beta),
                                    {damped, quarter_beta},
                                    {Choice{"penalty", {{"stiffness", 1e6}}}, Choice{"moreau-jean"}},
                                    {Choice{"penalty", {{"stiffness", 1e5}, {"evaluation", std::string("explicit")}}},
                                     Choice{"central-difference"}}}) {
    INFO(law.name << " " << scheme.name);
    const InHole still = run(0, {0, 0}, law, scheme);
    CHECK(still.impacts.size() > 2);
    for (const double angle : {0.6, 2.2, 5.1}) {
      const InHole other = run(angle, turned(angle, 2e-4, 7e-4), law, scheme);
      REQUIRE(other.impacts.size() == still.impacts.size());
      for (std::size_t k = 0; k < still.impacts.size(); ++k) {
        // Round-off of places (1e-16 of 1e-3 m) beside depths of 1e-4 m, grown by each reflection.
        CHECK(other.impacts[k].impulse == Approx(still.impacts[k].impulse).epsilon(1e-8));
        CHECK(other.impacts[k].speed_in == Approx(still.impacts[k].speed_in).epsilon(1e-7));
        if (!still.impacts[k].open_end)
          CHECK(other.impacts[k].speed_out == Approx(still.impacts[k].speed_out).epsilon(1e-7));
      }
      CHECK(other.totals.normal_work == Approx(still.totals.normal_work).epsilon(1e-7));
    }
  }
}

TEST_CASE("along its first axis a hole is a stop with two bounds, for every compliant law") {
  for (const std::string& name : registry().names(Role::contact)) {
    std::map<std::string, ParameterValue> values;
    bool before = false;
    for (const ParameterSpec& spec : registry().contact(name)->manual.parameters) {
      if (!spec.fallback) values[spec.key] = spec.key == "stiffness" ? 1e6 : spec.unit == "m" ? 1e-4 : 0.1;
      if (spec.key == "depth_force") values[spec.key] = ParameterTable{{0, 0}, {1e-4, 50}, {1e-3, 1e3}};
      before = before || spec.unit == "m";
    }
    if (before) continue;  // it acts before the stop, and so from both sides of a flat one at once
    const Choice law{name, values};
    const auto made = make(registry().contact(name), law);
    if (made->absent() || !made->reads() || made->changes_problem()) continue;
    INFO(name);
    SceneSpec round = mass_in({.radius = 1e-3, .offset = {2e-4, 3e-4}}, 2, 500), flat = round;
    begin(round, {0, 3e-4}, {0.3, 0});
    NamedStop stop = round.stops.named.front();
    stop.side.reset();
    stop.lower = -8e-4;
    stop.upper = 1.2e-3;
    flat.stops.named = {stop};
    begin(flat, {0, 0}, {0.3, 0});
    // Nothing pulls it off the axis.
    for (SceneSpec* scene : {&round, &flat}) push(*scene, 0, scene == &round ? 500 * 3e-4 : 0);
    const Methods methods{{"consistent"}, law, quarter_beta};
    const InHole a = in_hole(round, methods, 1e-5, 0.05), b = in_hole(flat, methods, 1e-5, 0.05);
    CHECK(!b.impacts.empty());
    REQUIRE(a.impacts.size() == b.impacts.size());
    for (std::size_t k = 0; k < a.impacts.size(); ++k) {
      CHECK(a.impacts[k].impulse == Approx(b.impacts[k].impulse).epsilon(1e-9));
      CHECK(a.impacts[k].peak_force == Approx(b.impacts[k].peak_force).epsilon(1e-9));
    }
    CHECK(a.position[0] == Approx(b.position[0]).epsilon(1e-9));
  }
}

TEST_CASE("a whirl is pressed against its hole by F + (mω² − k)R, and slides at ωR") {
  const double m = 2, k = 800, omega = 30, F = 5, kappa = 1e6;
  // On the circle of radius R with κ(R − r) = F + (mω² − k)R.
  const double r = 1e-3, R = (F + kappa * r) / (kappa + k - m * omega * omega), N = kappa * (R - r);
  SceneSpec scene = mass_in({.radius = r}, m, k);
  for (const auto& [component, history] : {std::pair("uy", "5*cos(30*t)"), {"uz", "5*sin(30*t)"}}) {
    LoadTerm term{.force = true, .at = {}, .shape = Formula(), .history = Formula(history, "", "t")};
    term.place = at_node("N1", component);
    scene.load.terms.push_back(term);
  }
  begin(scene, {R, 0}, {0, omega * R});
  const double duration = 2 * half_turn / omega;
  const InHole made = in_hole(scene, {{"consistent"}, averaged, quarter_beta}, duration / 20000, duration);
  // (hω)² = 1e-7, and what half a step at each end is of the turn.
  CHECK(made.totals.impulse / duration == Approx(N).epsilon(1e-4));
  CHECK(made.wear / duration == Approx(N * omega * R).epsilon(1e-4));
  CHECK(made.totals.impacts == 0);
  // The normal turns by ωh in a step.
  CHECK(made.totals.normal_work <= 1.1 * 2 * half_turn / 20000 * made.wear);
}

TEST_CASE("lanes of a block have the bits that they have alone") {
  SceneSpec scene = mass_in({.radius = 1e-3}, 2, 500);
  begin(scene, {1e-4, 2e-4}, {0.4, 0.1});
  for (const Choice& law : {averaged, Choice{"hunt-crossley", {{"stiffness", 1e8}, {"damping", 0.1}}}}) {
    const Methods methods{{"consistent"}, law, quarter_beta};
    const auto lanes = [](const LaneSpec& lane) {
      std::vector<LaneSpec> all(5, lane);
      for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].velocity[1] += 0.07 * static_cast<double>(i);
        all[i].upper.array() += 1e-5 * static_cast<double>(i);
        all[i].lower.array() -= 1e-5 * static_cast<double>(i);
      }
      return all;
    };
    Marcher block = marcher(scene, 1, methods, 1e-5, {}, lanes);
    run(block, 0.03);
    for (int lane = 0; lane < 5; ++lane) {
      Marcher alone = marcher(scene, 1, methods, 1e-5, {}, [&](const LaneSpec& one) {
        return std::vector<LaneSpec>{lanes(one)[static_cast<std::size_t>(lane)]};
      });
      run(alone, 0.03);
      CHECK(alone.position(0) == block.position(lane));
    }
  }
}

TEST_CASE("steps are left out within the square of a hole, and marched beyond it") {
  SceneSpec scene = mass_in({.radius = 1e-3}, 2, 500);
  begin(scene, {1e-4, 2e-4}, {0.4, 0.1});
  const Methods methods{{"consistent"}, {"penalty", {{"stiffness", 1e6}}}, {"newmark-dumont-paoli"}};
  CompileOptions flown;
  flown.march = MarchWay::flights;
  const auto program = compiled(problem_of(scene, 1, methods.mass, methods.contact), methods, 1e-6, flown);
  if (std::holds_alternative<Refusal>(program)) WARN(std::get<Refusal>(program).sentence.text);
  const InHole every = in_hole(scene, methods, 1e-6, 0.05), left = in_hole(scene, methods, 1e-6, 0.05, flown);
  CHECK(every.impacts.size() > 5);
  REQUIRE(left.impacts.size() == every.impacts.size());
  for (std::size_t k = 0; k < every.impacts.size(); ++k)
    CHECK(left.impacts[k].impulse == Approx(every.impacts[k].impulse).epsilon(1e-6));
}

TEST_CASE("a mass begins beyond its hole, pressed by what the law says there") {
  SceneSpec scene = mass_in({.radius = 1e-3, .offset = {1e-4, 0}}, 2, 0);
  const auto away = turned(0.8, 1.2e-3, 0);
  begin(scene, {1e-4 + away[0], away[1]}, {0, 0});
  Marcher made = marcher(scene, 1, {{"consistent"}, averaged, quarter_beta}, 1e-6);
  EnergyAudit audit(made);
  CHECK(audit.totals(0).first.contact == Approx(0.5 * 1e6 * 4e-8).epsilon(1e-9));
  made.start(&audit);
  made.march(4000, &audit);
  // All that the spring held is in the mass: it crosses the hole along its diameter.
  CHECK(audit.totals(0).last.kinetic + audit.totals(0).last.contact == Approx(0.02).epsilon(1e-4));
  const Eigen::VectorXd q = made.position(0);
  CHECK(std::abs(std::cos(0.8) * q[1] - std::sin(0.8) * (q[0] - 1e-4)) <= 1e-12);
  CHECK(audit.contact(0).impacts == 0);
  CHECK_THROWS_WITH(discretised(scene, 1, *mass("consistent"), make(registry().contact("signorini"), {}).get()),
                    Catch::Contains("beyond"));
}

TEST_CASE("tangents of a place that slides along its circle are the difference of motions beside it") {
  for (const Choice& law : {averaged, Choice{"penalty", {{"stiffness", 1e6}}},
                            Choice{"penalty", {{"stiffness", 1e6}, {"evaluation", std::string("explicit")}}},
                            Choice{"hertz", {{"stiffness", 1e8}}}}) {
    INFO(law.name);
    SceneSpec scene = mass_in({.radius = 1e-3, .offset = {2e-4, -1e-4}}, 2, 800);
    // Pressed outwards by 180 N, and never open.
    begin(scene, {1.4e-3, -1e-4}, {0, 0.3});
    CompileOptions options;
    options.tangents = 1;
    Marcher block = marcher(scene, 1, {{"consistent"}, law, quarter_beta}, 1e-5, options,
                            [](const LaneSpec& lane) { return std::vector<LaneSpec>(3, lane); });
    block.start();
    block.march(50);
    const LaneState base = block.lane_state(0);
    LaneState direction = base;
    std::fill(direction.efforts.begin(), direction.efforts.end(), 0.0);
    for (std::size_t i = 0; i < direction.slots.size(); ++i) direction.slots[i] = i < 2 ? 1.0 - 0.6 * double(i) : 0.0;
    const double offset = 1e-8;
    block.set_tangent(0, 0, direction);
    for (const int side : {1, -1}) {
      LaneState beside = base;
      for (std::size_t i = 0; i < beside.slots.size(); ++i) beside.slots[i] += side * offset * direction.slots[i];
      block.set_lane(side > 0 ? 1 : 2, block.program().lanes[0], beside);
    }
    for (int k = 0; k < 300; ++k) {
      block.march(1);
      REQUIRE(block.pushed_by(0)[0] + block.pushed_by(0)[1] > 0);
    }
    const LaneState tangent = block.tangent(0, 0), plus = block.lane_state(1), minus = block.lane_state(2);
    double size = 0, wrong = 0;
    for (std::size_t i = 0; i < tangent.slots.size(); ++i) {
      const double difference = (plus.slots[i] - minus.slots[i]) / (2 * offset);
      size = std::max(size, std::abs(difference));
      wrong = std::max(wrong, std::abs(tangent.slots[i] - difference));
    }
    // Round-off 1e-16 · 1e-3 m over the offset, and its square over the depth.
    CHECK(wrong <= 1e-6 * size);
  }
}
