// The sections of kinds `bifurcation` and `basins`: what is told and written for the page is what the cases left.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <set>

#include "runners/kinds/basins/cell_scenes.hpp"
#include "runners/kinds/basins/page/page.hpp"
#include "runners/kinds/bifurcation/page/page.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/quantity.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/report/rendered.hpp"
#include "tests/runners/report/synthetic_dynamics.hpp"

using namespace ricochet;
using namespace ricochet::report;
using Catch::Matchers::Contains;

namespace {

/// Bytes of a block of the page.
std::vector<unsigned char> bytes_of(const CurveData& curves, const std::string& key) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::string& text = curves.blocks().at(key);
  std::vector<unsigned char> out;
  unsigned buffer = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    buffer = (buffer << 6) | static_cast<unsigned>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    out.push_back(static_cast<unsigned char>(buffer >> bits));
  }
  return out;
}

template <class Number>
std::vector<Number> numbers_of(const CurveData& curves, const std::string& key) {
  const std::vector<unsigned char> bytes = bytes_of(curves, key);
  std::vector<Number> out(bytes.size() / sizeof(Number));
  std::memcpy(out.data(), bytes.data(), out.size() * sizeof(Number));
  return out;
}

}  // namespace

TEST_CASE("an orbit's group follows its class and period", "[report]") {
  const auto named = [](const char* regime, std::optional<int> period) {
    return std::string(regime_groups[regime_group(regime, period)].name);
  };
  CHECK(named("no contact", 1) == "no contact");
  CHECK(named("at rest", 1) == "at rest");
  CHECK(named("periodic", 1) == "period 1");
  CHECK(named("periodic", 4) == "period 4");
  CHECK(named("periodic", 5) == "periods 5–8");
  CHECK(named("periodic", 8) == "periods 5–8");
  CHECK(named("periodic", 9) == "periods 9–64");
  CHECK(named("periodic 3", std::nullopt) == "period 3");
  CHECK(named("periodic", std::nullopt) == "undecided");
  CHECK(named("quasi-periodic", std::nullopt) == "quasi-periodic");
  CHECK(named("chaotic", std::nullopt) == "chaotic");
  CHECK(named("what is this", std::nullopt) == "undecided");
  OrbitRow refused;
  refused.regime = "periodic";
  refused.period = 1;
  refused.status = "refused";
  CHECK(regime_group(refused) == failed_group);
  std::set<std::string> colours;
  for (const RegimeGroup& group : regime_groups) colours.insert(group.colour);
  CHECK(colours.size() == regime_groups.size());
}

TEST_CASE("a swept value has the unit that the study keeps, and a formula is multiplied by it", "[report]") {
  StudyResults results;
  results.study = {{"scene", {{"stops", {{"upper", "0.1 + 0.1*x"}, {"lower", "-0.1"}}}, {"support", {{"amplitude", 0.1}}}}}};
  results.axes = {{"support.amplitude", "m", ""}, {"stops.lower", "m", ""}, {"contact.stiffness", "N/m", ""}};
  const auto shown = [&](const char* pointer) {
    return with_unit(swept_quantity(results, {{"pointer", pointer}}, "parameter"));
  };
  CHECK(shown("/scene/support/amplitude") == "support.amplitude (m)");
  CHECK(shown("/scene/stops/lower") == "stops.lower (m)");
  CHECK(shown("/scene/stops/upper") == "factor of stops.upper");
  CHECK(shown("/methods/contact/stiffness") == "contact.stiffness (N/m)");
  CHECK(shown("no pointer") == "parameter");
}

TEST_CASE("the page has every section point, but for repeats of periodic orbits", "[report]") {
  const StudyResults results = synthetic::dynamics();
  const Choices choices(results);
  CurveData curves(1000);
  const std::string said = put_points(choices, curves);
  for (const CaseRecord& record : results.cases) {
    const std::vector<OrbitRow> orbits = orbits_of(record);
    const auto orbit = numbers_of<std::uint16_t>(curves, record.id + "/points/orbit:u16");
    const auto u = numbers_of<float>(curves, record.id + "/points/u:f32");
    REQUIRE(orbit.size() == u.size());
    REQUIRE(u.size() == numbers_of<float>(curves, record.id + "/points/v:f32").size());
    const NumberTable& points = *find_table(record.numbers, "points");
    std::map<size_t, std::set<float>> drawn, stored;
    for (size_t i = 0; i < u.size(); ++i) drawn[orbit[i]].insert(u[i]);
    for (size_t i = 0; i < points.rows(); ++i)
      for (size_t o = 0; o < orbits.size(); ++o)
        if (orbits[o].parameter == points.values[0][i] &&
            orbits[o].start == points.words[0].second[static_cast<size_t>(points.values[1][i])])
          stored[o].insert(static_cast<float>(points.values[3][i]));
    for (size_t o = 0; o < orbits.size(); ++o) {
      if (!orbits[o].done()) {
        CHECK(drawn[o].empty());
      } else if (regime_group(orbits[o]) >= repeating_groups) {
        CHECK(drawn[o] == stored[o]);
      } else {
        // One point per period; where a point lies on the edge of a cell, two.
        const int period = orbits[o].regime == "periodic" ? orbits[o].period.value() : 1;
        CHECK(drawn[o].size() >= static_cast<size_t>(period) / 2);
        CHECK(drawn[o].size() <= static_cast<size_t>(2 * period));
        CHECK(std::includes(stored[o].begin(), stored[o].end(), drawn[o].begin(), drawn[o].end()));
      }
    }
  }
  CHECK_THAT(said, Contains("repeat one of their own periodic orbit"));
  CHECK_THAT(said, !Contains("left out"));
}

TEST_CASE("thinning is said, keeps every orbit, and keeps to its budget", "[report]") {
  synthetic::DynamicsShape shape;
  shape.values = 60;
  const StudyResults results = synthetic::dynamics(shape);
  CurveData curves(1000);
  PageBudget budget;
  budget.points = 3000;
  budget.portraits = 2000;
  const Choices choices(results);
  CHECK_THAT(put_points(choices, curves, budget), Contains("left out of the clouds"));
  size_t written = 0, orbits_with = 0, orbits_drawn = 0;
  for (const CaseRecord& record : results.cases) {
    const auto orbit = numbers_of<std::uint16_t>(curves, record.id + "/points/orbit:u16");
    written += orbit.size();
    orbits_drawn += std::set<std::uint16_t>(orbit.begin(), orbit.end()).size();
    for (const OrbitRow& one : orbits_of(record)) orbits_with += one.done();
  }
  CHECK(orbits_drawn == orbits_with);
  // Of orbits that repeat every branch is still there.
  CurveData whole(1000);
  put_points(choices, whole);
  for (const CaseRecord& record : results.cases) {
    const std::vector<OrbitRow> orbits = orbits_of(record);
    std::map<std::uint16_t, size_t> all, some;
    for (const auto o : numbers_of<std::uint16_t>(whole, record.id + "/points/orbit:u16")) ++all[o];
    for (const auto o : numbers_of<std::uint16_t>(curves, record.id + "/points/orbit:u16")) ++some[o];
    for (const auto& [o, count] : all)
      if (regime_group(orbits[o]) < repeating_groups) CHECK(some[o] == count);
  }
  // Shares are rounded upwards, by less than one point per orbit.
  CHECK(written <= budget.points + orbits_with);
  CHECK(written >= budget.points / 2);
  CHECK_THAT(put_portraits(choices, curves, budget), Contains("carries the portraits of"));
  // A portrait is there whole (201 samples here) or not at all.
  std::map<std::uint16_t, size_t> samples;
  for (const std::uint16_t o : numbers_of<std::uint16_t>(curves, results.cases[0].id + "/portrait/orbit:u16"))
    ++samples[o];
  CHECK(!samples.empty());
  for (const auto& [o, count] : samples) CHECK(count == 201);
}

TEST_CASE("nothing is written of cases that left nothing", "[report]") {
  StudyResults results = synthetic::dynamics();
  for (CaseRecord& record : results.cases) {
    record.tables.clear();
    record.numbers.clear();
    record.status = Status::failed;
    record.reasons = {"it went wrong"};
  }
  results.derived.clear();
  CurveData curves(1000);
  const Choices choices(results);
  CHECK(orbit_data(choices, curves).is_null());
  CHECK(curves.blocks().empty());
  CHECK(page_tables(Choices(results), bifurcation_page()).empty());
  CHECK(dynamics_answer_html(choices).empty());
  const std::string page = synthetic::rendered(results);
  CHECK_THAT(page, Contains("No case has finished with a result"));
}

TEST_CASE("what the script knows of an orbit is its row of values", "[report]") {
  const StudyResults results = synthetic::dynamics();
  CurveData curves(1000);
  const nlohmann::ordered_json data = orbit_data(Choices(results), curves);
  CHECK(data["parameter"] == nlohmann::ordered_json({"support.amplitude", "m"}));
  const CaseRecord& record = results.cases[1];
  const nlohmann::ordered_json& one = data["cases"][record.id];
  const Table& table = record.tables[0];
  const std::size_t evidence = TableReader(table).column("evidence");
  for (size_t row = 0; row < table.rows.size(); ++row) {
    CHECK(one["columns"]["parameter"][row] == json_of(table.rows[row][0]));
    CHECK(one["columns"]["evidence"][row] == json_of(table.rows[row][evidence]));
    CHECK(one["from"][row].get<double>() < table.rows[row][0].number().value());
    CHECK(one["to"][row].get<double>() > table.rows[row][0].number().value());
  }
  // Neighbours of one start share an edge; the derived table gives the attractors.
  CHECK(one["to"][0] == one["from"][1]);
  CHECK(one["columns"]["attractor"][0] == "1");
}

TEST_CASE("the tables of methods tell regimes, grazing and viscosity by their numbers", "[report]") {
  const StudyResults results = synthetic::dynamics();
  const std::string html = dynamics_answer_html(Choices(results));
  CHECK_THAT(html, Contains("Grazing, start rest: 0.0792"));
  // α = 1e-4: 5e-5 is half of it, 2e-9 a fifty-thousandth.
  CHECK_THAT(html, Contains("▲ 5e-5: 50 % of α</td>") && Contains(">2e-9: 0.002 % of α</td>"));
  CHECK_THAT(html, Contains("α = 0.0001 s of the scene") && Contains("so not ≪ α: 1 of 2 methods"));
  CHECK(html.find("nan") == std::string::npos);
  size_t orbits = 0;
  for (const CaseRecord& record : results.cases) orbits += orbits_of(record).size();
  CHECK_THAT(html, Contains("Regimes of " + std::to_string(orbits) + " orbits"));
}

TEST_CASE("tables of attractors, agreement, shifts and changes", "[report]") {
  const std::string html = dynamics_tables_html(Choices(synthetic::dynamics()));
  CHECK_THAT(html, Contains("<h3>Attractors</h3>") && Contains("common to all") && Contains("&lt;only&gt;"));
  CHECK_THAT(html, Contains("66 % (60 % to 71 %)"));
  CHECK_THAT(html, Contains("<h3>Agreement of methods</h3>") && Contains(">100</td>") && Contains(">74</td>"));
  CHECK_THAT(html,
             Contains("<h3>Shifts of the changes</h3>") && Contains("not found") && Contains("−0.0012 to −0.0008"));
  CHECK_THAT(html, Contains("<h3>Located changes</h3>") && Contains("grazing"));
}

TEST_CASE("images of basins hold every cell, and their difference counts those that moved", "[report]") {
  StudyResults results = synthetic::basins(40, 0.2);
  const BasinAnalysis basins = analyse_basins(results);
  REQUIRE(basins.images.size() == 2);
  REQUIRE(basins.labels.size() == 4);
  CHECK(basins.labels[0].name == "attractor 1 (periodic 1)");
  CHECK_FALSE(basins.labels[3].decided);
  CHECK(basins.xs.size() == 40);
  CHECK(basins.ys.size() == 39);
  size_t differ = 0, both = 0;
  for (size_t i = 0; i < basins.images[0].cells.size(); ++i) {
    const auto a = basins.images[0].cells[i], b = basins.images[1].cells[i];
    if (a == 3 || b == 3) continue;
    ++both;
    differ += a != b;
  }
  CHECK(differ > 0);
  const Choices choices(results);
  CurveData curves(1000);
  const nlohmann::ordered_json data = basin_data(choices, basins, curves);
  CHECK(data["grids"] == nlohmann::ordered_json({"full", "poor"}));
  CHECK(data["x"][0] == "factor of initial.displacement");
  const Table counts = basin_counts(basins);
  REQUIRE(counts.rows.size() == 2);
  CHECK(counts.rows[1][4] == differ);
  CHECK(counts.rows[1][7] == both);
  CHECK(bytes_of(curves, "poor/cells:u8") == basins.images[1].cells);
  // Differences, fractions and starts count the same cells.
  REQUIRE(basins.differences.size() == 1);
  CHECK(basins.differences[0].differ == static_cast<int>(differ));
  CHECK(basins.starts.at("poor").decided == both);
  size_t in_fractions = 0;
  for (const FractionRow& row : basins.fractions)
    if (row.id == "poor") in_fractions += static_cast<size_t>(row.cells);
  CHECK(in_fractions == both);
  const std::string html = basins_html(choices, basins);
  CHECK_THAT(html, Contains("periodic 3") && Contains(std::to_string(differ) + "</td>"));
  // The same colours whatever the order of the cases.
  StudyResults turned = synthetic::basins(40, 0.2);
  std::reverse(turned.cases.begin(), turned.cases.end());
  const BasinAnalysis again = analyse_basins(turned);
  for (size_t k = 0; k < 4; ++k) CHECK(again.labels[k].colour == basins.labels[k].colour);
}

TEST_CASE("cells that begin beyond a stop have a colour of their own, and no share counts them", "[report]") {
  // The last column of the grid, in which nothing failed.
  StudyResults results = synthetic::with_cells(synthetic::basins(20), [](CellRow& cell, size_t row) {
    if (row % 20 != 19) return;
    cell.regime = no_start;
    cell.status = no_start;
    cell.attractor.reset();
    cell.period.reset();
  });
  const std::size_t of_a_case = 20 * 19;
  const BasinAnalysis basins = analyse_basins(results);
  REQUIRE(basins.labels.size() == 5);
  CHECK(basins.labels[4].name == "no start");
  CHECK_FALSE(basins.labels[4].start);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(basins.labels[k].start);
    CHECK(basins.labels[k].colour != basins.labels[4].colour);
  }
  CHECK(basins.images[0].no_starts == 19);
  CHECK(basins.starts.at("full").no_starts == 19);
  const Table counts = basin_counts(basins);
  const auto in = [&](const char* name) { return counts.rows[1][*find_column(counts.columns, name)]; };
  CHECK(in("no_starts") == 19);
  CHECK(in("undecided").whole().value() + in("decided").whole().value() == static_cast<long long>(of_a_case) - 19);
  CHECK(basin_failures(basins).rows.size() == 2);
}

TEST_CASE("cells that were not marched themselves are said", "[report]") {
  StudyResults results =
      synthetic::with_cells(synthetic::basins(20), [](CellRow& cell, size_t row) { cell.marched = row % 4 == 0; });
  const BasinAnalysis basins = analyse_basins(results);
  CHECK(basins.images[0].filled == 285);  // three quarters of 20 × 19
  CHECK(basin_counts(basins).rows[0][3] == 285);
}

TEST_CASE("cases that are still being worked on are said to be", "[report]") {
  StudyResults results = synthetic::dynamics();
  CHECK_THAT(synthetic::rendered(results), !Contains("still being worked on.</strong>"));
  results.cases[1].partial = true;
  const std::string page = synthetic::rendered(results);
  CHECK_THAT(page, Contains("<strong>One case is still being worked on.</strong>"));
  CHECK_THAT(page, Contains("<em>(partial)</em>") && Contains("\"partial\":[false,true]"));
}

TEST_CASE("a page of dynamics keeps what studies say in its place", "[report]") {
  StudyResults results = synthetic::dynamics();
  const std::string attack = "</script><script>alert(1)</script><!-- \"'&\xff";
  results.name = attack;
  for (CaseRecord& record : results.cases) {
    record.axes[0].second = attack;
    for (auto& row : record.tables[0].rows) row[21] = row.back() = attack;
  }
  for (Table& table : results.derived)
    for (auto& row : table.rows)
      for (auto& cell : row)
        if (cell.words() && cell != "robust") cell = attack;
  const std::string page = synthetic::rendered(results);
  CHECK(page.find("<script>alert") == std::string::npos);
  CHECK(page.find("<!--") == std::string::npos);
}
