// report --compare: what it says of two results is what their tables say.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tests/runners/command/page_tables.hpp"
#include "tests/runners/command/spoken_command.hpp"

namespace command_tests {
namespace {

using ricochet::tests::CsvTable;
using Rows = std::vector<std::map<std::string, std::string>>;

Rows rows_of(const fs::path& file) {
  const CsvTable table = ricochet::tests::read_csv(read(file));
  Rows out;
  for (const auto& cells : table.rows) {
    auto& row = out.emplace_back();
    for (std::size_t c = 0; c < table.columns.size(); ++c) row[table.columns[c]] = cells[c];
  }
  return out;
}

/// A tube between stops: two masses, two laws, three steps down from `step`.
void run_tube(const Folder& here, const std::string& out, double step) {
  nlohmann::ordered_json study = tiny();
  study["ask"] = {{{"effect", "contact"}, {"on", "dissipated_at_contact"}, {"from", "10 %"}},
                  {{"value", "tip_displacement_end"}}};
  study["methods"] = {{"mass", {"consistent", "singular"}},
                      {"contact", {"signorini", {{"name", "penalty"}, {"stiffness", 1e5}}}},
                      {"time", "newmark-dumont-paoli"}};
  study["step"] = {step, step / 2, step / 4};
  study["duration"] = 0.2;
  here.write(out + ".json", study.dump());
  const Outcome run = here.run("run " + out + ".json --out " + out);
  INFO(run.out << run.err);
  REQUIRE(run.code == 0);
}

std::optional<double> number(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(std::stod(text));
}

/// What a page must say of two rows of limits.csv.
std::string expected_change(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
  if (a.at("value") == b.at("value") && a.at("low") == b.at("low") && a.at("high") == b.at("high")) return "equal";
  if (a.at("u").empty() || b.at("u").empty()) return "no interval";
  const auto low_a = number(a.at("low")), high_a = number(a.at("high")), low_b = number(b.at("low")),
             high_b = number(b.at("high"));
  if (!low_a || !high_a || !low_b || !high_b) return "no interval";
  return *low_a > *high_b || *low_b > *high_a ? "changed" : "within u";
}

}  // namespace

TEST_CASE("report --compare: a result and its copy are equal in every value") {
  const Folder here;
  run_tube(here, "one", 4e-4);
  fs::copy(here / "one", here / "copy", fs::copy_options::recursive);
  const Outcome said = here.run("report --compare one copy");
  INFO(said.out << said.err);
  CHECK(said.code == 0);
  CHECK_THAT(said.out, Contains("inputs: the same") && Contains("environment: the same") &&
                           Contains("asks: 2 of 2 with the same answer") &&
                           Contains("Nothing changed: every value is equal."));
  const Rows rows = rows_of(here / "comparison.csv");
  CHECK(rows.size() > 12);
  for (const auto& row : rows) CHECK(row.at("change") == "equal");
  CHECK_THAT(read(here / "comparison.html"), Contains("Nothing changed") && !Contains("<script"));
  // So is what comes out of a pack.
  REQUIRE(here.run("pack one --out one.zip").code == 0);
  CHECK_THAT(here.run("report --compare one.zip copy --out packed.html").out, Contains("every value is equal"));
  CHECK(read(here / "packed.csv") == read(here / "comparison.csv"));
}

TEST_CASE("report --compare: other steps change what their tables have differently, and nothing else") {
  const Folder here;
  run_tube(here, "coarse", 4e-4);
  run_tube(here, "fine", 1e-4);
  const Outcome said = here.run("report --compare coarse fine --json");
  INFO(said.err);
  REQUIRE(said.code == 0);
  const auto json = nlohmann::json::parse(said.out);
  const auto of_method = [](const std::map<std::string, std::string>& row) {
    return row.at("measure") + "|" + row.at("method");
  };
  std::map<std::string, std::map<std::string, std::string>> a, b;
  for (const auto& row : rows_of(here / "coarse/limits.csv")) a[of_method(row)] = row;
  for (const auto& row : rows_of(here / "fine/limits.csv")) b[of_method(row)] = row;
  std::map<std::string, std::size_t> counts;
  std::size_t compared = 0, facts = 0;
  const Rows rows = rows_of(here / "comparison.csv");
  // What both ask the value of is told by these asks alone.
  std::set<std::string> asked;
  for (const auto& row : rows)
    if (row.at("table") == "verdicts" && row.at("of").starts_with("{\"value\"")) asked.insert(row.at("measure"));
  for (const auto& row : rows) {
    facts += row.at("table") == "study" && row.at("of").starts_with("/step/");
    if (row.at("change") != "differs") ++counts[row.at("change")];
    if (row.at("table") != "limits") continue;
    ++compared;
    const std::string key = row.at("measure") + "|" + row.at("level");
    CAPTURE(key);
    REQUIRE(a.contains(key));
    REQUIRE(b.contains(key));
    CHECK(row.at("a") == a[key]["value"]);
    CHECK(row.at("b") == b[key]["value"]);
    CHECK(row.at("change") == expected_change(a[key], b[key]));
    if (row.at("u").empty()) continue;
    CHECK((std::abs(std::stod(row.at("difference"))) > std::stod(row.at("u"))) == (row.at("change") == "changed"));
  }
  const auto told =
      std::count_if(a.begin(), a.end(), [&](const auto& one) { return asked.contains(one.second.at("measure")); });
  CHECK(compared > 0);
  CHECK(compared + static_cast<std::size_t>(told) == a.size());
  CHECK(facts == 3);
  for (const auto& [word, count] : json.at("counts").items()) CHECK(counts[word] == count);
  CHECK(counts["within u"] + counts["changed"] > 0);
  CHECK(json.at("rows").size() == rows_of(here / "comparison.csv").size());

  // What no interval is known of is never said to have changed: a single step leaves none.
  nlohmann::ordered_json study = tiny();
  for (const char* out : {"left", "right"}) {
    study["step"] = {out == std::string("left") ? 1e-4 : 5e-5};
    here.write("single.json", study.dump());
    REQUIRE(here.run("run single.json --out " + std::string(out)).code == 0);
  }
  REQUIRE(here.run("report --compare left right --out single.html").code == 0);
  std::size_t bare = 0;
  for (const auto& row : rows_of(here / "single.csv"))
    if (row.at("table") == "limits" || row.at("of").starts_with("{\"value\"")) {
      CHECK((row.at("change") == "no interval" || row.at("change") == "equal"));
      bare += row.at("change") == "no interval";
    }
  CHECK(bare > 0);
}

TEST_CASE("report --compare: one method is one, whatever tells it from others of its own study") {
  const Folder here;
  nlohmann::ordered_json study = tiny();
  study["ask"] = {{{"value", "tip_displacement_end"}}};
  study["step"] = {4e-4, 2e-4, 1e-4};
  study["duration"] = 0.2;
  study["methods"] = {{"mass", "consistent"}, {"contact", "signorini"}};
  const nlohmann::ordered_json half = {{"name", "newmark-dumont-paoli"}, {"beta", 0.5}},
                               quarter = {{"name", "newmark-dumont-paoli"}, {"beta", 0.25}};
  for (const auto& [out, other] :
       {std::pair<std::string, nlohmann::ordered_json>("one", "moreau-jean"), {"two", quarter}}) {
    study["methods"]["time"] = {half, other};
    here.write("study.json", study.dump());
    REQUIRE(here.run("run study.json --out " + out).code == 0);
  }
  const Outcome said = here.run("report --compare one two");
  INFO(said.out << said.err);
  REQUIRE(said.code == 0);
  std::map<std::string, std::size_t> changes;
  for (const auto& row : rows_of(here / "comparison.csv"))
    if (row.at("table") == "verdicts") ++changes[row.at("change")];
  CHECK(changes["equal"] == 1);
  CHECK(changes["only in A"] == 1);
  CHECK(changes["only in B"] == 1);
}

TEST_CASE("report --compare: what is no pair of results of one kind is told in a sentence") {
  const Folder here;
  nlohmann::ordered_json study = tiny();
  here.write("tiny.json", study.dump());
  REQUIRE(here.run("run tiny.json --out tiny").code == 0);
  study["kind"] = "convergence";
  study["reference"] = "self";
  study["step"] = {1e-4, 5e-5};
  here.write("other.json", study.dump());
  const Outcome other = here.run("run other.json --out other");
  INFO(other.out << other.err);
  REQUIRE(fs::exists(here / "other/results.sqlite"));
  fs::create_directory(here / "empty");
  for (const auto& [words, cause] : std::vector<std::pair<std::string, std::string>>{
           {"tiny", "--compare is for two results; one was given"},
           {"tiny other tiny", "--compare is for two results; more were given"},
           {"tiny nowhere", "nowhere: there is no such folder or packed result"},
           {"empty tiny", "empty: holds no results.sqlite; expected a folder of results"},
           {"tiny tiny.json", "tiny.json: no whole zip file"},
           {"tiny ./empty/../tiny", "./empty/../tiny: is the same result; expected another one"},
           {"tiny other", "tiny is of kind trajectory and other of kind convergence; expected two results of one kind"},
           {"tiny other --figures x", "--figures is for one folder; --compare has two"}}) {
    const Outcome outcome = here.run("report --compare " + words);
    INFO(words << "\n" << outcome.out << outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, StartsWith("ricochet: " + cause));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  }
  CHECK_FALSE(fs::exists(here / "comparison.html"));
}

TEST_CASE("report --compare: motions of a sweep are compared orbit by orbit at the finest step") {
  const Folder here;
  const auto sweep = [&](const std::string& out, double stop, double pulsation) {
    auto study = nlohmann::ordered_json::parse(R"json({
      "name": "swept", "question": "Which motions?", "ask": [{"motions": "support.amplitude"}], "kind": "bifurcation",
      "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.1},
                "stops": {"at": "tip"}, "support": {"amplitude": 0.1}},
      "methods": {"mass": "consistent", "contact": "signorini",
                  "time": {"name": "newmark-dumont-paoli", "restitution": 0.7}},
      "parameter": {"pointer": "/scene/support/amplitude", "from": 0.05, "to": 0.35, "count": 4},
      "steps_per_period": [100, 200], "transient": {"periods": 60, "at_most": 120}, "keep": 64})json");
    study["scene"]["stops"]["upper"] = stop;
    study["scene"]["support"]["pulsation"] = pulsation;
    here.write(out + ".json", study.dump());
    REQUIRE(here.run("run " + out + ".json --out " + out).code == 0);
  };
  sweep("one", 0.2, 1.2);
  sweep("other", 0.05, 2.8);
  fs::copy(here / "one", here / "copy", fs::copy_options::recursive);
  CHECK_THAT(here.run("report --compare one copy").out, Contains("Nothing changed"));
  const Outcome said = here.run("report --compare one other");
  REQUIRE(said.code == 0);
  const auto motions = [&](const std::string& folder) {
    std::map<std::string, std::string> out;
    for (const auto& row : rows_of(here / (folder + "/values.csv")))
      if (row.at("steps_per_period") == "200")
        out[row.at("parameter") + row.at("start")] =
            row.at("class") + (row.at("class") == "periodic" ? row.at("period") : "");
    return out;
  };
  const auto a = motions("one"), b = motions("other");
  REQUIRE(a.size() == b.size());
  std::map<std::string, std::size_t> expected, found;
  for (const auto& [place, motion] : a) {
    const std::string& other = b.at(place);
    ++expected[motion == other ? "equal" : motion == "undecided" || other == "undecided" ? "no interval" : "changed"];
  }
  for (const auto& row : rows_of(here / "comparison.csv"))
    if (row.at("table") == "verdicts") ++found[row.at("change")];
  CHECK(found == expected);
  CHECK(expected["changed"] > 0);
  CHECK_THAT(said.out,
             Contains(fmt::format("The motion of {} of {} orbits is another one", expected["changed"], a.size())));
}

}  // namespace command_tests
