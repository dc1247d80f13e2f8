// The sections of kind `stability`: what is drawn and told is what the cases' tables hold.
#include "runners/report/stability_report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/report/stability_rows.hpp"
#include "runners/run/derive.hpp"

using namespace ricochet;
using namespace ricochet::report;
using Catch::Matchers::Contains;

namespace {

using Row = std::vector<nlohmann::ordered_json>;

/// Steps 1e-6 … 1e-2, one per half decade. Open: unstable beyond `open` (0: never). Closed: beyond `closed`; the scene
/// is seen to blow up beyond `seen`.
CaseRecord make_case(const std::string& mass, double stiffness, double open, double closed, double seen) {
  CaseRecord record;
  record.axes = {{"mass", mass},
                 {"contact", "spring"},
                 {"contact.stiffness", stiffness},
                 {"time", "three-level"},
                 {"elements", 10}};
  record.id = mass + std::to_string(stiffness);
  record.status = "done";
  Table table = stability_head();
  Table observed{"stability_observed", "", named_columns({"step", "closed", "behaviour"}), {}};
  const auto limit = [](double h) { return h > 0 ? Cell(h) : Cell(); };
  for (const bool touching : {false, true})
    for (int i = 0; i <= 8; ++i) {
      const double step = std::pow(10, -6 + 0.5 * i), own = touching ? closed : open, met = touching ? seen : open;
      const bool grows = own > 0 && step > own, blows = met > 0 && step > met;
      table.rows.push_back({step, touching, grows ? step / own : 1.0, mass == "poor" ? "root −1 on <the kernel>" : "",
                            limit(own), limit(met), grows || blows ? "unstable" : "stable",
                            grows   ? "it grows"
                            : blows ? "observed: it blew up"
                                    : ""});
      observed.rows.push_back({step, touching, blows ? "diverged" : "stable"});
    }
  record.tables = {table, observed};
  return record;
}

StudyResults results() {
  StudyResults out;
  out.name = "cells";
  out.kind = "stability";
  out.columns = {"mass", "contact", "contact.stiffness", "time", "elements"};
  for (const std::string mass : {"full", "poor"})
    for (const double stiffness : {1e2, 1e4, 1e6, 1e8})
      out.cases.push_back(make_case(mass, stiffness, mass == "full" ? 2e-3 : 0, 1 / std::sqrt(stiffness) * 1e-2,
                                    1 / std::sqrt(stiffness) * (mass == "full" ? 1e-2 : 4e-2)));
  CaseRecord refused;
  refused.axes = {{"mass", "none at all"},
                  {"contact", "spring"},
                  {"contact.stiffness", 1e2},
                  {"time", "three-level"},
                  {"elements", 10}};
  refused.id = "refused";
  refused.status = "refused";
  refused.reason = "nothing to march";
  Table table = stability_head();
  table.rows.push_back({1e-6, false, nullptr, "", nullptr, nullptr, "refused", refused.reason});
  refused.tables = {table};
  out.cases.push_back(std::move(refused));
  out.expected_cases = static_cast<int>(out.cases.size());
  return out;
}

const Figure& find(const std::vector<Figure>& figures, const std::string& id) {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.id == id; });
  REQUIRE(found != figures.end());
  return *found;
}

const Json& series(const Chart& chart, const std::string& name, size_t view = 0) {
  for (const Json& one : chart.views.at(view).option.at("series"))
    if (one.at("name") == name) return one;
  FAIL("no series " << name);
  static const Json none;
  return none;
}

bool has_null(const Json& value) {
  if (value.is_null()) return true;
  if (value.is_number_float()) return !std::isfinite(value.get<double>());
  return value.is_structured() && std::any_of(value.begin(), value.end(), [](const Json& v) { return has_null(v); });
}

}  // namespace

TEST_CASE("ranges are read with what both contact states say of a cell", "[report]") {
  const CaseRecord record = make_case("full", 1e8, 2e-3, 1e-4, 1e-4);
  const auto open = stability_range(record, false), closed = stability_range(record, true);
  REQUIRE(open);
  REQUIRE(closed);
  CHECK(open->cells.size() == 9);
  CHECK(open->predicted == 2e-3);
  CHECK(closed->predicted == 1e-4);
  CHECK(closed->expected == 1e-4);
  CHECK(disagreements(*closed).empty());
  // A scene is open as well: it is expected to fail where the open structure does.
  const auto late = stability_range(make_case("full", 1e2, 2e-4, 2e-3, 2e-4), true);
  CHECK(late->expected == 2e-4);
  CHECK(disagreements(*late).empty());
  // Seen to blow up beyond 1e-4 s, predicted beyond 1e-3 s: the steps between.
  const auto apart = disagreements(*stability_range(make_case("poor", 1e2, 0, 1e-3, 9e-5), true));
  REQUIRE(apart.size() == 1);
  CHECK(apart[0] == "h = 0.0001 s to 0.001 s (3 steps): predicted stable, observed unstable");
  CHECK_FALSE(stability_range(CaseRecord(), false));
}

TEST_CASE("spectral radii: one chart per contact state, marginal cells hollow", "[report]") {
  const StudyResults all = results();
  const CaseView view(all);
  const std::vector<Figure> figures = stability_figures(view);
  const Figure& figure = find(figures, "spectral-radius");
  CHECK(figure.views == std::vector<std::string>{"spectral radius", "growth per step"});
  const auto open = std::find_if(figure.charts.begin(), figure.charts.end(),
                                 [](const Chart& chart) { return chart.title.starts_with("open"); });
  REQUIRE(open != figure.charts.end());
  // Without contact the stiffness of the stops changes nothing: one curve per mass.
  const Json& full = series(*open, "full");
  REQUIRE(full.at("data").size() == 9);
  CHECK(full["data"].back()["value"][1].get<double>() == Approx(5));
  CHECK(full["data"].back()["value"][0].get<double>() == Approx(1e-2));
  for (const Json& item : series(*open, "poor").at("data")) CHECK(item.at("itemStyle").at("color") == "#ffffff");
  for (const Json& item : full.at("data")) CHECK_FALSE(item.contains("itemStyle"));
  // Growth is the radius less one, and absent where nothing grows.
  CHECK(series(*open, "full", 1)["data"].back()["value"][1].get<double>() == Approx(4));
  CHECK(series(*open, "full", 1)["data"].front()["value"][1] == "-");
  for (const Chart& chart : figure.charts)
    for (const ChartView& one : chart.views) CHECK_FALSE(has_null(one.option));
}

TEST_CASE("the map has a cell per step and value, and both boundaries", "[report]") {
  const StudyResults all = results();
  const CaseView view(all);
  const std::vector<Figure> figures = stability_figures(view);
  const Figure& map = find(figures, "stability-map-contact-stiffness");
  // Open cells do not depend on the stiffness: closed ones alone, per mass.
  REQUIRE(map.charts.size() == 2);
  for (const Chart& chart : map.charts) {
    CHECK(chart.title.starts_with("closed"));
    size_t cells = 0, marks = 0;
    for (const Json& one : chart.views.at(0).option.at("series")) {
      if (one.contains("markArea")) cells += one["markArea"]["data"].size();
      if (one.at("type") == "scatter") marks += one["data"].size();
    }
    CHECK(cells == 36);
    CHECK(marks == 36);
    CHECK_FALSE(has_null(chart.views[0].option));
  }
  const auto full = std::find_if(map.charts.begin(), map.charts.end(),
                                 [](const Chart& chart) { return chart.title.find("full") != std::string::npos; });
  REQUIRE(full != map.charts.end());
  CHECK(full->notes.empty());
  // Across each band of stiffness its limit: 1e-2/√κ, and never beyond that of the open structure.
  std::vector<double> limits;
  for (const Json& item : series(*full, "predicted limit").at("data")) limits.push_back(item["value"][0]);
  REQUIRE(limits.size() == 12);
  CHECK(limits[0] == Approx(1e-3));
  CHECK(limits[3] == Approx(1e-4));
  CHECK(limits[11] == Approx(1e-6));
  const Chart& poor = map.charts[full == map.charts.begin() ? 1 : 0];
  REQUIRE(!poor.notes.empty());
  CHECK_THAT(poor.notes.front(), Contains("contact.stiffness 100") && Contains("predicted unstable, observed stable"));
}

TEST_CASE("the table says limits, agreement, marginal roots", "[report]") {
  const StudyResults all = with_tables(results());
  const std::string html = stability_html(CaseView(all));
  CHECK_THAT(html, Contains("root −1 on &lt;the kernel&gt;") && Contains("nothing to march") && Contains("none"));
  CHECK_THAT(html, Contains("agree to 2 %"));
  CHECK(html.find("<the kernel>") == std::string::npos);
  StudyResults other;
  other.kind = "trajectory";
  CHECK(stability_html(CaseView(other)).empty());
  CHECK(stability_figures(CaseView(other)).empty());
}
