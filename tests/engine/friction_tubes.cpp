// Friction at stops of tubes: motions found by an independent march, in two planes and along a turning surface.
#include <array>
#include <ricochet/measure/contact/stop_places.hpp>
#include <set>

#include "tests/engine/rubbing.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

LoadTerm pushes(double x, const std::string& history) {
  return {.force = true, .at = x, .shape = Formula(), .history = Formula(history, "", "t")};
}

SceneSpec rubbing_tube() {
  BeamSpec beam;
  beam.length = 1.2;
  beam.young = beam.density = 1;
  beam.section.type = Section::Type::given;
  beam.section.EI = 90;
  beam.section.rhoS = 0.8;
  beam.damping = {.stiffness = 2e-4, .mass = 0.6};
  SceneSpec scene;
  scene.structure = beam;
  return scene;
}

NamedStop rubbing_stop(const char* name, const Place& at, double lower, double stiffness, double mu,
                       const TangentSpec& tangent) {
  NamedStop stop{.name = name, .at = at, .to = {}, .lower = lower, .upper = {}};
  stop.tangent = tangent;
  stop.own.stiffness = stiffness;
  stop.friction = FrictionSpec{mu, mu};
  return stop;
}

Place beam_at(double x) {
  Place place;
  place.x = x;
  return place;
}

// Twice the matrices of a tube in one plane, by nodes N0, N1, …: a tube in two planes that rubs along uz at two stops.
SceneSpec swept_tube(double share = 1) {
  const auto beam = std::get<BeamSpec>(rubbing_tube().structure);
  const FiniteElementSpace space = free_space(beam, 2);
  const int dofs = space.dofs;
  const auto doubled = [&](const SparseMatrix& one) {
    Eigen::MatrixXd two = Eigen::MatrixXd::Zero(2 * dofs, 2 * dofs);
    two.topLeftCorner(dofs, dofs) = two.bottomRightCorner(dofs, dofs) = Eigen::MatrixXd(one);
    return two;
  };
  std::string table = "dof,node,component,x,y,z,held\n";
  for (int i = 0; i < 2 * dofs; ++i) {
    const int dof = i % dofs;
    const std::array<const char*, 4> words{"uy", "rz", "uz", "ry"};
    table += fmt::format("{},N{},{},{},0,0,{}\n", i + 1, dof / 2,
                         words[static_cast<std::size_t>(dof % 2 + (i < dofs ? 0 : 2))], 0.6 * (dof / 2),
                         dof < 2 ? "fixed" : "");
  }
  SceneSpec scene =
      given_scene(doubled(bending_stiffness(space, beam.section.EI)), doubled(consistent_mass(space)), table);
  std::get<AssembledSpec>(scene.structure).damping = beam.damping;
  const TangentSpec across{.slope_radius = 0, .direction = {}, .component = "uz", .speed = 0};
  scene.stops.named = {rubbing_stop("middle", at_node("N1"), -2e-4, 2e4, share * 0.25, across),
                       rubbing_stop("tip", at_node("N2"), -1e-3, 3e4, share * 0.35, across)};
  for (const auto& [history, component] : {std::pair("-6+0.8*cos(14*pi*t)", "uy"), {"2.6*cos(14*pi*t)", "uz"}})
    scene.load.terms.push_back({true, {}, {}, Formula(history, "", "t"), at_node("N2", component)});
  scene.points = {{.name = "y", .at = at_node("N2")}, {.name = "z", .at = at_node("N2", "uz")}};
  return scene;
}

// A tube in one plane whose surface turns at its stops.
SceneSpec turning_tube() {
  SceneSpec scene = rubbing_tube();
  const TangentSpec surface{.slope_radius = 0.015, .direction = {}, .component = "", .speed = 0};
  scene.stops.named = {rubbing_stop("middle", beam_at(0.8), -3e-4, 2e4, 0.3, surface),
                       rubbing_stop("tip", beam_at(1.2), -1e-3, 3e4, 0.4, surface)};
  scene.load.terms = {pushes(1.2, "-8"), pushes(0.8, "9*cos(18*pi*t)")};
  return scene;
}

const Choice spring_of_a_stop{"penalty", {{"stiffness", 2e4}, {"evaluation", std::string("averaged")}}};

// Displacements of the two points at the ends of the parts of `duration`, and what friction did until its end.
struct Swept {
  std::vector<double> y, z;
  std::array<FrictionTotals, 2> stops;
  double residual = 0, heat = 0, balance = 0;
  bool balances = false;
};

Swept swept(const SceneSpec& scene, int elements, const Methods& methods, double h, double part, int parts) {
  Marcher made = marcher(scene, elements, methods, h);
  EnergyAudit audit(made);
  FrictionWatch watch(made, audit, {0, part * parts, 1});
  const Observers observers{&audit, &watch};
  made.start(observers);
  const RowReadings points(made, made.program().problem->observed);
  Swept out;
  for (int k = 1; k <= parts; ++k) {
    made.march(std::llround(k * part / h) - made.step(), observers);
    REQUIRE(made.status(0).running);
    out.y.push_back(scene.points.empty() ? made.tip(0) : points.displacement(made, 0));
    if (scene.points.size() > 1) out.z.push_back(points.displacement(made, 1));
  }
  for (int i = 0; i < 2; ++i)
    if (watch.has(i)) out.stops[static_cast<std::size_t>(i)] = watch.totals(i);
  out.residual = watch.residual();
  out.balances = audit.balances();
  out.heat = -audit.totals(0).work_of_friction;
  out.balance = audit.totals(0).balance_residual();
  return out;
}

double largest_off(const std::vector<double>& found, std::initializer_list<double> expected) {
  return largest_gap(found, std::vector<double>(expected));
}

}  // namespace

TEST_CASE("friction: a tube that is swept along two stops moves, heats and sticks as found independently",
          "[friction]") {
  const Choice quarter{"newmark-dumont-paoli", {{"beta", 0.25}}};
  for (const Choice& time : {moreau, quarter, Choice{"bathe"}}) {
    INFO(time.name);
    Choice contact = spring_of_a_stop;
    if (time.name == "bathe") contact.values.erase("evaluation");
    std::vector<double> steps, errors;
    for (const double h : {1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5}) {
      const Swept seen = swept(swept_tube(), 1, {{"consistent"}, contact, time}, h, 0.25, 6);
      const double off_z = largest_off(seen.z,
                                       {-6.87053e-4, 1.363751e-3, 3.012899e-3, 7.87421e-4, -5.72431e-4, 1.560137e-3}),
                   off_y = largest_off(
                       seen.y, {-1.181658e-3, -1.206773e-3, -1.196658e-3, -1.167299e-3, -1.188124e-3, -1.211026e-3});
      steps.push_back(std::log(h));
      errors.push_back(std::log(std::max(off_z, off_y)));
      CHECK(seen.residual <= 1e-12);
      if (seen.balances) CHECK(std::abs(seen.balance) <= 1e-10);
      if (h > 6.3e-5) continue;
      CHECK(off_z <= 2e-6);
      CHECK(off_y <= 2e-6);
      const std::array<double, 2> wear{0.034792016, 0.410644603}, heat{0.008698004, 0.143725611},
          held{0.00331, 0.31338}, slipped{0.035288, 0.074017};
      for (std::size_t i = 0; i < 2; ++i) {
        CHECK(seen.stops[i].wear == Approx(wear[i]).epsilon(1e-3));
        if (seen.balances) CHECK(seen.stops[i].heat == Approx(heat[i]).epsilon(1e-3));
        CHECK(seen.stops[i].held == Approx(held[i]).epsilon(0).margin(2e-3));
        // The first stop is knocked at: ends of contacts count whole steps, at order 1.
        CHECK(seen.stops[i].slipped == Approx(slipped[i]).epsilon(i == 0 ? 4e-3 : 1e-3));
      }
    }
    // Bathe's begins nearer, and ends of sticking scatter.
    CHECK(fitted_slope(steps, errors) >= (time.name == "bathe" ? 1.5 : 1.7));
  }
}

TEST_CASE("friction: a tube whose surface turns at its stops moves and heats as found independently", "[friction]") {
  const Choice quarter{"newmark-dumont-paoli", {{"beta", 0.25}}};
  for (const Choice& time : {moreau, quarter}) {
    INFO(time.name);
    const Swept seen = swept(turning_tube(), 3, {{"consistent"}, spring_of_a_stop, time}, 6.25e-5, 0.25, 4);
    CHECK(largest_off(seen.y, {-0.00120189, -0.001245308, -0.001226503, -0.001090774}) <= 3e-7);
    CHECK(seen.stops[0].heat == Approx(0.002843384).epsilon(2e-3));
    CHECK(seen.stops[1].heat == Approx(0.007213685).epsilon(2e-3));
    CHECK(std::abs(seen.balance) <= 1e-10);
    Marcher made = marcher(turning_tube(), 3, {{"consistent"}, spring_of_a_stop, time}, 6.25e-5);
    double most = 0;
    for (const JamNumber& one : made.program().jam) most = std::max(most, one.number);
    CHECK(most > 1e-5);
    CHECK(most <= 0.1);
  }
}

TEST_CASE("friction: none, and none that acts, leave the bits of a tube alone", "[friction]") {
  const auto bits = [](SceneSpec scene) {
    const Swept seen = swept(scene, 1, {{"consistent"}, spring_of_a_stop, moreau}, 2.5e-4, 0.25, 2);
    std::vector<double> all = seen.y;
    all.insert(all.end(), seen.z.begin(), seen.z.end());
    return all;
  };
  SceneSpec without = swept_tube(), open = swept_tube(), open_without = swept_tube();
  for (NamedStop& stop : without.stops.named) stop.friction = {};
  CHECK(bits(swept_tube(0)) == bits(without));
  CHECK(bits(swept_tube()) != bits(without));
  for (SceneSpec* scene : {&open, &open_without})
    for (NamedStop& stop : scene->stops.named) stop.lower = -1.0;
  for (NamedStop& stop : open_without.stops.named) stop.friction = {};
  CHECK(bits(open) == bits(open_without));
}

TEST_CASE("friction: lanes with coefficients of their own have the bits of a lane alone", "[friction]") {
  constexpr double h = 2.5e-4;
  constexpr int steps = 2000, lanes = 8;
  const Methods methods{{"consistent"}, spring_of_a_stop, moreau};
  const auto share = [](int lane) { return 0.2 + 0.2 * lane; };
  Marcher block = marcher(swept_tube(), 1, methods, h, {}, [&](const LaneSpec& one) {
    std::vector<LaneSpec> all(lanes, one);
    for (int lane = 0; lane < lanes; ++lane)
      for (Rubbing& surface : all[static_cast<std::size_t>(lane)].rubbing)
        surface.held = surface.sliding = share(lane) * surface.held;
    return all;
  });
  block.start();
  block.march(steps - block.step());
  std::set<double> ends;
  for (int lane = 0; lane < lanes; ++lane) {
    Marcher alone = marcher(swept_tube(share(lane)), 1, methods, h);
    alone.start();
    alone.march(steps - alone.step());
    CHECK(alone.position(0) == block.position(lane));
    ends.insert(block.position(lane).squaredNorm());
  }
  CHECK(ends.size() == lanes);
}

TEST_CASE("friction: at many stops, with a scheme that weighs efforts of steps before, the balance closes",
          "[friction]") {
  constexpr int stops = 24;
  SceneSpec scene = rubbing_tube();
  std::get<BeamSpec>(scene.structure).planes = 2;
  for (int i = 1; i <= stops; ++i) {
    Place at = beam_at(1.2 * i / stops);
    at.component = "uy";
    NamedStop stop{.name = fmt::format("s{}", i), .at = at, .to = {}, .lower = -1e-5 * i, .upper = {}};
    stop.tangent = TangentSpec{.slope_radius = 0, .direction = {}, .component = "uz", .speed = 0};
    stop.friction = FrictionSpec{0.3, 0.3};
    scene.stops.named.push_back(stop);
  }
  LoadTerm along = pushes(1.2, "2.6*cos(14*pi*t)");
  along.towards.component = "uz";
  scene.load.terms = {pushes(1.2, "-6+0.8*cos(14*pi*t)"), along};
  const Choice quarter{"newmark-dumont-paoli", {{"beta", 0.25}}};
  for (const Choice& contact : {Choice{"signorini"}, spring_of_a_stop}) {
    INFO(contact.name);
    Marcher made = marcher(scene, stops, {{"consistent"}, contact, quarter}, 2.5e-4);
    const EnergyAudit audit = audited(made, 0.1);
    REQUIRE(made.status(0).running);
    CHECK(-audit.totals(0).work_of_friction > 1e-6);
    CHECK(std::abs(audit.totals(0).balance_residual()) <= 1e-10);
  }
}

TEST_CASE("friction: the order of the stops does not matter", "[friction]") {
  const auto motion = [](const SceneSpec& scene, int elements) {
    return swept(scene, elements, {{"consistent"}, spring_of_a_stop, moreau}, 2.5e-4, 0.25, 4);
  };
  for (const auto& [scene, elements] : {std::pair(swept_tube(), 1), {turning_tube(), 3}}) {
    SceneSpec turned = scene;
    std::swap(turned.stops.named[0], turned.stops.named[1]);
    const Swept a = motion(scene, elements), b = motion(turned, elements);
    double size = 0;
    for (const double y : a.y) size = std::max(size, std::abs(y));
    CHECK(largest_gap(a.y, b.y) <= 1e-12 * size);
    CHECK(largest_gap(a.z, b.z) <= 1e-12 * size);
    CHECK(a.stops[0].wear == Approx(b.stops[1].wear).epsilon(1e-10));
    CHECK(a.stops[1].held == Approx(b.stops[0].held).epsilon(1e-10));
  }
}
