#include <fmt/format.h>

#include <ricochet/measure/stability/stability.hpp>
#include <ricochet/measure/stability/step_map.hpp>
#include <ricochet/measure/stability/structure_physics.hpp>

#include "tests/amplification_roots.hpp"
#include "tests/eigen.hpp"
#include "tests/marching.hpp"
#include "tests/measure/stability/marched_steps.hpp"

namespace stability_tests {

TEST_CASE("the step matrix is the step that is marched, contact open") {
  for (const Choice& mass : {Choice{"consistent"}, Choice{"singular", {{"velocity", std::string("P1")}}}})
    for (const Choice& time : schemes())
      for (const double alpha : {0.0, 1e-4}) {
        const SceneSpec scene = damped_scene(alpha);
        const double h = 1e-5;
        const auto problem = problem_of(scene, 4, mass);
        CompileOptions nodal_band;
        nodal_band.kind = OperatorKind::band;
        auto program = compiled(problem, {mass, {"none"}, time}, h, nodal_band);
        INFO(mass.name << " " << time.name << " " << alpha);
        REQUIRE(std::holds_alternative<Refusal>(program) == refused(mass, time));
        if (refused(mass, time)) continue;
        Marcher made(std::move(std::get<Program>(program)));
        made.start();
        const auto map = step_map(nodal(*problem, {}), made.program().plan, {});
        REQUIRE(std::holds_alternative<MatrixXd>(map));
        const MatrixXd& A = std::get<MatrixXd>(map);
        VectorXd x = state(made, 0, A.rows());
        made.march(3);
        for (int k = 0; k < 3; ++k) x = A * x;
        const VectorXd marched = state(made, 0, A.rows());
        // Accelerations lose 1/h² of round-off against positions: each slot is compared in its own size.
        const auto n = A.rows() / made.slot_count();
        for (int j = 0; j < made.slot_count(); ++j)
          CHECK((marched - x).segment(j * n, n).norm() <= 1e-8 * x.segment(j * n, n).norm());
      }
}

TEST_CASE("the step matrix is the step that is marched, contact closed") {
  // A stop pressed far into the structure holds it. Two motions that never leave it differ by a solution of the linear
  // problem. That includes past efforts of the first step, which are zero for both.
  const double push = 0.5, h = 2e-5;
  int compared = 0;
  std::vector<Choice> closing = schemes();
  closing.push_back({"kane", {{"beta", 0.4}, {"gamma", 0.6}}});  // a second unknown in its stage
  for (const Choice& contact :
       {Choice{"signorini"}, penalty(1e5, "implicit"), penalty(1e5, "averaged"), penalty(1e3, "explicit")})
    for (const Choice& time : closing)
      for (const double alpha : {0.0, 1e-4}) {
        if (time.name == "newmark-dumont-paoli" && std::get<double>(time.values.at("beta")) == 0) continue;  // unstable
        // A velocity-level constraint opens again where the approach test says so: no linear step.
        if (time.name == "moreau-jean" && contact.name == "signorini") continue;
        SceneSpec scene = damped_scene(alpha);
        scene.stops.upper.reset();
        const auto problem = problem_of(scene, 4, {"consistent"});
        CompileOptions options;
        options.kind = OperatorKind::band;
        auto program = compiled(problem, {{"consistent"}, contact, time}, h, options, [&](const LaneSpec& lane) {
          const MatrixXd K = problem->stiffness;
          const VectorXd lift = eigen::ldlt_solve(K, problem->contact.row(0).transpose());
          std::vector<LaneSpec> two(2, lane);
          for (int k = 0; k < 2; ++k) {
            LaneSpec& spec = two[static_cast<std::size_t>(k)];
            spec.lower[0] = push;
            spec.position = lift * push / lift[lift.size() - 2];
            spec.velocity.setZero();
            // The second one moves as well; the tip stays where it is.
            if (k == 1)
              for (int i = 0; i < spec.position.size() - 2; ++i) spec.position[i] += 1e-6 * std::sin(1.0 + i);
          }
          return two;
        });
        REQUIRE(std::holds_alternative<Program>(program));
        Marcher made(std::move(std::get<Program>(program)));
        made.start();
        const LinearLaw law = linear(contact, 1);
        const auto map =
            step_map(nodal(*problem, {0}), made.program().plan, {law.evaluation, law.stiffness.value_or(0)});
        REQUIRE(std::holds_alternative<MatrixXd>(map));
        const MatrixXd& A = std::get<MatrixXd>(map);
        const bool starts_in_contact = !made.program().plan.start.empty() && made.program().start[0].reads_contact;
        if (starts_in_contact) continue;  // its efforts would be the past of the first step
        ++compared;
        VectorXd x = state(made, 1, A.rows()) - state(made, 0, A.rows());
        made.march(4);
        for (int k = 0; k < 4; ++k) x = A * x;
        const VectorXd marched = state(made, 1, A.rows()) - state(made, 0, A.rows());
        const auto n = static_cast<Eigen::Index>(problem->dofs());
        INFO(contact.name << " " << time.name << " " << alpha);
        // The difference is 10⁻⁶ of two states of size ½ (round-off 10⁻¹⁰ of it), stiff modes amplify that.
        for (int j = 0; j < made.slot_count(); ++j)
          CHECK((marched - x).segment(j * n, n).norm() <= 1e-5 * x.segment(j * n, n).norm());
      }
  // Four laws × six schemes × two α, without Signorini × Moreau–Jean and those that start in contact: Newmark's, and
  // the first-order start under Signorini.
  CHECK(compared == 26);
}

TEST_CASE("mode by mode and all at once give the same radius") {
  int closed_sets = 0;
  for (const Choice& mass : {Choice{"consistent"}, Choice{"singular", {{"velocity", std::string("P0")}}}})
    for (const double alpha : {0.0, 1e-4})
      for (const Choice& time : schemes())
        for (const double h : {1e-6, 1e-4, 1e-2}) {
          const auto problem = problem_of(damped_scene(alpha, StopsSpec::Place::nodes), 4, mass);
          const auto facts = problem_facts(*problem, *make(registry().contact("signorini"), {"signorini"}));
          const auto made = plan_of(time, h, facts);
          REQUIRE(std::holds_alternative<Refusal>(made) == refused(mass, time));
          if (refused(mass, time)) continue;
          const StepPlan& step = std::get<StepPlan>(made);
          const auto predicted = predictor(problem, {"signorini"});
          const auto dense = [&](const std::vector<int>& closed) {
            const auto map = step_map(nodal(*problem, closed), step, {});
            REQUIRE(std::holds_alternative<MatrixXd>(map));
            double largest = 0;
            for (const Root& root : step_roots(in_metres(std::get<MatrixXd>(map), step, h, problem->dofs()), false))
              largest = std::max(largest, std::abs(root.value));
            return largest;
          };
          INFO(mass.name << " " << time.name << " alpha " << alpha << " h " << h);
          // Double roots of the kernel come out of the dense matrix to the square root of round-off times its norm.
          const double near = 2e-4;
          CHECK(known(predicted.open(step, h)).radius == Approx(dense({})).epsilon(near));
          for (const ClosedSet& set : predicted.sets()) {
            CHECK(known(predicted.closed(step, h, set)).radius == Approx(dense(set.points)).epsilon(near));
            ++closed_sets;
          }
        }
  // Six schemes on the regular mass, five on the singular one; two α, three h; four points and all of them.
  CHECK(closed_sets == 330);
}

}  // namespace stability_tests
