// What a case of kind `bifurcation` leaves: starts, classes, exponents, sections, refinement, and rows for what went
// wrong.
#include <set>

#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "runners/kinds/sweep/diagram_tables.hpp"
#include "tests/runners/kinds/sweep/sweep_case.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

std::vector<double> sections(const CaseRecord& record, std::size_t start) {
  const NumberTable& points = numbers_of(record, "points");
  std::vector<double> found;
  for (std::size_t i = 0; i < points.rows(); ++i)
    if (column_of(points, "start")[i] == static_cast<double>(start))
      found.push_back(column_of(points, "tip_displacement")[i]);
  return found;
}

// What a case found, as bytes: how many steps it took is not part of them.
std::string tables_of(CaseRecord record) {
  record.steps = 0;
  return bits_of(record);
}

}  // namespace

TEST_CASE("bifurcation: neither workers nor the number of exponents asked for change an orbit") {
  Json text = beam_sweep({0.05, 0.08, 0.086, 0.09});
  const CaseRecord one = run_sweep(text), three = run_sweep(text, 3);
  REQUIRE(one.status == Status::done);
  CHECK(bits_of(one) == bits_of(three));
  text["exponents"] = 2;
  const CaseRecord measured = run_sweep(text, 2);
  CHECK(column_of(numbers_of(one, "points"), "tip_velocity") ==
        column_of(numbers_of(measured, "points"), "tip_velocity"));
}

TEST_CASE("bifurcation: a start beyond a stop is for the laws that push it back, and costs the others their rows") {
  Json text = oscillator_sweep({2.0, 2.4}, 0.5);
  text["scene"]["stops"] = {{"lower", 0.01}, {"at", "tip"}};
  text["transient"] = {{"periods", 5}, {"at_most", 10}};
  const Json rigid = "signorini", spring = {{"name", "penalty"}, {"stiffness", 100}};
  text["methods"]["time"] = "newmark-dumont-paoli";
  text["methods"]["contact"] = GENERATE_COPY(Json::array({rigid, spring}), Json::array({spring, rigid}));
  const OpenedSweep opened = opened_sweep(text);
  REQUIRE(opened.study.cases.size() == 2);
  const std::atomic<bool> stop = false;
  for (const StudyCase& one : opened.study.cases) {
    const CaseRecord record = run_bifurcation(one, *opened.registry, {}, stop);
    INFO(record.reason());
    CHECK(record.status == (one.contact.name == "penalty" ? Status::done : Status::refused));
    if (record.status == Status::refused)
      CHECK_THAT(record.reason(), Catch::Matchers::Contains("beyond the lower stop at 0.01 m") &&
                                      Catch::Matchers::Contains("a compliant law"));
  }
}

TEST_CASE("bifurcation: what was stored and is damaged is marched again, bitwise equal") {
  Json text = beam_sweep({0.05, 0.08, 0.086}, Json::array({"rest", "up"}));
  text["exponents"] = 1;
  const std::string wanted = tables_of(run_sweep(text));
  const OpenedSweep opened = opened_sweep(text);
  std::map<std::string, std::string> kept;
  std::atomic<bool> stop = false;
  int saves = 0;
  CaseContext context;
  context.key = "key";
  context.checkpoints.find = [&](const std::string& key) { return kept.contains(key) ? kept.at(key) : std::string(); };
  context.checkpoints.keep = [&](const std::string& key, const std::string& bytes) {
    bytes.empty() ? void(kept.erase(key)) : void(kept[key] = bytes);
    if (++saves % 3 == 0) stop = true;  // orbits, those on their way, exponents
  };
  std::size_t damaged = 0;
  for (int interruptions = 0;; ++interruptions) {
    REQUIRE(interruptions < 20);
    stop = false;
    try {
      const CaseRecord record = run_bifurcation(opened.first(), *opened.registry, context, stop);
      CHECK((tables_of(record) == wanted));
      break;
    } catch (const Interrupted&) {
    }
    if (interruptions % 2 == 1) continue;
    for (auto& [key, bytes] : kept) bytes.pop_back();
    damaged += kept.size();
  }
  CHECK(damaged > 2);
  CHECK(kept.empty());
}

TEST_CASE("bifurcation: rest is rest whatever the scene says, and the scene's own state is another start") {
  Json text = beam_sweep({0.07}, Json::array({"rest", "state"}));
  text["scene"]["initial"] = {{"displacement", "0.02*x^2"}};
  text["transient"] = {{"periods", 1}, {"at_most", 1}};
  const CaseRecord with = run_sweep(text);
  text["start"] = {"rest"};
  text["scene"].erase("initial");
  const CaseRecord without = run_sweep(text);
  CHECK(sections(with, 0) == sections(without, 0));
  CHECK(sections(with, 1) != sections(without, 0));
}

TEST_CASE("bifurcation: where there is one attractor, up, down and rest end on it") {
  // Heavily damped and never in contact: the linear response is the only motion.
  Json text = beam_sweep({0.01, 0.02, 0.03}, Json::array({"rest", "up", "down"}));
  text["scene"]["structure"]["damping"]["stiffness"] = 0.02;
  const CaseRecord record = run_sweep(text);
  for (const Cell& name : of_values(record, "class")) CHECK(name == "no contact");
  const auto rest = sections(record, 0), up = sections(record, 1), down = sections(record, 2);
  REQUIRE(rest.size() == 48);
  // Free motion falls by e^(−αω₁²T/2) = 0.013 per period.
  for (std::size_t i = 0; i < rest.size(); ++i) {
    CHECK(up[i] == Approx(rest[i]).margin(1e-12));
    CHECK(down[i] == Approx(rest[i]).margin(1e-12));
  }
}

TEST_CASE("bifurcation: exponents of the motion without contact are those of the structure's damping") {
  Json text = beam_sweep({0.01});
  text["scene"]["structure"]["damping"] = {{"stiffness", 1e-3}, {"mass", 0.5}};
  text["exponents"] = 2;
  const CaseRecord record = run_sweep(text);
  // The slowest mode decays with αω₁²/2 + η/2, ω₁ = 26.2445 rad/s; h and four elements move that by less than 1 %.
  const double decay = -(1e-3 * 26.2445 * 26.2445 / 2 + 0.25);
  CHECK(of_values(record, "exponent_1")[0].number().value() == Approx(decay).epsilon(0.01));
  // A complex pair has one exponent.
  CHECK(of_values(record, "exponent_1")[0] == of_values(record, "exponent_2")[0]);
  CHECK(of_values(record, "exponent_method")[0] == "tangent");
  CHECK(of_values(record, "exponent_twin")[0].number().value() == Approx(decay).epsilon(0.2));
}

TEST_CASE("bifurcation: a scheme's own root is named and takes no part in the class") {
  Json text = beam_sweep({0.08, 0.086, 0.099});
  text["exponents"] = 1;
  text["steps_per_period"] = 2000;  // at a tenth of these β = ¼ shows other motions
  text["transient"] = {{"periods", 60}, {"at_most", 120}};
  const CaseRecord half = run_sweep(text);
  text["methods"]["time"]["beta"] = 0.25;
  const CaseRecord quarter = run_sweep(text);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(of_values(half, "marginal")[i] == "");
    CHECK(of_values(quarter, "marginal")[i].text().find("root −1") != std::string::npos);
    CHECK(of_values(quarter, "class")[i] == of_values(half, "class")[i]);
    CHECK(of_values(quarter, "period")[i] == of_values(half, "period")[i]);
    CHECK(of_values(quarter, "exponent_1")[i].number().value() < -0.05);
  }
}

TEST_CASE("bifurcation: impacts with inertia say that their jump was put on") {
  Json text = oscillator_sweep({2.2}, 0.8);
  text["exponents"] = 2;
  const CaseRecord record = run_sweep(text);
  CHECK(of_values(record, "exponent_method")[0] == "tangent+jump");
  // ζ = 0.1: both exponents are −ζ + ln(e)/T, one impact per period.
  REQUIRE(of_values(record, "impacts_per_period")[0] == 1.0);
  const double sum =
      of_values(record, "exponent_1")[0].number().value() + of_values(record, "exponent_2")[0].number().value();
  CHECK(sum / 2 == Approx(-0.1 + std::log(0.8) * 2.2 / (2 * 3.14159265358979)).margin(2e-3));
}

TEST_CASE("bifurcation: no exponent where it would miss how impacts move, and the case says why") {
  Json text = beam_sweep({0.02, 0.09});
  text["methods"]["mass"] = "consistent";
  text["exponents"] = 1;
  text["methods"]["time"] = "newmark-dumont-paoli";
  for (const Cell& one : of_values(run_sweep(text), "exponent_1")) CHECK(one.number());
  text["methods"]["time"] = "moreau-jean";
  const CaseRecord record = run_sweep(text);
  // The first one swings freely: nothing is missed there.
  REQUIRE(of_values(record, "impacts_per_period")[0] == 0.0);
  CHECK(of_values(record, "exponent_1")[0].number());
  REQUIRE(of_values(record, "impacts_per_period")[1].number().value() > 1);
  CHECK_FALSE(of_values(record, "exponent_1")[1].number());
  CHECK_FALSE(of_values(record, "exponent_twin")[1].number());
  CHECK(of_values(record, "exponent_method")[1] == "");
  CHECK(std::any_of(record.notes.begin(), record.notes.end(), [](const std::string& note) {
    return note.starts_with("no exponents of 1 orbit with impacts: ");
  }));
  // Told before anything runs, too.
  const OpenedSweep opened = opened_sweep(text);
  const std::vector<std::string> planned = plan_bifurcation(opened.first(), *opened.registry).notes;
  CHECK(std::any_of(planned.begin(), planned.end(),
                    [](const std::string& note) { return note.starts_with("no exponents of orbits with impacts: "); }));
}

TEST_CASE("bifurcation: an impact says where the point is that closes") {
  Json text = beam_sweep({0.09});
  text["scene"]["stops"] = {{"lower", "x<1 ? -0.04 : -0.5"}, {"upper", "x<1 ? 0.04 : 0.1"}, {"at", {0.75, 1.501}}};
  const CaseRecord record = run_sweep(text);
  const NumberTable& impacts = numbers_of(record, "impacts");
  REQUIRE(impacts.rows() >= 4);
  std::set<double> places;
  for (std::size_t i = 0; i < impacts.rows(); ++i) {
    const double x = column_of(impacts, "x")[i];
    places.insert(x);
    if (column_of(impacts, "side")[i] == 0) CHECK(x == 0.75);  // the tip has no stop below that it reaches
  }
  CHECK(places.contains(0.75));
  CHECK(places.size() <= 2);
}

TEST_CASE("bifurcation: the step follows the forcing period") {
  Json text = oscillator_sweep({1.7, 2.2, 2.9}, 0.5);
  const CaseRecord record = run_sweep(text);
  for (const Cell& status : of_values(record, "status")) CHECK(status == "done");
  const NumberTable& portraits = numbers_of(record, "portraits");
  for (const double omega : {1.7, 2.2, 2.9}) {
    double last = 0;
    for (std::size_t i = 0; i < portraits.rows(); ++i)
      if (column_of(portraits, "parameter")[i] == omega) last = column_of(portraits, "time")[i];
    const double periods = last * omega / (2 * 3.14159265358979);
    CHECK(std::abs(periods - std::round(periods)) < 0.05);
  }
}

TEST_CASE("bifurcation: sections lie where they are said to") {
  Json text = beam_sweep({0.086});
  SECTION("at an impact the tip is at a stop") {
    text["section"] = "impact";
    const CaseRecord record = run_sweep(text);
    const auto points = sections(record, 0);
    REQUIRE_FALSE(points.empty());
    for (const double x : points) CHECK(std::abs(x) == Approx(0.1).margin(0.01));  // a step before it closes
  }
  SECTION("at an extremum the tip stands still") {
    text["section"] = "extremum";
    const CaseRecord record = run_sweep(text);
    const NumberTable& points = numbers_of(record, "points");
    REQUIRE(points.rows() > 0);
    // Within a step of the turn, whose velocity a contact may change by its speed.
    for (const double v : column_of(points, "tip_velocity")) CHECK(std::abs(v) < 2.5);
  }
}

TEST_CASE("bifurcation: changes of class are bracketed down to the tolerance") {
  Json text = beam_sweep({0.03, 0.06, 0.09});
  text["refine"] = 1e-3;
  const CaseRecord record = run_sweep(text);
  const auto values = of_values(record, "parameter");
  CHECK(values.size() > 3);
  for (std::size_t i = 1; i < values.size(); ++i) CHECK(values[i - 1].number().value() < values[i].number().value());
  const Table& changes = table_of(record, "bifurcations");
  bool grazing = false;
  for (std::size_t i = 0; i < changes.rows.size(); ++i) {
    const double low = column_of(changes, "low")[i].number().value(),
                 high = column_of(changes, "high")[i].number().value();
    const bool began = column_of(changes, "from")[i] == "no contact" && column_of(changes, "start")[i] == "rest";
    if (began) CHECK(high - low <= 1e-3);
    // α = 1e-3 and four elements move the undamped 0.0791792 by far less.
    if (column_of(changes, "start")[i] != "open orbit") continue;
    grazing = true;
    CHECK(column_of(changes, "value")[i].number().value() == Approx(0.0791792098).epsilon(2e-3));
  }
  CHECK(grazing);
}

TEST_CASE("bifurcation: a chain changes where its own motion does, not where a jump of the parameter throws it") {
  // A motion with impacts exists beside the one without from 0.775 N on; that first touches the stop at d |k − mω² +
  // icω|.
  Json text = oscillator_sweep({0.2}, 0);
  text["scene"]["structure"] = Json::parse(R"({"type": "oscillator", "mass": 0.2, "stiffness": 80, "damping": 0.5,
                                                "force": {"amplitude": 1, "pulsation": 28}})");
  text["scene"].erase("support");
  text["scene"]["stops"] = {{"upper", 0.01}, {"at", "tip"}};
  text["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 4000}};
  text["methods"]["time"] = {{"name", "newmark"}, {"beta", 0.25}, {"gamma", 0.5}};
  text["parameter"] = {{"pointer", "/scene/structure/force/amplitude"}, {"from", 0.2}, {"to", 0.9}, {"count", 15}};
  text["steps_per_period"] = 400;
  text["start"] = {"up"};
  text["transient"] = {{"periods", 150}, {"at_most", 300}};
  text["refine"] = 2e-4;
  const CaseRecord record = run_sweep(text);
  INFO(record.reason());
  REQUIRE(record.status == Status::done);
  const double touches = 0.01 * std::hypot(80 - 0.2 * 28 * 28, 0.5 * 28);
  std::size_t changes = 0;
  for (const ChangeRow& row : changes_of(record)) {
    if (row.start != "up" || row.from != "no contact") continue;
    ++changes;
    // 400 steps of a period have the amplitude to (ωh)²/24, 1e-5.
    CHECK(row.low <= touches * (1 + 1e-4));
    CHECK(row.high >= touches * (1 - 1e-4));
    CHECK(row.high - row.low <= 2e-4);
  }
  CHECK(changes == 1);
}

TEST_CASE("bifurcation: the load at which a mass leaves its stop is bracketed, below it nothing strikes") {
  // Weight 1 N, the force a cos ωt lifts from a = 1 on.
  Json text = oscillator_sweep({0.8, 0.9, 1, 1.1, 1.2}, GENERATE(0.0, 0.5));
  text["scene"] = Json::parse(R"({
    "structure": {"type": "oscillator", "mass": 1, "stiffness": 0, "force": {"amplitude": 1, "pulsation": 6.283185307179586}},
    "load": [{"force": -1}], "stops": {"lower": 0, "at": "tip"}})");
  text["parameter"]["pointer"] = "/scene/structure/force/amplitude";
  text["start"] = Json::array({"rest", "up"});
  text["refine"] = 2e-3;
  const CaseRecord record = run_sweep(text);
  for (std::size_t i = 0; i < of_values(record, "class").size(); ++i) {
    const bool held = of_values(record, "parameter")[i].number().value() <= 1;
    CHECK((of_values(record, "class")[i] == "at rest") == held);
    CHECK((of_values(record, "impacts_per_period")[i].number() == 0.0) == held);
  }
  const Table& changes = table_of(record, "bifurcations");
  int lifts = 0;
  for (std::size_t i = 0; i < changes.rows.size(); ++i) {
    if (!(column_of(changes, "kind")[i] == "lift-off")) continue;
    ++lifts;
    CHECK(column_of(changes, "from")[i] == "at rest");
    const double low = column_of(changes, "low")[i].number().value(),
                 high = column_of(changes, "high")[i].number().value();
    CHECK(low <= 1);
    CHECK(high > 1);
    CHECK(high - low <= 2e-3);
  }
  CHECK(lifts == 2);
}

TEST_CASE("bifurcation: what cannot be marched is a row with its reason") {
  Json text = beam_sweep({0.08, 0.15});
  text["scene"]["stops"]["at"] = "nodes";
  const CaseRecord record = run_sweep(text);  // 0.15 pushes the clamp's neighbourhood through the stops
  CHECK(record.status == Status::done);
  CHECK(of_values(record, "status")[0] == "done");
  CHECK(of_values(record, "status")[1] == "refused");
  CHECK_FALSE(of_values(record, "reason")[1].text().empty());
  text["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 1e9}, {"evaluation", "explicit"}};
  text["parameter"]["values"] = {0.08, 0.09};
  const CaseRecord wild = run_sweep(text);
  CHECK(wild.status == Status::diverged);
  for (const Cell& status : of_values(wild, "status")) CHECK(status == "diverged");
}

TEST_CASE("bifurcation: two orbits that differ by where the step places their impacts are one motion") {
  // A mass shaken above its resonance, stopped on one side: it hits once a period, or stays away from the stop.
  Json text = oscillator_sweep({8.1, 8.2, 8.3, 9, 9.5, 10, 10.5, 11, 11.5, 12, 12.5, 13}, 0.7);
  text["scene"]["structure"] = {{"type", "oscillator"}, {"mass", 1}, {"stiffness", 25}, {"damping", 0.2}};
  text["scene"]["support"] = {{"amplitude", 0.02}, {"pulsation", 8}};
  text["scene"]["stops"] = {{"upper", 0.02}, {"at", "tip"}};
  text["parameter"]["pointer"] = "/scene/support/pulsation";
  text["methods"]["time"] = {{"name", "moreau-jean"}, {"restitution", 0.7}};
  text["steps_per_period"] = 2000;
  text["start"] = {"rest", "up", "down"};
  for (const int exponents : {0, 1}) {
    CAPTURE(exponents);
    text["exponents"] = exponents;
    StudyResults results;
    results.kind = "bifurcation";
    results.study = text;
    results.cases.push_back(run_sweep(text));
    const CaseRecord& record = results.cases.front();
    dynamics::StudyDiagram study = dynamics::read_diagram(results);
    dynamics::find_attractors(study);
    double apart = 0;
    constexpr int coexist = 3;  // values at which both motions are met
    for (int value = 0; value < coexist; ++value) {
      const DiagramRun &rest = *study.diagram.run(0, value, 0), &up = *study.diagram.run(0, value, 1);
      CHECK(rest.motion == MotionClass{Regime::periodic, 1});
      CHECK(rest.attractor == up.attractor);
      CHECK(study.diagram.run(0, value, 2)->motion == MotionClass{Regime::no_contact});
      // The speed of 0.4 m/s turns round within a step of 4e-4 s.
      CHECK(rest.open > 2e-4);
      apart =
          std::max(apart, cloud_distance(settled_section(study, 0, rest).cloud, settled_section(study, 0, up).cloud));
    }
    CHECK(study.diagram.attractors == 2);
    // They are further apart than what settling leaves: without that the test says nothing.
    CHECK(apart > kSameRun.cycle);
    CHECK(record.status == Status::done);
  }
}
