// Figures of kind `stability`, read back from the browser: what is drawn is what the cases' tables hold.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "runners/run/finish_run.hpp"
#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/browser/driven.hpp"
#include "tests/runners/report/synthetic_stability.hpp"

using namespace ricochet;
using namespace ricochet::browser;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

const browser::Json& series_in(const browser::Json& chart, const std::string& name, size_t view = 0) {
  for (const browser::Json& one : chart.at("views")[view].at("series"))
    if (one.at("name") == name) return one;
  FAIL("no series " << name);
  static const browser::Json none;
  return none;
}
const browser::Json& titled(const browser::Json& figure, const std::string& part) {
  for (const browser::Json& chart : figure.at("charts"))
    if (chart.at("title").get<std::string>().find(part) != std::string::npos) return chart;
  FAIL("no chart " << part);
  static const browser::Json none;
  return none;
}

/// One chart per contact state, marginal cells hollow.
void check_radii(const browser::Json& page) {
  const browser::Json& radii = figure(page, "spectral-radius");
  CHECK(radii.at("views") == browser::Json({"spectral radius", "growth per step"}));
  const browser::Json& open = titled(radii, "open");
  // Without contact the stiffness of the stops changes nothing: one curve per mass.
  const browser::Json& full = series_in(open, "full");
  REQUIRE(full.at("data").size() == 9);
  CHECK(full["data"].back()["value"][1].get<double>() == Approx(5));
  CHECK(full["data"].back()["value"][0].get<double>() == Approx(1e-2));
  for (const browser::Json& item : series_in(open, "poor").at("data")) CHECK(item.at("hollow") == true);
  for (const browser::Json& item : full.at("data")) CHECK_FALSE(item.contains("hollow"));
  // Growth is the radius less one, and absent where nothing grows.
  CHECK(series_in(open, "full", 1)["data"].back()["value"][1].get<double>() == Approx(4));
  CHECK(series_in(open, "full", 1)["data"].front()["value"][1].is_null());
  CHECK(says(open.at("views")[1].at("notes"), "No growth at any step: poor"));
  CHECK(open.at("views")[0].at("yAxis")[0].at("min") <= 0.1);
  CHECK(open.at("views")[0].at("yAxis")[0].at("max") >= 10);
}

/// A cell per step and value, and both boundaries.
void check_map(const browser::Json& page) {
  const browser::Json& map = figure(page, "stability-map-contact-stiffness");
  // Open cells do not depend on the stiffness: closed ones alone, per mass.
  REQUIRE(map.at("charts").size() == 2);
  std::set<std::string> names;
  for (const browser::Json& chart : map.at("charts")) {
    CHECK_THAT(chart.at("title").get<std::string>(), StartsWith("closed"));
    size_t cells = 0, marks = 0;
    for (const browser::Json& one : chart.at("views")[0].at("series")) {
      if (one.at("mark") == "cells") cells += one["data"].size();
      if (one.at("mark") == "dots") marks += one["data"].size();
      names.insert(one.at("name"));
    }
    CHECK(cells == 36);
    CHECK(marks == 36);
    for (const char* axis : {"xAxis", "yAxis"}) CHECK(chart.at("views")[0].at(axis)[0].at("type") == "log");
  }
  for (const browser::Json& entry : map.at("entries")) CHECK(names.count(entry.at("name")) == 1);
  const browser::Json &full = titled(map, "full"), &poor = titled(map, "poor");
  CHECK(full.at("views")[0].at("notes").empty());
  // Across each band of stiffness its limit: 1e-2/√κ, and never beyond that of the open structure.
  std::vector<double> limits;
  for (const browser::Json& item : series_in(full, "predicted limit").at("data")) limits.push_back(item["value"][0]);
  REQUIRE(limits.size() == 12);
  CHECK(limits[0] == Approx(1e-3));
  CHECK(limits[3] == Approx(1e-4));
  CHECK(limits[11] == Approx(1e-6));
  REQUIRE(!poor.at("views")[0].at("notes").empty());
  CHECK_THAT(poor.at("views")[0].at("notes")[0].get<std::string>(),
             Contains("contact.stiffness 100") && Contains("predicted unstable, observed stable"));
}

/// Closed contact lets longer steps pass than the open structure: a scene that is both has the smaller limit.
StudyResults open_first() {
  StudyResults out = synthetic::stability();
  out.cases.clear();
  for (const double stiffness : {1.0, 4.0, 1e4})
    out.cases.push_back(
        synthetic::stability_case("full", stiffness, 2e-3, 1e-2 / std::sqrt(stiffness), 1e-2 / std::sqrt(stiffness)));
  out.expected_cases = 3;
  return out;
}
void check_open_first(const browser::Json& page) {
  const browser::Json& chart = figure(page, "stability-map-contact-stiffness").at("charts").at(0);
  const browser::Json& limits = series_in(chart, "predicted limit").at("data");
  REQUIRE(limits.size() == 9);
  for (size_t i = 0; i < 9; ++i) CHECK(limits[i]["value"][0].get<double>() == Approx(i < 6 ? 2e-3 : 1e-4));
  CHECK(limits[4]["value"][1] == 4.0);
  // Cells between the two limits are predicted unstable by the open structure, and marked where they lie.
  CHECK(series_in(chart, "observed unstable").at("count") > 0);
  for (const browser::Json& item : series_in(chart, "observed stable").at("data")) {
    const double step = item["value"][0], stiffness = item["value"][1];
    CHECK(step <= 1e-2 / std::sqrt(stiffness));
    CHECK_THAT(item.at("text").get<std::string>(), StartsWith(step > 2e-3 ? "predicted unstable" : "predicted "));
  }
}

}  // namespace

TEST_CASE("figures of stability draw cells and limits", "[report][browser]") {
  if (left_out()) return;
  const StudyResults results = with_tables(synthetic::stability());
  const browser::Json pages =
      read_back("stability", {page_of("stability", results), page_of("open_first", with_tables(open_first()))});
  require_works(pages.at("stability"), results.cases.size());
  check_radii(pages.at("stability"));
  check_map(pages.at("stability"));
  check_open_first(pages.at("open_first"));
}

TEST_CASE("charts of one figure have headings of their own, open and closed ones too", "[report][browser]") {
  if (left_out()) return;
  const char* const headings = R"js((() => {
    const { view } = ricochet.data, by = ["contact", "contact.stiffness", "time", "time.beta"];
    const charts = ["open", "closed"].flatMap((part) => view.group(view.all, by).map(({ label, cases }) => ({ title: part + " · " + label, cases, by, part })));
    const strips = ricochet.strips(charts), said = strips.flatMap(({ label, charts: own }) => own.map((one) => label + " / " + one.label));
    return [charts.length, strips.length, new Set(said).size, strips.every(({ label }) => /^(open|closed) · /.test(label))];
  })())js";
  // A parameter that only a few of many schemes have is no column of a map, which would stand empty; one that all have
  // is.
  const char* const layouts = R"js((() => {
    const axis = (name, texts, at, number) => ({ name, role: name.split(".")[0], word: "", varies: true, unit: "", texts, numbers: texts.map((text) => (number ? Number(text) : null)), at });
    const laid = (cases, all) => {
      const places = [...Array(cases).keys()], scheme = places.map((k) => k % (cases / 2)), some = (k) => all || scheme[k] < 6;
      const names = [...new Set(scheme.map((k) => "s" + (all ? k >> 2 : k)))];
      const axes = [axis("step", ["1", "2"], places.map((k) => (k < cases / 2 ? 0 : 1)), true), axis("time", names, scheme.map((k) => (all ? k >> 2 : k))), axis("time.p", ["1", "2", "3", "4"], places.map((k) => (some(k) ? scheme[k] % 4 : -1)), true)];
      const own = places.map((index) => ({ index, status: "done", measures: {}, values: Object.fromEntries(axes.filter(({ at }) => at[index] >= 0).map(({ name, texts, numbers, at }) => [name, { text: texts[at[index]], number: numbers[at[index]] }])) }));
      const kept = ricochet.data, data = { cases: own, page: { axes, roles: kept.page.roles, masses: [] } };
      data.view = new ricochet.Cases(data);
      ricochet.data = data;
      const { columns } = ricochet.mapLayout(data.view, own, "step");
      ricochet.data = kept;
      return columns;
    };
    return [laid(160, false), laid(160, true)];
  })())js";
  const browser::Json said =
      driven("headings",
             {{{"name", "headings"}, {"page", report_of("studies", "trajectory")}, {"evaluate", {headings, layouts}}}})
          .at("headings")
          .at("values");
  CHECK(said.at(0).at(0) >= 8);
  CHECK(said.at(0).at(1) > 1);
  CHECK(said.at(0).at(2) == said.at(0).at(0));
  CHECK(said.at(0).at(3) == true);
  CHECK(said.at(1) == browser::Json::parse(R"([["step"], ["time.p", "step"]])"));
}
