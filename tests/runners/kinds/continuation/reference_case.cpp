// Cases that a reference solves: what the study makes of the key, what they leave, and that they change no other case.
#include <algorithm>

#include "runners/kinds/continuation/point_tables.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/run/finish_run.hpp"
#include "tests/runners/kinds/continuation/tube_study.hpp"
#include "tests/runners/report/synthetic_points.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Json with_reference(Json reference) {
  Json study = tube_continuation();
  study["reference"] = std::move(reference);
  return study;
}

const StudyCase* case_of(const Study& study, const std::string& id) {
  return find_case(study, id);
}

StudyResults with_beam(StudyResults all) {
  CaseRecord beam = synthetic::points_case("smooth", 0, 100000, 10000000);
  beam.id = reference_id;
  beam.axes.clear();
  all.cases.push_back(std::move(beam));
  return all;
}

}  // namespace

TEST_CASE("a reference of a continuation study is a case of its own, and the others stay as they are") {
  const OpenedContinuation plain = opened_continuation(tube_continuation()),
                           opened = opened_continuation(with_reference(
                               {{{"name", "event-driven"}, {"modes", 40}}, {{"name", "event-driven"}, {"modes", 20}}}));
  CHECK_FALSE(plain.study.resolved.contains("reference"));
  REQUIRE(opened.study.cases.size() == plain.study.cases.size() + 2);
  CHECK(opened.study.columns == plain.study.columns);
  CHECK(StudyIdentity(plain.study, *plain.registry).of(plain.study.cases[0]) ==
        StudyIdentity(opened.study, *opened.registry).of(opened.study.cases[0]));
  const StudyCase *first = case_of(opened.study, "reference"), *second = case_of(opened.study, "reference-2");
  REQUIRE(first);
  REQUIRE(second);
  CHECK(first->axes.empty());
  CHECK(first->references.front().parameters.integer("modes") == 40);
  StudyIdentity identity(opened.study, *opened.registry);
  CHECK(identity.of(*first) != identity.of(*second));
}

TEST_CASE("each scene of a continuation study has its reference") {
  Json study = with_reference("event-driven");
  study["scene"]["structure"]["damping"]["stiffness"] = {1e-4, 2e-4};
  const OpenedContinuation opened = opened_continuation(study);
  const StudyCase* second = case_of(opened.study, "reference-2");
  REQUIRE(second);
  REQUIRE(second->axes.size() == 1);
  CHECK(second->axes.front().first == "structure.damping.stiffness");
  CHECK(second->axes.front().second == 2e-4);
  CHECK_FALSE(case_of(opened.study, "reference-3"));
}

TEST_CASE("references without orbits of their own are refused") {
  CHECK(error_of(with_reference("self")).starts_with("/reference/0: it marches the methods themselves"));
  CHECK(error_of(with_reference("event-drivn")).find("did you mean \"event-driven\"") != std::string::npos);
  Json study = with_reference("event-driven");
  study["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 1e5}};
  study["parameter"] = {{"pointer", "/methods/contact/stiffness"}, {"from", 1e4}, {"to", 1e6}};
  study["orbits"][0]["at"] = 1e5;
  CHECK(error_of(study).starts_with("/reference: a reference has no /methods/contact/stiffness"));
  // A scene without a map is told by its case.
  const OpenedContinuation opened = opened_continuation(with_reference("exact"));
  const CasePlan plan = plan_continuation(*case_of(opened.study, "reference"), *opened.registry);
  CHECK_FALSE(plan.refusal.empty());
}

TEST_CASE("the reference of the tube becomes a torus at 0.0849574 m") {
  Json study = with_reference({{"name", "event-driven"}, {"modes", 12}});
  study["parameter"] = {{"pointer", "/scene/support/amplitude"}, {"from", 0.083}, {"to", 0.0853}};
  study["orbits"] = {{{"at", 0.0845}, {"periods", 200}}};
  const OpenedContinuation opened = opened_continuation(study);
  const std::atomic<bool> stop{false};
  const CaseRecord record = run_continuation(*case_of(opened.study, "reference"), *opened.registry, {}, stop);
  CHECK(record.status == Status::done);
  std::optional<double> torus;
  for (const SpecialRow& row : points_of(record))
    if (row.kind == PointKind::torus) torus = row.parameter;
  REQUIRE(torus);
  // 20 modes and more: 0.08495738; what 12 leave out is below 1e-7 m.
  CHECK(*torus == Approx(0.08495738).epsilon(0).margin(1e-7));
  for (const BranchRow& row : rows_of(record)) {
    CHECK(row.symmetric == true);
    CHECK(*row.residual <= 1e-12);
    CHECK(row.penetration == 0);
  }
  const std::atomic<bool> stopped{true};
  CHECK_THROWS_AS(run_continuation(*case_of(opened.study, "reference"), *opened.registry, {}, stopped), Interrupted);
}

TEST_CASE("a branch of a reference stops at the points at which branches stop") {
  Json study = with_reference({{"name", "event-driven"}, {"modes", 8}});
  study["parameter"] = {{"pointer", "/scene/support/amplitude"}, {"from", 0.083}, {"to", 0.088}};
  study["orbits"] = {{{"at", 0.0845}, {"periods", 200}}};
  study["stop_at"] = {"torus"};
  study["both_ways"] = false;
  const OpenedContinuation opened = opened_continuation(study);
  const std::atomic<bool> stop{false};
  const CaseRecord record = run_continuation(*case_of(opened.study, "reference"), *opened.registry, {}, stop);
  const auto points = points_of(record);
  REQUIRE_FALSE(points.empty());
  CHECK(points.back().kind == PointKind::end);
  CHECK(points.back().note.starts_with("stopped at the first torus, at 0.08495"));
  for (const BranchRow& row : rows_of(record)) CHECK(*row.parameter < 0.0851);
}

TEST_CASE("first orbits of a reference are looked for as those of a method") {
  Json study = with_reference({{"name", "event-driven"}, {"modes", 8}});
  study["parameter"]["from"] = 0.02;
  study["follow"] = "none";
  study["orbits"] = {{{"at", 0.03}, {"from", "free"}},
                     {{"at", 0.03}, {"periods", 20}},
                     {{"at", 0.03}, {"periods", 20}, {"period", 2}},
                     {{"at", 0.03}, {"periods", 20}, {"symmetric", true}}};
  const std::atomic<bool> stop{false};
  const auto run = [&] {
    const OpenedContinuation opened = opened_continuation(study);
    return run_continuation(*case_of(opened.study, "reference"), *opened.registry, {}, stop);
  };
  const CaseRecord record = run();
  const auto rows = rows_of(record);
  REQUIRE(rows.size() == 3);
  // Where nothing is touched the motion is linear: one solution, whatever it is looked for from.
  for (const BranchRow& row : rows) {
    CHECK(row.symmetric == true);
    CHECK(*row.tip_displacement == Approx(*rows[0].tip_displacement).epsilon(0).margin(1e-11));
  }
  CHECK(record.reason() == "the orbit found from rest at λ = 0.03 repeats after 1 period; expected period 2");
  study["orbits"].erase(2);
  study["scene"]["stops"]["lower"] = -0.11;
  CHECK(run().reason().starts_with("the scene is not its own image"));
}

TEST_CASE("a reference fills its columns and changes neither names nor limits nor orders") {
  const AnalysedResults plain(synthetic::points()), beside(with_beam(synthetic::points()));
  const auto before = point_limits_type().read(plain.derived), after = point_limits_type().read(beside.derived);
  REQUIRE(before.size() == after.size());
  const synthetic::PointLaw law;
  int filled = 0;
  for (std::size_t k = 0; k < after.size(); ++k) {
    CHECK(after[k].id == before[k].id);
    CHECK(after[k].name == before[k].name);
    CHECK(after[k].limit == before[k].limit);
    CHECK(after[k].low == before[k].low);
    if (!after[k].reference || !after[k].name.starts_with("fold at 0.1006")) continue;
    CHECK(*after[k].reference == Approx(law.fold).epsilon(0).margin(1e-9));
    CHECK(*after[k].reference_gap == *after[k].limit - *after[k].reference);
    ++filled;
  }
  CHECK(filled > 0);
  const auto orders = point_orders_type().read(plain.derived), same = point_orders_type().read(beside.derived);
  REQUIRE(orders.size() == same.size());
  for (std::size_t k = 0; k < same.size(); ++k) CHECK(same[k].order == orders[k].order);
  const std::vector<asks::VerdictRow>& said = beside.asked.all.front().second.rows;
  CHECK(std::any_of(said.begin(), said.end(), [](const asks::VerdictRow& row) {
    return row.reason.find("reference 0.1005653") != std::string::npos;
  }));
}
