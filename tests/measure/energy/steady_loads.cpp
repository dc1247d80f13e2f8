// A steady load has a potential: its zero is the lowest that the structure can reach, and what is left of the energy
// does not depend on the instant at which it is read.
#include <random>
#include <ricochet/measure/energy/energy_audit.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double gravity = 9.81;

/// 1 kg on a spring, let go at `height`, with a stop below at `stop`.
SceneSpec ball(double height, double stiffness = 0, std::optional<double> stop = 0.0, double force = -gravity) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, stiffness, 0, {}};
  if (stop) scene.stops.lower = Formula(*stop);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(height);
  scene.load = Formula(force);
  return scene;
}

std::optional<double> lowest(const SceneSpec& scene, int elements, const Choice& contact) {
  const auto problem = problem_of(scene, elements, {"consistent"}, contact);
  const auto* entry = registry().contact(contact.name);
  const auto law = make(entry, contact);
  const Parameters parameters = complete(entry->manual.parameters, contact.values);
  law->prepare(problem->points(), {&parameters, 1});
  Eigen::VectorXd load(problem->dofs());
  REQUIRE(problem->load->assemble_steady(load.data()));
  return lowest_potential(*problem, load, law.get());
}

/// The common energy after each of `ends` (s, ascending), and that of the start.
std::vector<double> energies(const SceneSpec& scene, int elements, const Methods& methods, double h,
                             const std::vector<double>& ends, std::optional<double> level = std::nullopt) {
  Marcher made = marcher(scene, elements, methods, h);
  EnergyAudit audit(made);
  Eigen::VectorXd load(made.program().problem->dofs());
  REQUIRE(made.program().problem->load->assemble_steady(load.data()));
  if (!level) level = lowest_potential(*made.program().problem, load, &made.law());
  audit.count_load(made, load, level.value());
  std::vector<double> out = {audit.energy(0).common()};
  made.start(&audit);
  for (const double end : ends) {
    made.march(std::llround(end / h) - made.step(), &audit);
    REQUIRE(made.status(0).running);
    out.push_back(audit.energy(0).common());
  }
  return out;
}

std::vector<double> random_instants(double duration, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(0.01 * duration, duration);
  std::vector<double> out;
  for (int k = 0; k < count; ++k) out.push_back(at(random));
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("the lowest potential under a steady load is that of statics") {
  const Choice rigid{"signorini"}, spring{"penalty", {{"stiffness", 1e4}}};
  // On the stop; on a spring of its own; pressed into a compliant stop; between spring and stop, which is nearer.
  CHECK(lowest(ball(1), 1, rigid).value() == Approx(0).margin(1e-12));
  CHECK(lowest(ball(1, 0, 0.3), 1, rigid).value() == Approx(0.3 * gravity));
  CHECK(lowest(ball(1, 100, std::nullopt), 1, rigid).value() == Approx(-0.5 * gravity * gravity / 100));
  CHECK(lowest(ball(1), 1, spring).value() == Approx(-0.5 * gravity * gravity / 1e4));
  CHECK(lowest(ball(1, 100, -0.05), 1, rigid).value() == Approx(0.5 * 100 * 0.05 * 0.05 - gravity * 0.05));
  // A cantilever under q per length: −q² L⁵/(40EI).
  SceneSpec beam = working_set();
  beam.stops = {};
  beam.load = Formula(-0.7);
  const double length = beam_of(beam).length;
  const BeamSpec& spec = beam_of(beam);
  const double EI = section_properties(spec.section, spec.young, spec.density).EI;
  // To the fourth power of the mesh.
  CHECK(lowest(beam, 6, {"none"}).value() == Approx(-0.49 * std::pow(length, 5) / (40 * EI)).epsilon(1e-4));
  // Nothing holds it.
  CHECK_FALSE(lowest(ball(1, 0, std::nullopt), 1, {"none"}).has_value());
  CHECK_FALSE(lowest(ball(1, 0, 0.0, gravity), 1, rigid).has_value());
}

TEST_CASE("terms that depend on time have no part in the steady load") {
  SceneSpec scene = ball(1);
  LoadTerm wave;
  wave.force = true;
  wave.history = Formula("3*sin(20*t)", "", "t");
  scene.load.terms = {wave};
  const auto problem = problem_of(scene, 1, {"consistent"});
  double load = 0;
  REQUIRE(problem->load->assemble_steady(&load));
  CHECK(load == -gravity);
  scene.load = Formula("-9.81 + sin(t)", "");
  CHECK_FALSE(problem_of(scene, 1, {"consistent"})->load->assemble_steady(&load));
}

TEST_CASE("a ball has W H before it lands and e² of it between the first bounces, wherever the motion ends") {
  const double e = GENERATE(0.9, 0.5, 1.0), height = GENERATE(1.0, 0.2);
  const auto time = GENERATE(Choice{"moreau-jean", {{"theta", 0.5}}}, Choice{"newmark-dumont-paoli", {{"beta", 0.25}}});
  Choice scheme = time;
  scheme.values["restitution"] = e;
  const double fall = std::sqrt(2 * height / gravity), h = 1e-4;
  std::vector<double> ends = random_instants(0.98 * fall, 5);
  for (const double late : random_instants(1.9 * e * fall, 8)) ends.push_back(1.02 * fall + 0.97 * late);
  const std::vector<double> found = energies(ball(height), 1, {{"consistent"}, {"signorini"}, scheme}, h, ends);
  INFO(time.name << " e = " << e << ", height " << height);
  CHECK(found[0] == Approx(gravity * height));
  // The step in which it lands leaves its speed by (1 + e) g h: that share of e v, twice.
  const double first_order = 2.2 * (1 + e) / e * h / fall;
  for (std::size_t k = 1; k < found.size(); ++k)
    CHECK(found[k] == Approx((k <= 5 ? 1 : e * e) * gravity * height).epsilon(k <= 5 ? 1e-6 : first_order));
  // Between two impacts it does not change at all.
  for (std::size_t k = 7; k < found.size(); ++k) CHECK(found[k] == Approx(found[6]).epsilon(1e-9));
}

TEST_CASE("an oscillator under a constant force, and a beam, keep the energy above their rest") {
  const Methods methods{{"consistent"}, {"signorini"}, {"moreau-jean", {{"theta", 0.5}, {"restitution", 1.0}}}};
  // About its rest at −W/k, 0.0981 m below: ½ k (0.2 + 0.0981)².
  const double amplitude = 0.2 + gravity / 100;
  for (const double found :
       energies(ball(0.2, 100, std::nullopt), 1, {{"consistent"}, {"none"}, methods.time}, 1e-3, random_instants(3, 6)))
    CHECK(found == Approx(0.5 * 100 * amplitude * amplitude).epsilon(1e-9));
  SceneSpec beam = working_set();
  beam_of(beam).damping = {};
  beam.support = {};
  beam.load = Formula(-2.0);
  beam.stops = {};
  const std::vector<double> found =
      energies(beam, 6, {{"consistent"}, {"none"}, methods.time}, 1e-4, random_instants(0.3, 5));
  CHECK(found[0] > 0);
  for (const double one : found) CHECK(one == Approx(found[0]).epsilon(1e-8));
}

TEST_CASE("a ball on a compliant stop keeps its energy through many bounces by a law that conserves it") {
  const Choice law{"penalty", {{"stiffness", 1e4}, {"evaluation", std::string("conserving")}}};
  const std::vector<double> found =
      energies(ball(0.1), 1, {{"consistent"}, law, {"midpoint"}}, 1e-4, random_instants(3, 12),
               lowest(ball(0.1), 1, {"penalty", {{"stiffness", 1e4}}}));
  CHECK(found[0] == Approx(gravity * 0.1 + 0.5 * gravity * gravity / 1e4));
  for (const double one : found) CHECK(one == Approx(found[0]).epsilon(1e-9));
}

TEST_CASE("what driving brought in never falls, and steady loads bring nothing in") {
  SceneSpec scene = ball(0.05);
  scene.load.terms = {{.force = true, .at = {}, .shape = Formula(), .history = Formula("2*sin(30*t)", "", "t")}};
  Marcher made = marcher(scene, 1, {{"consistent"}, {"signorini"}, {"moreau-jean", {{"restitution", 0.8}}}}, 1e-4);
  EnergyAudit audit(made);
  double load = 0;
  REQUIRE(made.program().problem->load->assemble_steady(&load));
  audit.count_load(made, Eigen::VectorXd::Constant(1, load), 0);
  made.start(&audit);
  double before = audit.totals(0).brought_in();
  CHECK(before == Approx(gravity * 0.05));
  for (int k = 0; k < 200; ++k) {
    made.march(100, &audit);
    audit.mark_brought_in(0);
    const EnergyTotals& totals = audit.totals(0);
    CHECK(totals.brought_in() >= before);
    // Nothing but the wave brings energy in, and stops take some: to the share of a step that places are apart by.
    CHECK(audit.energy(0).common() <= totals.brought_in() * (1 + 1e-3));
    before = totals.brought_in();
  }
  CHECK(before >= gravity * 0.05);
}
