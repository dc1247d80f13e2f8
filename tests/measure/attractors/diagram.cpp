// A diagram of several cases on types: who is the reference, who agrees, which change became which.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/measure/attractors/diagram.hpp>

using namespace ricochet;

namespace diagram_tests {

namespace {

constexpr MotionClass once{Regime::periodic, 1}, twice{Regime::periodic, 2}, chaotic{Regime::chaotic, 0};

/// Cases × values, one start; the class says which section there is.
Diagram diagram_of(const std::vector<std::vector<MotionClass>>& classes) {
  Diagram diagram;
  diagram.starts = {{"rest", false}};
  for (const auto& row : classes) {
    DiagramCase& owner = diagram.cases.emplace_back();
    for (std::size_t k = 0; k < row.size(); ++k) {
      DiagramRun run;
      run.parameter = 0.1 * static_cast<double>(k);
      run.motion = row[k];
      run.period = row[k].period;
      run.settled = row[k].regime != Regime::failed;
      if (!run.settled) run.status = "diverged";
      owner.runs.push_back(run);
    }
  }
  diagram.number_values();
  return diagram;
}

SettledSection section_of(const DiagramRun& run) {
  const double x = run.motion.regime == Regime::chaotic ? 3 : run.motion.period;
  return {run.motion, make_cloud(std::vector<CloudPoint>(8, {x, x}), {}, {1, 1}, 1)};
}

Diagram with_attractors(const std::vector<std::vector<MotionClass>>& classes) {
  Diagram diagram = diagram_of(classes);
  find_attractors(
      diagram, [](std::size_t, const DiagramRun& run) { return section_of(run); }, nullptr);
  return diagram;
}

}  // namespace

TEST_CASE("diagram: runs are found by value and start, values ascend over all cases") {
  Diagram diagram = diagram_of({{once, twice}, {once}});
  CHECK(diagram.value_count() == 2);
  REQUIRE(diagram.run(0, 1, 0));
  CHECK(diagram.run(0, 1, 0)->motion == twice);
  CHECK(diagram.run(1, 1, 0) == nullptr);
}

TEST_CASE("diagram: the reference is the stiffest, then the finest, of the cases that decide") {
  Diagram diagram = diagram_of({{once}, {once}, {once}, {{Regime::failed}}, {once}});
  const double compliance[] = {1e-6, 0, 0, 0, 0}, steps[] = {9000, 1000, 2000, 8000, 2000};
  for (std::size_t c = 0; c < 5; ++c) {
    diagram.cases[c].compliance = compliance[c];
    diagram.cases[c].steps_per_period = steps[c];
  }
  CHECK(reference_case(diagram) == 2u);
  diagram.cases[4].elements = 1;
  CHECK(reference_case(diagram) == 4u);
  // All dofs of a mesh are more than any number of modes.
  diagram.cases[2].elements = 1;
  diagram.cases[2].modes = INFINITY;
  diagram.cases[4].modes = 40;
  CHECK(reference_case(diagram) == 2u);
  // What is not known is taken for the softest.
  for (DiagramCase& one : diagram.cases) one.compliance.reset();
  diagram.cases[0].compliance = 1;
  CHECK(reference_case(diagram) == 0u);
  CHECK_FALSE(reference_case(diagram_of({{{Regime::undecided}}})));
}

TEST_CASE("diagram: one attractor is one number over cases and values, agreement counts it") {
  const Diagram diagram = with_attractors({{once, once, chaotic}, {once, twice, chaotic}, {once, once, {}}});
  CHECK(diagram.attractors == 3);
  CHECK(diagram.run(0, 0, 0)->attractor == diagram.run(2, 1, 0)->attractor);
  CHECK(diagram.run(2, 2, 0)->attractor == 0);
  const Agreement found = agreement(diagram.cases[0], diagram.cases[1]);
  CHECK(found.compared == 3);
  CHECK(found.same_class == 2);
  CHECK(found.same_attractor == 2);
  CHECK(agreement(diagram.cases[0], diagram.cases[2]).compared == 2);
  CHECK(agreement(diagram.cases[1], diagram.cases[1]).same_attractor == 3);
  const auto extents = extents_of(diagram);
  REQUIRE(extents.size() == 3);
  CHECK(extents[0].motion == once);
  CHECK(extents[0].cases.size() == 3);
}

TEST_CASE("diagram: cases agree, differ by a choice, or are open") {
  const std::vector<ChoiceAxis> axes = {{"mass", {"a", "a", "b", "b"}}, {"step", {"1", "2", "1", "2"}}};
  const Diagram diagram =
      with_attractors({{once, once, once}, {once, once, once}, {once, twice, {Regime::failed}}, {once, twice, once}});
  const auto stretches = stretches_of(diagram, axes);
  REQUIRE(stretches.size() == 3);
  CHECK(stretches[0].front().verdict == Robustness::robust);
  CHECK(stretches[1].front().verdict == Robustness::depends);
  CHECK(stretches[1].front().one_choice());
  CHECK(stretches[1].front().choice.name == "mass");
  CHECK_FALSE(stretches[1].front().same_classes);
  CHECK(stretches[2].front().verdict == Robustness::undecided);
  REQUIRE(stretches[2].front().open.size() == 1);
  CHECK(stretches[2].front().open.begin()->second->status == "diverged");
  CHECK(attractor_sets(stretches[1], {0, 1, 2}).size() == 2);
  // A value that one case alone speaks of is none to compare at.
  CHECK(stretches_of(with_attractors({{once, once}, {once}}), {{"mass", {"a", "b"}}}).front().size() == 1);
}

TEST_CASE("changes: the nearest first, each once, none beyond reach, none of another kind") {
  const auto change = [](double at, const char* to = "chaotic") {
    return DiagramChange{"up", "periodic 1", to, "change", at, at, at};
  };
  const std::vector<DiagramChange> reference = {change(1.0), change(1.2), change(3.0), change(5.0, "periodic 2")};
  const std::vector<DiagramChange> here = {change(1.15), change(0.8), change(4.0), change(5.0)};
  CHECK(match_changes(reference, here, 0.5) == std::vector<int>{1, 0, -1, -1});
  CHECK(match_changes(reference, {}, 0.5) == std::vector<int>{-1, -1, -1, -1});
  CHECK(match_changes({}, here, 0.5).empty());
}

}  // namespace diagram_tests
