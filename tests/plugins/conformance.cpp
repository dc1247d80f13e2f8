// What every plugin must satisfy, ours and those of RICOCHET_PLUGIN_PATH: it is enough to be registered. Each plugin
// runs with its defaults, and with the value of this table where a parameter has none.
#include <ricochet/scene/assembly.hpp>

#include "tests/amplification_roots.hpp"
#include "tests/eigen.hpp"
#include "tests/plugins/with_defaults.hpp"
#include "tests/refusals.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

std::vector<Choice> all(Role role) {
  std::vector<Choice> choices;
  for (const std::string& name : registry().names(role))
    choices.push_back(with_defaults(*registry().manual(role, name)));
  REQUIRE_FALSE(choices.empty());
  return choices;
}

SceneSpec impacting_scene() {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-5;
  scene.stops.place = StopsSpec::Place::nodes;
  return scene;
}

// The scene that a mass strategy is made for: the beam, else the bar. A refusal of both is a strategy without use.
SceneSpec scene_for(const Choice& mass, int elements) {
  auto made = discretise(impacting_scene(), elements, *make(registry().mass(mass.name), mass));
  if (const auto* refusal = std::get_if<Refusal>(&made)) {
    CHECK_THAT(refusal->sentence.text, names_cause_and_remedy());
    return released_bar(1e4, "0.05*(1-x)");
  }
  return impacting_scene();
}

// The same space with its clamped dofs let go, numbered node by node.
FiniteElementSpace released(FiniteElementSpace space) {
  const int per_node = space.functions() / 2;
  std::map<int, int> number;
  for (std::size_t e = 0; e < space.elements.size(); ++e)
    for (int a = 0; a < space.functions(); ++a) {
      int& dof = space.elements[e].dof[static_cast<std::size_t>(a)];
      const int free = static_cast<int>(e) * per_node + a;
      if (dof >= 0) number[dof] = free;
      dof = free;
    }
  for (int& dof : space.contact_dofs) dof = number.at(dof);
  for (auto& point : space.point_masses) point.dof = number.at(point.dof);
  space.dofs = (static_cast<int>(space.elements.size()) + 1) * per_node;
  space.left_fixed = space.right_fixed = false;
  return space;
}

// vᵀMv of a translation of all free nodes at 1 m/s.
double translated(const Eigen::MatrixXd& M, const FiniteElementSpace& space) {
  Eigen::VectorXd rigid(space.dofs);
  const auto places = dof_places(space);
  for (int i = 0; i < space.dofs; ++i) rigid[i] = places[static_cast<std::size_t>(i)].slope ? 0 : 1;
  return rigid.dot(M * rigid);
}

// Whether some stage has what the law reads.
bool asks(const StepPlan& plan, const ContactLaw& law) {
  if (law.absent()) return true;
  return std::any_of(plan.stages.begin(), plan.stages.end(), [&](const Stage& stage) {
    return law.reads() ? stage.at(*law.reads()).has_value() : stage.impact.has_value();
  });
}

double total_mass(const SceneSpec& scene) {
  if (const auto* bar = std::get_if<BarSpec>(&scene.structure)) return bar->rhoA * bar->length;
  return line_density(scene) * std::get<BeamSpec>(scene.structure).length;
}

}  // namespace

TEST_CASE("conformance: manuals say what a user needs") {
  for (const Role role : all_roles)
    for (const std::string& name : registry().names(role)) {
      const PluginManual& manual = *registry().manual(role, name);
      INFO(role_name(role) << " " << name);
      CHECK_FALSE(manual.summary.empty());
      CHECK_FALSE(manual.text.empty());
      CHECK_FALSE(manual.source.empty());
      for (const ParameterSpec& spec : manual.parameters) {
        INFO(spec.key);
        CHECK_FALSE(spec.text.empty());
        CHECK_FALSE(spec.unit.empty());
        if (spec.fallback) CHECK_FALSE(check_parameter(spec, *spec.fallback));
      }
    }
}

TEST_CASE("conformance: a mass matrix is symmetric, positive semidefinite, and has the kernel it declares") {
  for (const Choice& choice : all(Role::mass)) {
    INFO(choice.name);
    const SceneSpec scene = scene_for(choice, 6);
    const auto problem = problem_of(scene, 6, choice);
    const Eigen::MatrixXd M = dense_mass(problem->inertia);
    // Entries of one size; eigenvalues relative to the largest.
    CHECK((M - M.transpose()).norm() <= 1e-14 * M.norm());
    const Eigen::VectorXd values = eigen::values(M);
    CHECK(values[0] >= -1e-13 * values.maxCoeff());
    CHECK((values.array() < 1e-12 * values.maxCoeff()).count() == problem->inertia.kernel_dimension);
    // The mass of the structure itself: a rigid translation, whose clamped nodes move with the others. Without them the
    // clamped element stretches: it then weighs less, or more where inertia is added against its deformation.
    const FiniteElementSpace whole = released(problem->space);
    const Eigen::MatrixXd free = dense_mass(built(*make(registry().mass(choice.name), choice), whole));
    CHECK(translated(free, whole) == Approx(total_mass(scene)).epsilon(1e-12));
    CHECK(translated(M, problem->space) == Approx(total_mass(scene)).epsilon(0.2));
  }
}

TEST_CASE("conformance: a scheme's plan is well formed, prints itself, and is as stable as it says") {
  const double h = 1e-4;
  for (const Choice& choice : all(Role::time)) {
    INFO(choice.name);
    auto made = plan_of(choice, h, {});
    REQUIRE(std::holds_alternative<StepPlan>(made));
    const StepPlan plan = std::get<StepPlan>(made);
    CHECK_FALSE(check_plan(plan));
    CHECK(print_plan(plan).find("S = ") != std::string::npos);
    const auto radius = [&](double frequency) {
      return std::abs(amplification_roots(plan, 1, 0, frequency * frequency / (h * h))[0]);
    };
    // Marginal roots reach 1 up to the square root of round-off where they are double.
    if (plan.facts.stability_limit) {
      CHECK(radius(0.99 * *plan.facts.stability_limit) <= 1 + 1e-6);
      CHECK(radius(1.01 * *plan.facts.stability_limit) > 1 + 1e-6);
    } else {
      for (const double frequency : {0.1, 2.0, 30.0, 1e3}) CHECK(radius(frequency) <= 1 + 1e-6);
    }
    // A scheme that needs inertia everywhere says so in a sentence instead of failing later.
    ProblemFacts massless;
    massless.mass_kernel_dimension = 3;
    massless.contact = true;
    if (plan.facts.needs_regular_mass) {
      auto refused = plan_of(choice, h, massless);
      const auto* refusal = std::get_if<Refusal>(&refused);
      REQUIRE(refusal);
      CHECK_THAT(refusal->sentence.text, names_cause_and_remedy());
    }
  }
}

TEST_CASE("conformance: a scheme that says so gains no energy at rigid stops") {
  int sayers = 0;
  for (const Choice& choice : all(Role::time)) {
    ProblemFacts damped;
    damped.damped = true;  // as the scene is
    auto made = plan_of(choice, 1e-5, damped);
    const SchemeFacts facts = std::get<StepPlan>(made).facts;
    if (!facts.contact_never_gains) continue;
    ++sayers;
    INFO(choice.name);
    // Steps below the limit of a conditionally stable scheme on this mesh of the consistent mass (10 elements).
    Marcher beam = marcher(impacting_scene(), 10, {{"consistent"}, {"signorini"}, choice}, 1e-5);
    const EnergyAudit audit = audited(beam, 0.3);
    CHECK(beam.status(0).running);
    CHECK(audit.contact(0).impacts > 0);
    CHECK(audit.totals(0).largest_step_gain <= 1e-9 * audit.totals(0).scheme_start);
  }
  CHECK(sayers > 0);
}

TEST_CASE("conformance: a contact law pushes, never pulls, and leaves no more penetration than it owns up to") {
  // Recomputed at each step from the stage itself: p > 0 only at the lower stop, p < 0 only at the upper one.
  class Signs final : public StepObserver {
   public:
    long contacts = 0, wrong = 0;
    void stage_solved(const Marcher& marcher, const StageView& view) override {
      if (!view.effort || view.contact_lanes == 0) return;
      const RowMatrix& rows = marcher.program().model->contact();
      for (int j = 0; j < rows.rows(); ++j) {
        const double p = view.effort[0][j];
        if (p == 0) continue;
        ++contacts;
        double u = 0;
        for (int e = rows.start[static_cast<std::size_t>(j)]; e < rows.start[static_cast<std::size_t>(j) + 1]; ++e)
          u += rows.value[static_cast<std::size_t>(e)] * view.slots[0][rows.index[static_cast<std::size_t>(e)]];
        // The beam swings ±0.1 m between the stops: the sign of the displacement tells which one is near.
        if (p * u > 0) ++wrong;
      }
    }
    void step_done(Marcher&) override {}
  };
  int absent = 0;
  for (const Choice& choice : all(Role::contact)) {
    INFO(choice.name);
    SceneSpec scene = impacting_scene();
    scene.stops.place = StopsSpec::Place::tip;
    Marcher beam = marcher(scene, 8, {{"consistent"}, choice, {"newmark-dumont-paoli"}}, 1e-4);
    if (beam.law().absent()) {
      ++absent;
      continue;
    }
    Signs signs;
    beam.start(&signs);
    beam.march(3000, &signs);
    CHECK(beam.status(0).running);
    CHECK(signs.contacts > 0);
    CHECK(signs.wrong == 0);
  }
  CHECK(absent == 1);  // "none"
}

TEST_CASE("conformance: any law, scheme and mass either run together or refuse in a sentence") {
  for (const Choice& mass : all(Role::mass))
    for (const Choice& contact : all(Role::contact))
      for (const Choice& time : all(Role::time)) {
        INFO(mass.name << " × " << contact.name << " × " << time.name);
        const auto problem = problem_of(scene_for(mass, 4), 4, mass, contact);
        constexpr double h = 2e-5;  // below the limits of explicit schemes on these meshes
        auto program = compiled(problem, {mass, contact, time}, h);
        const auto* refusal = std::get_if<Refusal>(&program);
        const auto law = make(registry().contact(contact.name), contact);
        const auto plan = plan_of(time, h, problem_facts(*problem, *law));
        // The scheme says so, or has nothing that such a law reads. As they come, all others run.
        const bool refused = std::holds_alternative<Refusal>(plan) || !asks(std::get<StepPlan>(plan), *law);
        REQUIRE((refusal != nullptr) == refused);
        // No scheme refuses every mass.
        if (problem->inertia.kernel_dimension == 0) REQUIRE(std::holds_alternative<StepPlan>(plan));
        if (refusal) {
          CHECK_THAT(refusal->sentence.text, names_cause_and_remedy());
          continue;
        }
        Marcher beam(std::move(std::get<Program>(program)));
        const EnergyAudit audit = audited(beam, 0.06);
        CHECK(std::isfinite(audit.energy(0).common()));
        if (!beam.law().absent()) CHECK(audit.contact(0).impacts > 0);
      }
}
