#include "runners/store/record_values.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "runners/table/text.hpp"
#include "tests/runners/store/sample_results.hpp"

using namespace ricochet;

namespace {

/// A reader after RFC 4180, written apart from the writer: lines of fields.
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> lines = {{""}};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"')
        lines.back().back() += c;
      else if (i + 1 < text.size() && text[i + 1] == '"')
        lines.back().back() += text[i++];
      else
        quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      lines.back().emplace_back();
    } else if (c == '\n') {
      lines.push_back({""});
    } else {
      lines.back().back() += c;
    }
  }
  lines.pop_back();
  return lines;
}

}  // namespace

TEST_CASE("records: a value of an axis is a cell") {
  CHECK(cell_of("P1") == "P1");
  CHECK(csv_cell(cell_of("0.1,x")) == "\"0.1,x\"");
  CHECK(csv_cell(cell_of(1e-05)) == "1e-05");
  CHECK(csv_cell(cell_of(50)) == "50");
  CHECK(csv_cell(cell_of(true)) == "true");
  CHECK(cell_of(nullptr).is_nothing());
  CHECK(csv_cell(cell_of({0.5, 1.0})) == "\"[0.5,1.0]\"");
  for (const nlohmann::ordered_json& value : std::vector<nlohmann::ordered_json>{nullptr, true, 7, 1.5, "a \"b\""})
    CHECK(json_of(cell_of(value)) == value);
}

TEST_CASE("records: cases have case, axes, status, reason, steps, times, then every measure") {
  const auto lines = parse_csv(table_csv(cases_table(sample_results())));
  REQUIRE(lines.size() == 3);
  const std::vector<std::string> first(lines[0].begin(), lines[0].begin() + 10);
  CHECK(first == std::vector<std::string>{"case", "mass", "mass.velocity", "step", "status", "reason", "steps",
                                          "setup_seconds", "run_seconds", "scheme_energy_start"});
  CHECK(lines[0].size() == 9 + standing_measures("trajectory").size());
  CHECK(lines[1].size() == lines[0].size());
  CHECK(lines[2].size() == lines[0].size());
  CHECK(lines[1][4] == "done");
  CHECK(lines[2][2] == "");  // a refused case without that parameter: the column is there, the value is not
  CHECK(lines[2][5] == "β = 0 leaves S \"singular\",\nuse β ≥ 1/4");
  for (std::size_t i = 0; i < lines[0].size(); ++i)
    if (lines[0][i] == "energy_start") CHECK(std::strtod(lines[1][i].c_str(), nullptr) == 1.0 / 3.0);
}

TEST_CASE("records: a measure that the list does not know gets a column too") {
  StudyResults results = sample_results();
  results.cases[1].measures = {{"error_tip", 2.0}};
  const auto lines = parse_csv(table_csv(cases_table(results)));
  CHECK(lines[0].back() == "error_tip");
  CHECK(lines[1].back() == "");
  CHECK(lines[2].back() == "2");
}

TEST_CASE("records: a case that is still running is not called done") {
  StudyResults results = sample_results();
  results.cases[0].partial = true;
  const auto lines = parse_csv(table_csv(cases_table(results)));
  CHECK(lines[0][4] == "status");
  CHECK(lines[1][4] == "partial");
}

TEST_CASE("records: the numbers of all cases stand behind case and axes, in columns by name") {
  StudyResults results = sample_results();
  // A case with other columns, and a second one of the same.
  CaseRecord other;
  other.id = "c00000000ff";
  other.axes = {{"mass", "lumped"}, {"step", 0.5}};
  other.numbers = {{"points", named_columns({"index", "parameter"}), {{3, 4}, {0.25, -0.0}}, {}}};
  results.cases.push_back(other);
  const std::vector<Table> heads = number_heads(results);
  REQUIRE(heads.size() == 2);
  CHECK(heads[0].name == "points");
  CHECK(heads[1].name == "impacts");
  std::string text;
  write_numbers_csv(results, heads[0], [&](std::string_view piece) { text += piece; });
  CHECK(text ==
        "case,mass,mass.velocity,step,parameter,start,tip_displacement,index\n"
        "c0123456789,singular,P1,1e-05,0.07,\"a, b\",1e-300,\n"
        "c0123456789,singular,P1,1e-05,0.08,rest,,\n"
        "c0123456789,singular,P1,1e-05,0.08,,0.1,\n"  // no word of that number
        "c00000000ff,lumped,,0.5,0.25,,,3\n"
        "c00000000ff,lumped,,0.5,-0,,,4\n");
  text.clear();
  write_numbers_csv(results, heads[1], [&](std::string_view piece) { text += piece; });
  CHECK(text == "case,mass,mass.velocity,step,parameter,speed\n");
}

TEST_CASE("records: a large table goes out in pieces, whole lines each, nothing lost") {
  StudyResults results = sample_results();
  constexpr int rows = 100000;
  std::vector<double> index(rows), value(rows);
  for (int i = 0; i < rows; ++i) {
    index[static_cast<std::size_t>(i)] = i;
    value[static_cast<std::size_t>(i)] = std::sin(i);
  }
  results.cases[0].numbers = {{"points", named_columns({"index", "tip_displacement"}), {index, value}, {}}};
  std::size_t largest = 0, pieces = 0;
  std::string text;
  write_numbers_csv(results, number_heads(results).front(), [&](std::string_view piece) {
    largest = std::max(largest, piece.size());
    ++pieces;
    CHECK(piece.back() == '\n');
    text += piece;
  });
  CHECK(pieces > 3);
  CHECK(largest < 2 * (std::size_t{1} << 20U));
  const auto lines = parse_csv(text);
  REQUIRE(lines.size() == rows + 1);
  for (const int i : {0, 1, 77777, rows - 1}) {
    const auto& line = lines[static_cast<std::size_t>(i) + 1];
    CHECK(line[4] == std::to_string(i));
    CHECK(std::strtod(line[5].c_str(), nullptr) == std::sin(i));
  }
}

TEST_CASE("records: a curve is its columns, and a value that is not finite is empty") {
  Curve curve;
  curve.names = {"t", "energy"};
  curve.columns = {{0, 0.5}, {1, std::numeric_limits<double>::quiet_NaN()}};
  CHECK(curve_csv(curve) == "t,energy\n0,1\n0.5,\n");
}

TEST_CASE("measures: names are unique, units and texts are there") {
  std::vector<std::string> names;
  for (const MeasureInfo& measure : all_measures()) {
    CHECK(std::find(names.begin(), names.end(), measure.name) == names.end());
    names.emplace_back(measure.name);
    CHECK_FALSE(std::string(measure.unit).empty());
    CHECK(std::string(measure.text).back() == '.');
    CHECK(measure_info(measure.name) == &measure);
  }
  CHECK(names.front() == "scheme_energy_start");
  CHECK(standing_measures("trajectory").back() == "microseconds_per_step");
  CHECK(measure_info("no such measure") == nullptr);
}
