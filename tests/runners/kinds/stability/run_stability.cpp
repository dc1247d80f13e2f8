// Kind `stability`, from the study's text to the rows of its tables.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/loader/catalogue.hpp>

#include "runners/kinds/stability/stability.hpp"
#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/study/load_study.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"
#include "tests/places.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Json study_text(const Json& mass, const Json& contact, const Json& time, double from, double to, int count) {
  Json study = Json::parse(R"({
    "name": "cells", "kind": "stability",
    "scene": {
      "structure": {"type": "beam", "length": 1, "section": {"type": "given", "EI": 1, "rhoS": 1}},
      "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"},
      "initial": {"displacement": "0.05*x^2", "velocity": "-x"}
    },
    "mesh": {"elements": 5},
    "duration": 1
  })");
  study["methods"] = {{"mass", mass}, {"contact", contact}, {"time", time}};
  study["steps"] = {{"from", from}, {"to", to}, {"count", count}};
  return study;
}

struct Result {
  Study study;
  CaseRecord record;

  const Table& table(const std::string& name) const {
    for (const Table& one : record.tables)
      if (one.name == name) return one;
    FAIL("no table " << name);
    return record.tables.front();
  }
  bool has(const std::string& name) const {
    return std::any_of(record.tables.begin(), record.tables.end(), [&](const auto& t) { return t.name == name; });
  }
  /// A column of the rows of one contact state.
  std::vector<Cell> column(const std::string& name, const std::string& contact,
                           const std::string& of = "stability") const {
    const TableReader rows(table(of));
    const std::size_t closed = rows.column("closed"), wanted = rows.column(name);
    std::vector<Cell> out;
    for (std::size_t row = 0; row < rows.size(); ++row)
      if (rows.truth(row, closed) == (contact == "closed")) out.push_back(rows.cell(row, wanted));
    return out;
  }
  std::optional<double> measure(const std::string& name) const {
    for (const auto& [key, value] : record.measures)
      if (key == name) return value;
    return std::nullopt;
  }
  bool noted(const std::string& part) const {
    return std::any_of(record.notes.begin(), record.notes.end(),
                       [&](const std::string& note) { return note.find(part) != std::string::npos; });
  }
};

Registry& opened(const Json& text, Study& study) {
  static Catalogue catalogue(tests::places().plugins, {}, {});
  static Registry registry;
  study = parse_study(text.dump(1), catalogue, registry);
  return registry;
}

Result run(const Json& text) {
  Result result;
  const Registry& registry = opened(text, result.study);
  REQUIRE(result.study.cases.size() == 1);
  const std::atomic<bool> stop = false;
  result.record = run_stability(result.study.cases.front(), registry, stop);
  return result;
}

Json dumont_paoli(double beta) {
  return {{"name", "newmark-dumont-paoli"}, {"beta", beta}};
}

/// The largest step of central differences on the unit beam of 5 consistent elements.
constexpr double central_limit = 0.0334014193 / 25;

}  // namespace

TEST_CASE("central differences: the predicted limit, the observed one within 2 %, a status per cell") {
  const Result result = run(study_text("consistent", "signorini", dumont_paoli(0), 1e-4, 1e-2, 9));
  CHECK(result.record.status == Status::done);
  CHECK(result.record.reason().empty());
  const Table& table = result.table("stability");
  CHECK(table_csv({"", "", table.columns, {}}) ==
        "step,closed,radius,marginal,limit_predicted,limit_observed,status,reason\n");
  REQUIRE(table.rows.size() == 18);
  for (const auto& row : table.rows) CHECK(row.size() == table.columns.size());
  const auto steps = result.column("step", "open");
  CHECK(steps.front() == 1e-4);
  CHECK(steps.back() == 1e-2);
  CHECK(steps[4].number().value() == Approx(1e-3).epsilon(1e-12));

  // Five elements miss the constant of a long beam by a little.
  CHECK(result.column("limit_predicted", "open").front().number().value() == Approx(central_limit).epsilon(2e-3));
  const double predicted = result.column("limit_predicted", "open").front().number().value(),
               observed = result.column("limit_observed", "open").front().number().value();
  CHECK(observed == Approx(predicted).epsilon(0.02));
  CHECK(*result.measure("agreement") == Approx(1).epsilon(0.02));
  // A bisection that ends at 1 % leaves half of it open.
  REQUIRE(result.measure("limit_resolution"));
  CHECK(*result.measure("limit_resolution") > 1e-3 * observed);
  CHECK(*result.measure("limit_resolution") < 0.0051 * observed);
  CHECK(*result.measure("limit_predicted") <= predicted);
  CHECK(*result.measure("largest_radius") > 1);
  const auto radius = result.column("radius", "open"), status = result.column("status", "open"),
             reason = result.column("reason", "open");
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool beyond = steps[i].number().value() > predicted;
    CHECK((radius[i].number().value() > 1 + 1e-6) == beyond);
    CHECK(status[i] == (beyond ? "unstable" : "stable"));
    CHECK(reason[i].text().empty() != beyond);
  }
  CHECK_THAT(reason.back().text(), Contains("mode 10 of 10") && Contains("observed: step"));
  // Nothing in any row is not a number.
  for (const Table& one : result.record.tables)
    for (const auto& row : one.rows)
      for (const Cell& cell : row) CHECK(std::isfinite(cell.number().value_or(0)));
  CHECK(result.record.steps > 9 * 3000 / 2);
  CHECK(result.noted("3.5e-4 per step"));
  CHECK(result.noted("open: stable up to h ="));
}

TEST_CASE("one step tells nothing of a range") {
  CHECK_THROWS_WITH(run(study_text("consistent", "none", dumont_paoli(0), 1e-4, 1e-2, 1)),
                    Catch::Matchers::Contains("one step of a range tells nothing of it"));
  CHECK(run(study_text("consistent", "none", dumont_paoli(0), 1e-4, 1e-4, 1)).record.status == Status::done);
}

TEST_CASE("marginal cells are named, refused ones say why") {
  const Json singular = {{"name", "singular"}, {"velocity", "P1"}};
  const Result quarter = run(study_text(singular, "signorini", dumont_paoli(0.25), 1e-4, 1e-2, 3));
  for (const Cell& status : quarter.column("status", "open")) CHECK(status == "marginal");
  for (const Cell& marginal : quarter.column("marginal", "open"))
    CHECK(marginal == "double root −1 on the kernel of the mass (5 times): grows linearly");
  for (const Cell& seen : quarter.column("behaviour", "open", "stability_observed")) CHECK(seen == "marginal");
  for (const Cell& limit : quarter.column("limit_predicted", "open")) CHECK(limit.is_nothing());
  CHECK_FALSE(quarter.measure("limit_predicted"));
  // The same over the steps, as a row: the root, where it lives, and that every step has it.
  CHECK(quarter.column("place", "open", "stability_roots") == std::vector<Cell>{"kernel of the mass"});
  CHECK(quarter.column("root", "open", "stability_roots") == std::vector<Cell>{"root −1"});
  CHECK(quarter.column("double", "open", "stability_roots") == std::vector<Cell>{true});
  CHECK(quarter.column("steps", "open", "stability_roots") == std::vector<Cell>{3});
  CHECK(quarter.column("times", "open", "stability_roots") == std::vector<Cell>{5});
  const Result none = run(study_text("consistent", "signorini", dumont_paoli(0.25), 1e-4, 1e-2, 3));
  CHECK(none.column("root", "open", "stability_roots").empty());

  const Result refused = run(study_text(singular, "signorini", dumont_paoli(0), 1e-4, 1e-2, 3));
  CHECK(refused.record.status == Status::refused);
  CHECK_THAT(refused.record.reason(), Contains("beta"));
  const auto rows = refused.column("status", "open");
  REQUIRE(rows.size() == 3);
  for (const Cell& status : rows) CHECK(status == "refused");
  for (const Cell& reason : refused.column("reason", "open")) CHECK(reason == refused.record.reason());
}

TEST_CASE("without observation nothing is marched") {
  Json text = study_text("consistent", "signorini", dumont_paoli(0), 1e-4, 1e-2, 5);
  text["observe"] = false;
  const Result result = run(text);
  CHECK(result.record.steps == 0);
  CHECK_FALSE(result.has("stability_observed"));
  for (const Cell& limit : result.column("limit_observed", "open")) CHECK(limit.is_nothing());
  CHECK(*result.measure("limit_predicted") == Approx(central_limit).epsilon(2e-3));
  CHECK_FALSE(result.measure("limit_observed"));
  CHECK_FALSE(result.measure("agreement"));
  CHECK(result.record.left_out.empty());
}

TEST_CASE("where every step is stable the case says so in the place of a limit") {
  Json text = study_text("consistent", "signorini", dumont_paoli(0.5), 1e-4, 1e-2, 4);
  const Result result = run(text);
  for (const char* name : {"limit_predicted", "limit_observed"}) {
    CHECK_FALSE(result.measure(name));
    const auto& why = result.record.left_out;
    CHECK(std::find(why.begin(), why.end(),
                    std::pair<std::string, std::string>(name, "every step of the range is stable")) != why.end());
    CHECK(result.measure(std::string("least.") + name) == 1e-2);
  }
}

TEST_CASE("what cannot touch has open cells only") {
  const Result none = run(study_text("consistent", "none", dumont_paoli(0.5), 1e-4, 1e-2, 3));
  CHECK(none.table("stability").rows.size() == 3);
  CHECK(none.column("status", "closed").empty());
  Json text = study_text("consistent", "signorini", dumont_paoli(0.5), 1e-4, 1e-2, 3);
  text["scene"]["stops"] = {{"lower", nullptr}, {"upper", nullptr}, {"at", "tip"}};
  CHECK(run(text).column("status", "closed").empty());
}

TEST_CASE("a scene that touches no stop observes nothing of contact") {
  const Json spring = {{"name", "penalty"}, {"stiffness", 1e4}, {"evaluation", "explicit"}};
  Json text = study_text("lumped", spring, "central-difference", 1e-4, 1e-1, 7);
  const Result struck = run(text);
  REQUIRE(struck.measure("limit_observed"));
  text["scene"].erase("initial");
  // A stop that is softer than the mesh does not bound the step: what is marched without contact tells it.
  for (const double stiffness : {1e6, 1.0}) {
    CAPTURE(stiffness);
    text["methods"]["contact"]["stiffness"] = stiffness;
    const Result rests = run(text);
    CHECK(rests.noted("closed: the scene touches no stop at any stable step"));
    for (const Cell& reason : rests.column("reason", "closed")) CHECK_THAT(reason.text(), Contains("not observed"));
    CHECK(rests.column("impacts", "closed", "stability_observed").empty());
    CHECK(rests.column("limit_observed", "closed").front().is_nothing());
    const auto open = rests.column("limit_observed", "open").front().number();
    REQUIRE(open);
    if (stiffness > 1) {
      CHECK_FALSE(rests.measure("limit_observed"));
      REQUIRE(rests.record.left_out.size() == 1);
      CHECK(rests.record.left_out.front().second == "not observed: the scene touches no stop");
    } else {
      CHECK(rests.measure("limit_observed") == open);
    }
  }
  // One that lies on its stop from the start touches it.
  text["scene"]["stops"] = {{"lower", 0}, {"upper", nullptr}, {"at", "tip"}};
  text["scene"]["load"] = -1;
  text["scene"]["initial"] = {{"equilibrium", true}};
  CHECK_FALSE(run(text).noted("touches no stop"));
}

TEST_CASE("an explicit spring limits the step of the closed cells, and the scene blows up beyond") {
  const double stiffness = 1e4;
  const Json spring = {{"name", "penalty"}, {"stiffness", stiffness}, {"evaluation", "explicit"}};
  const Result result = run(study_text("consistent", spring, dumont_paoli(0.25), 1e-4, 1e-1, 13));
  const Cell predicted = result.column("limit_predicted", "closed").front(),
             observed = result.column("limit_observed", "closed").front();
  REQUIRE(predicted.number());
  REQUIRE(observed.number());
  CHECK(result.column("limit_predicted", "open").front().is_nothing());
  // A contact of a few steps is no lasting one. Impacts make energy somewhat below the limit. Growth needs a little
  // more than the limit to show before the contact opens.
  CHECK(observed.number().value() > predicted.number().value() / 2);
  CHECK(observed.number().value() < predicted.number().value() * 2);
  CHECK(result.column("status", "closed").back() == "unstable");
  CHECK_THAT(result.column("reason", "closed").back().text(), Contains("observed:"));
  for (const Cell& impacts : result.column("impacts", "closed", "stability_observed")) CHECK(impacts.number());
}

TEST_CASE("a rigid stop's restitution over the phases of a step is told from the plan") {
  const auto told = [](const Json& contact, const Json& time) {
    Json text = study_text("consistent", contact, time, 1e-4, 1e-3, 2);
    text["observe"] = false;
    return run(text);
  };
  // Newmark (1/4, 1/2) with the multiplier at the end of the step. It has −1 + 4ξ at the phase ξ, where that leaves the
  // stop. 64 phases come within 4/64 of its ends.
  const Result newmark = told("signorini", {{"name", "newmark"}, {"beta", 0.25}, {"gamma", 0.5}});
  const TableReader rows(newmark.table("restitution"));
  REQUIRE(rows.size() == 1);
  CHECK(rows.number(0, "most").value() == Approx(3).margin(4.0 / 64));
  CHECK(rows.number(0, "rho_inf").value() == Approx(1));
  const Result exact = told("signorini", {{"name", "moreau-jean"}, {"theta", 0.5}, {"restitution", 0.7}});
  const TableReader exactly(exact.table("restitution"));
  for (const char* column : {"least", "mean", "most"})
    CHECK(exactly.number(0, column).value() == Approx(0.7).epsilon(1e-9));
  // A spring rebounds by itself.
  CHECK_FALSE(told({{"name", "penalty"}, {"stiffness", 1e4}}, {{"name", "newmark"}}).has("restitution"));
}

TEST_CASE("where marches and spectrum disagree the row says so") {
  // Newmark's rigid impacts make energy that no spectrum of a fixed contact set shows.
  Json text = study_text("consistent", "signorini", {{"name", "newmark"}}, 1e-4, 1e-3, 3);
  text["scene"]["stops"]["at"] = "nodes";
  text["mesh"]["elements"] = 10;
  text["duration"] = 10;
  const Result result = run(text);
  const auto status = result.column("status", "closed"), reason = result.column("reason", "closed");
  const auto radius = result.column("radius", "closed");
  bool seen = false;
  for (std::size_t i = 0; i < status.size(); ++i) {
    CHECK(radius[i].number().value() <= 1 + 1e-6);
    if (status[i] != "unstable") continue;
    seen = true;
    CHECK_THAT(reason[i].text(), Contains("energy that nothing gave") && Contains("spectrum does not see"));
  }
  CHECK(seen);
}

namespace {

/// Newmark's scheme, which after `honest` questions pushes away from where its elastic forces pull to: a free mass
/// tells nothing of it.
class Moody final : public TimeScheme {
 public:
  explicit Moody(const Registry& registry) : newmark_(registry.time("newmark")->make(newmark_parameters(registry))) {}
  static inline long long questions = 0, honest = 0;

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    PlanOrRefusal made = newmark_->plan(h, facts);
    if (++questions <= honest) return made;
    for (Stage& stage : std::get<StepPlan>(made).stages) stage.history.at(0).K *= -1;
    return made;
  }

 private:
  static Parameters newmark_parameters(const Registry& registry) {
    Parameters defaults;
    for (const ParameterSpec& spec : registry.manual(Role::time, "newmark")->parameters)
      if (spec.fallback) defaults.set(spec.key, *spec.fallback);
    return defaults;
  }
  std::unique_ptr<TimeScheme> newmark_;
};

}  // namespace

TEST_CASE("an integration that is not what its spectrum says, without contact, is an error of the method") {
  Json text = study_text("consistent", "none", {{"name", "newmark"}}, 1e-4, 1e-3, 3);
  Study study;
  Registry& registry = opened(text, study);
  if (!registry.time("moody"))
    registry.add_time({"moody", "A scheme.", "It changes its mind.", "none", {}},
                      [&](const Parameters&) { return std::make_unique<Moody>(registry); });
  text["methods"]["time"] = "moody";
  Moody::honest = 1000000;
  Moody::questions = 0;
  text["observe"] = false;
  CHECK_FALSE(run(text).measure("contradictions"));
  // The same questions first, then those of the marches.
  Moody::honest = Moody::questions;
  Moody::questions = 0;
  text["observe"] = true;
  const Result result = run(text);
  CHECK(result.record.status == Status::done);
  CHECK(*result.measure("largest_radius") == Approx(1).epsilon(1e-6));
  REQUIRE(result.measure("contradictions"));
  CHECK(*result.measure("contradictions") == 3);
  CHECK(result.noted("spectrum and march disagree without contact at 3 of 3 steps, first at h = 0.0001 s"));
  // A plan that carries a free mass grows ever less per step as h → 0: somewhere below it is not seen any more.
  CHECK((result.noted("open: unstable") || result.noted("open: observed up to h")));

  Moody::honest = 1000000;
  const Result sound = run(text);
  CHECK_FALSE(sound.measure("contradictions"));
  CHECK_FALSE(sound.noted("unstable at every step"));
}

TEST_CASE("oscillators and free masses have their cells") {
  for (const double stiffness : {0.0, 100.0}) {
    Json text = Json::parse(R"({
      "name": "ball", "kind": "stability",
      "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 0},
                "stops": {"lower": 0, "at": "tip"}, "load": -9.81,
                "initial": {"displacement": 1, "velocity": 0}},
      "methods": {"mass": "consistent", "contact": "signorini", "time": "moreau-jean"},
      "steps": {"from": 1e-3, "to": 1e-1, "count": 3}
    })");
    text["scene"]["structure"]["stiffness"] = stiffness;
    const Result result = run(text);
    CHECK(result.record.status == Status::done);
    for (const std::string contact : {"open", "closed"})
      for (const Cell& status : result.column("status", contact)) {
        INFO(stiffness << " " << contact);
        CHECK((status == "stable" || status == "marginal"));
      }
  }
}

TEST_CASE("what grows apart from the stops limits no closed stop") {
  // Central differences are stable up to 2/ω = 0.2 s; the rigid stop holds the one mass that there is.
  Json text = Json::parse(R"({
    "name": "held", "kind": "stability",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 100},
              "stops": {"lower": -0.1, "at": "tip"}, "initial": {"displacement": 0.05, "velocity": -2}},
    "mesh": {"elements": 1},
    "steps": {"from": 0.03, "to": 0.3, "count": 12}
  })");
  text["methods"] = {{"mass", "consistent"}, {"contact", "signorini"}, {"time", dumont_paoli(0)}};
  const Result result = run(text);
  StudyResults results;
  results.kind = "stability";
  results.cases = {result.record};
  const std::vector<LimitRow> rows = step_limit_rows(results);
  REQUIRE(rows.size() == 2);
  for (const LimitRow& row : rows) {
    INFO((row.closed ? "closed" : "open"));
    CHECK(row.prediction == (row.closed ? RangeLimit::none : RangeLimit::limit));
    if (!row.closed) CHECK(*row.predicted == Approx(0.2).epsilon(1e-6));
  }
}

TEST_CASE("a case stops when asked to, and at its budget") {
  const Json text = study_text("consistent", "signorini", dumont_paoli(0.5), 1e-7, 1e-2, 30);
  Study study;
  const Registry& registry = opened(text, study);
  const std::atomic<bool> stop = true;
  CHECK_THROWS_AS(run_stability(study.cases.front(), registry, stop), Interrupted);

  Json short_of_time = text;
  short_of_time["budget"] = 1e-3;
  const Result result = run(short_of_time);
  CHECK(result.record.status == Status::done);
  CHECK(result.noted("budget of 0.001 s"));
  CHECK(result.table("stability").rows.size() == 60);
  CHECK_THAT(result.column("reason", "closed").back().text(), Contains("budget"));
  for (const Cell& status : result.column("status", "closed")) CHECK_FALSE(status.text().empty());
}

TEST_CASE("a plan of a stability case counts its marches") {
  Study study;
  const Registry& registry = opened(study_text("consistent", "signorini", dumont_paoli(0.5), 1e-4, 1e-2, 3), study);
  const CasePlan plan = plan_stability(study.cases.front(), registry);
  CHECK(plan.refusal.empty());
  // Three free marches of 3000 steps, and 1 s at 1e-4, 1e-3 and 1e-2 (200 at least).
  CHECK(plan.steps == 9000 + 10000 + 1000 + 200);
  CHECK(plan.predicted_seconds > 0);
}

TEST_CASE("a plan says that a scene at rest shows nothing of contact") {
  const auto notes = [](const Json& text) {
    Study study;
    const Registry& registry = opened(text, study);
    std::string all;
    for (const std::string& note : plan_stability(study.cases.front(), registry).notes) all += note + "\n";
    return all;
  };
  Json text = study_text("consistent", "signorini", dumont_paoli(0.5), 1e-4, 1e-2, 3);
  CHECK_THAT(notes(text), !Contains("the scene is at rest"));
  text["scene"].erase("initial");
  CHECK_THAT(notes(text), Contains("closed: the scene is at rest"));
  text["scene"]["load"] = 1;
  CHECK_THAT(notes(text), !Contains("the scene is at rest"));
  text["scene"].erase("load");
  text["methods"]["contact"] = "none";
  CHECK_THAT(notes(text), !Contains("the scene is at rest"));
  // An oscillator may have a force of its own.
  Json pushed = study_text("consistent", "signorini", dumont_paoli(0.5), 1e-4, 1e-2, 3);
  pushed.erase("mesh");
  pushed["scene"].erase("initial");
  pushed["scene"]["structure"] = {{"type", "oscillator"}, {"mass", 1}, {"stiffness", 1}};
  CHECK_THAT(notes(pushed), Contains("closed: the scene is at rest"));
  pushed["scene"]["structure"]["force"] = {{"amplitude", 1}, {"pulsation", 2}};
  CHECK_THAT(notes(pushed), !Contains("the scene is at rest"));
}

TEST_CASE("a clearance that is closed holds what two stops across each other hold") {
  // A round beam: a side alone is a stop alone, and a corner holds both displacements.
  Json across = study_text("consistent", "signorini", dumont_paoli(0), 1e-4, 1e-2, 5);
  across["scene"]["structure"]["planes"] = 2;
  across["scene"].erase("initial");
  Json round = across;
  across["scene"]["stops"] = Json::parse(R"([{"name": "y", "at": {"x": 1}, "lower": -0.1, "upper": 0.1},
                      {"name": "z", "at": {"x": 1, "component": "uz"}, "lower": -0.1, "upper": 0.1}])");
  round["scene"]["stops"] =
      Json::parse(R"([{"name": "hole", "at": {"x": 1}, "clearance": {"radius": 0.1, "sides": 16}}])");
  const Result a = run(across), b = run(round);
  REQUIRE(b.record.status == Status::done);
  const std::vector<Cell> stops = a.column("radius", "closed"), hole = b.column("radius", "closed");
  REQUIRE(stops.size() == 5);
  REQUIRE(hole.size() == 5);
  for (std::size_t i = 0; i < 5; ++i)
    CHECK(hole[i].number().value() == Approx(stops[i].number().value()).epsilon(1e-6));  // roots of a double mode
  CHECK(b.column("limit_predicted", "closed").front().number().value() ==
        Approx(a.column("limit_predicted", "closed").front().number().value()).epsilon(1e-5));
}
