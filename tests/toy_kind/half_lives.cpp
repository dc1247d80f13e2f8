// A kind of study that the program does not have, in this file alone: it is registered, and runs from a study to a
// report.
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "runners/command/command.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/fields.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

namespace {

report::KindPage half_lives_page() {
  report::KindPage page;
  page.scripts = {
      R"js(ricochet.figure("half-lives", (data) => { window.drawnHalfLives = data.rows("halves"); return []; });)js"};
  page.tables = {"halves"};
  page.derived = {[](const Choices& choices) {
    Table out{"halves", "One row per case: when half is reached.", {{"case", "", ""}, {"after", "s", "Time."}}, {}};
    for (const CaseRecord* record : all_cases(choices.results()))
      if (const Table* own = find_table(record->tables, "half_lives"))
        out.rows.push_back({record->id, own->rows[0][1]});
    return out;
  }};
  page.answer = [](const Choices& choices) {
    const Table* halves = find_table(choices.results().derived, "halves");
    return "<p>Half is reached in " + std::to_string(halves ? halves->rows.size() : 0) + " cases.</p>\n";
  };
  return page;
}

StudyKind half_lives_format() {
  StudyKind format;
  format.name = "half-lives";
  format.text = "Each case is asked when its amplitude has fallen to given shares.";
  Field shares = keys::of_form(Field::Form::numbers, "shares", std::nullopt, "The shares, all different.");
  shares.spec = real_parameter("shares", "1", std::nullopt, {0, 1, true, true}, shares.spec.text);
  format.keys = {std::move(shares), keys::budget()};
  format.settings = [](const Json& resolved) { return given_settings(resolved, {"shares", "budget"}); };
  format.check = [](const Json& resolved) {
    if (resolved.at("scene").at("structure").at("type") != "oscillator")
      throw InputError("/scene/structure/type", "half-lives are those of an oscillator");
  };
  return format;
}

// How long the free oscillator takes to lose half of its amplitude, for several thresholds: t = ln(1/share)·2m/c.
class HalfLives final : public Kind {
 public:
  HalfLives()
      : Kind(half_lives_format(), {{"longest_half_life", "s", "Time after which the smallest share is reached."}}) {}
  CasePlan plan(const StudyCase&, const Registry&) const override { return {}; }
  CaseRunner start(const RunContext&) const override {
    CaseRunner runner;
    runner.run = [](const StudyCase& study_case, const std::atomic<bool>&) {
      const Json structure = study_case.scene_json.at("structure");
      const double decay = structure.at("damping").get<double>() / (2 * structure.at("mass").get<double>());
      CaseRecord record;
      record.id = study_case.id;
      record.axes = study_case.axes;
      record.status = Status::done;
      Table table{"half_lives",
                  "When the amplitude has fallen to each share.",
                  {{"share", "1", "Share of the first amplitude."}, {"after", "s", "Time after which it is reached."}},
                  {}};
      for (const Json& share : study_case.settings.at("shares")) {
        const double time = -std::log(share.get<double>()) / decay;
        table.rows.push_back({share.get<double>(), time});
        record.measures = {{"longest_half_life", time}};
      }
      record.tables.push_back(std::move(table));
      return record;
    };
    return runner;
  }
  std::string outcome(const CaseRecord& record) const override {
    return "the slowest takes " + std::to_string(*measure(record, "longest_half_life")) + " s";
  }
  Analysis analysis(StudyResults& results, const Choices&) const override {
    collect_tables(results);
    return {half_lives_page()};
  }
};

KindPointer half_lives() {
  return std::make_unique<HalfLives>();
}

const bool registered = (add_kind(half_lives()), true);

const char* const study_text = R"({"name": "toy", "kind": "half-lives", "shares": [0.5, 0.25],
  "scene": {"structure": {"type": "oscillator", "mass": 2.0, "stiffness": 8.0, "damping": [0.5, 1.0]}},
  "methods": {"mass": "consistent", "contact": "none", "time": "newmark"}})";

int command(const std::vector<std::string>& words, std::string& said) {
  std::ostringstream out, messages;
  const int code = run_command(words, out, messages);
  said = out.str() + messages.str();
  return code;
}

}  // namespace

TEST_CASE("a kind of study is one class: the program runs one that it has never seen, from the study to the report") {
  REQUIRE(registered);
  const ScratchFolder scratch;
  const auto file = scratch.path() / "toy.json", folder = scratch.path() / "results";
  write_text(file, study_text);
  std::string said;
  INFO(said);
  REQUIRE(command({"run", file.string(), "--out", folder.string()}, said) == 0);

  // t = 2m/c·ln 2 and ln 4, for c = 0.5 and 1.
  const std::string table = read_text(folder / "half_lives.csv");
  INFO(table);
  CHECK(table.find("share,after") != std::string::npos);
  CHECK(table.find("0.5,5.545177444479562") != std::string::npos);
  CHECK(table.find("0.25,5.545177444479562") != std::string::npos);
  CHECK(read_text(folder / "cases.csv").find("longest_half_life") != std::string::npos);
  CHECK(std::filesystem::exists(folder / "report.html"));
  const std::string page = read_text(folder / "report.html");
  CHECK(page.find("half-lives") != std::string::npos);
  CHECK(page.find("Half is reached in 2 cases.") != std::string::npos);
  CHECK(page.find("window.drawnHalfLives") != std::string::npos);
  CHECK(page.find("\"halves\":{\"columns\"") != std::string::npos);
  CHECK(read_text(folder / "halves.csv").find("after") != std::string::npos);
  CHECK(read_text(folder / "dictionary.csv").find("halves,after,s,Time.") != std::string::npos);

  REQUIRE(command({"report", folder.string()}, said) == 0);
  REQUIRE(command({"export", folder.string(), "--to", (scratch.path() / "export").string()}, said) == 0);
  CHECK(read_text(scratch.path() / "export" / "measures.csv").find("longest_half_life,s,") != std::string::npos);
}

TEST_CASE("a registered kind is in the schema, in the names that are offered, and checks its own keys") {
  const ScratchFolder scratch;
  const auto refusal = [&](std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    const auto file = scratch.path() / "wrong.json";
    write_text(file, text);
    std::string said;
    CHECK(command({"plan", file.string()}, said) == 2);
    return said;
  };
  CHECK(refusal(study_text, "half-lives", "half-life").find("did you mean \"half-lives\"") != std::string::npos);
  CHECK(refusal(study_text, "0.25", "2").find("/shares") != std::string::npos);
  CHECK(refusal(study_text, "\"shares\": [0.5, 0.25],", "").find("/shares: missing") != std::string::npos);
  std::string schema;
  CHECK(command({"schema"}, schema) == 0);
  CHECK(schema.find("half-lives") != std::string::npos);
  CHECK(schema.find("The shares, all different.") != std::string::npos);
  CHECK_THROWS_AS(add_kind(half_lives()), std::logic_error);
}

TEST_CASE("a table whose column is called like an axis is refused, not mixed with it") {
  StudyResults results;
  results.columns = {"time"};
  results.cases.resize(1);
  results.cases[0].tables = {{"half_lives", "", {{"time", "s", ""}}, {{1.0}}}};
  CHECK_THROWS_WITH(collect_tables(results), Catch::Contains("half_lives") && Catch::Contains("\"time\""));
}
