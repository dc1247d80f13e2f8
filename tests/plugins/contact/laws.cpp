// How the contact laws relate to each other.
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SceneSpec scene_at_nodes() {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops.place = StopsSpec::Place::nodes;
  return scene;
}

double tip_after(const Methods& methods, double h, double duration) {
  Marcher beam = marcher(scene_at_nodes(), 8, methods, h);
  run(beam, duration);
  REQUIRE(beam.status(0).running);
  return beam.tip(0);
}

double one_augmentation(double stiffness, const Choice& time, double h) {
  return tip_after(
      {{"consistent"},
       {"augmented-lagrangian",
        {{"augmentation", stiffness}, {"iterations", 1LL}, {"tolerance", 0.0}, {"start", std::string("zero")}}},
       time},
      h, 0.3);
}

}  // namespace

TEST_CASE("one augmentation from zero is the penalty") {
  const auto time = GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"newmark"});
  const double stiffness = GENERATE(1e3, 1e6);
  const double h = 1e-4;
  const double penalty = tip_after({{"consistent"}, {"penalty", {{"stiffness", stiffness}}}, time}, h, 0.3);
  CHECK(one_augmentation(stiffness, time, h) == penalty);
}

TEST_CASE("the perturbed Lagrangian is one augmentation from zero, to the last bit, on any impact measure") {
  const auto time =
      GENERATE(Choice{"newmark-dumont-paoli", {{"restitution", 0.5}}}, Choice{"moreau-jean"}, Choice{"newmark"});
  const double stiffness = GENERATE(1e3, 1e6);
  const double h = 1e-4;
  const double perturbed =
      tip_after({{"consistent"}, {"perturbed-lagrangian", {{"stiffness", stiffness}}}, time}, h, 0.3);
  CHECK(perturbed == one_augmentation(stiffness, time, h));
}

TEST_CASE("many augmentations are Signorini") {
  const auto start = GENERATE(std::string("zero"), std::string("previous"));
  const Choice time{"newmark-dumont-paoli"};
  const double rigid = tip_after({{"consistent"}, {"signorini"}, time}, 1e-4, 0.3);
  const double hybrid =
      tip_after({{"consistent"},
                 {"augmented-lagrangian",
                  {{"augmentation", 1e6}, {"iterations", 10000LL}, {"tolerance", 1e-13}, {"start", start}}},
                 time},
                1e-4, 0.3);
  // Efforts to 1e-13, amplified over four impacts.
  CHECK(hybrid == Approx(rigid).margin(1e-8));
}

TEST_CASE("a stiff implicit penalty tends to Signorini as 1/stiffness") {
  const Choice time{"newmark-dumont-paoli"};
  const double h = 1e-4, until = 0.1;
  const double rigid = tip_after({{"consistent"}, {"signorini"}, time}, h, until);
  std::vector<double> log_k, log_gap;
  for (const double stiffness : {1e8, 1e9, 1e10}) {
    const double soft = tip_after({{"consistent"}, {"penalty", {{"stiffness", stiffness}}}, time}, h, until);
    log_k.push_back(std::log(stiffness));
    log_gap.push_back(std::log(std::abs(soft - rigid)));
  }
  // First order in the compliance once the spring is stiffer than M/h².
  CHECK(fitted_slope(log_k, log_gap) == Approx(-1).margin(0.1));
}

TEST_CASE("for Newmark the implicit and the averaged penalty coincide") {
  const auto tip = [](const char* evaluation) {
    return tip_after(
        {{"consistent"}, {"penalty", {{"stiffness", 1e4}, {"evaluation", std::string(evaluation)}}}, {"newmark"}}, 1e-4,
        0.3);
  };
  CHECK(tip("implicit") == tip("averaged"));
  CHECK(tip("explicit") != tip("implicit"));
}

TEST_CASE("averaged penalty springs keep the energy of a free impact, and the spring gives it back") {
  // β = ¼: the spring is treated as K is, and the scheme keeps the energy of every linear piece. Only the two steps
  // that straddle contact onset and release break it, by O(h).
  SceneSpec scene = working_set();
  std::vector<double> drift;
  for (const double h : {1e-4, 1e-5}) {
    Marcher beam = marcher(scene, 8,
                           {{"consistent"},
                            {"penalty", {{"stiffness", 1e3}, {"evaluation", std::string("averaged")}}},
                            {"newmark-dumont-paoli", {{"beta", 0.25}}}},
                           h);
    const EnergyAudit audit = audited(beam, 0.1);
    CHECK(audit.contact(0).impacts > 0);
    CHECK(audit.contact(0).deepest_penetration > 1e-4);
    drift.push_back(std::abs(audit.energy(0).common() / audit.totals(0).first.common() - 1));
  }
  CHECK(drift[0] < 0.02);
  CHECK(drift[1] < 0.3 * drift[0]);
}

TEST_CASE("an explicit penalty needs no solve and fails beyond its own step limit") {
  const auto running = [](double stiffness) {
    Marcher beam = marcher(working_set(), 8,
                           {{"consistent"},
                            {"penalty", {{"stiffness", stiffness}, {"evaluation", std::string("explicit")}}},
                            {"newmark-dumont-paoli"}},
                           1e-4);
    EnergyAudit audit(beam);
    beam.start(&audit);
    beam.march(4000, &audit);
    return beam.status(0).running && audit.totals(0).largest_step_gain < 1e-2 * audit.totals(0).scheme_start;
  };
  CHECK(running(1e2));
  CHECK_FALSE(running(1e9));
}

TEST_CASE("no contact law is a beam without stops") {
  SceneSpec open = scene_at_nodes();
  open.stops.lower.reset();
  open.stops.upper.reset();
  Marcher without = marcher(open, 8, {{"consistent"}, {"signorini"}, {"newmark"}}, 1e-4);
  run(without, 0.2);
  CHECK(tip_after({{"consistent"}, {"none"}, {"newmark"}}, 1e-4, 0.2) == Approx(without.tip(0)).epsilon(1e-12));
}
