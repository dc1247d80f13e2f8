#include "runners/report/figures.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "runners/report/options.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::report;

namespace {

const Figure& find(const std::vector<Figure>& figures, const std::string& id) {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.id == id; });
  REQUIRE(found != figures.end());
  return *found;
}

/// Values of the drawn series called `name`, of the points given in the option itself.
std::vector<std::pair<double, double>> points(const ChartView& view, const std::string& name) {
  std::vector<std::pair<double, double>> out;
  for (const auto& series : view.option.at("series"))
    if (series.at("name") == name && series.at("type") == "line")
      for (const auto& item : series.at("data")) out.emplace_back(item.at("value")[0], item.at("value")[1]);
  return out;
}

}  // namespace

TEST_CASE("thinning keeps every extreme, the ends, and the order", "[report]") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const size_t n : {10u, 1000u, 12345u})
    for (const size_t limit : {4u, 100u, 999u}) {
      std::vector<double> values(n);
      for (double& v : values) v = normal(random);
      values[n / 3] = 1e6;
      values[n / 2] = -1e6;
      const std::vector<size_t> kept = keep_extremes(values, limit);
      CHECK(kept.size() <= std::max(limit, std::min(n, limit)));
      CHECK(std::is_sorted(kept.begin(), kept.end()));
      CHECK(std::adjacent_find(kept.begin(), kept.end()) == kept.end());
      CHECK(kept.front() == 0);
      CHECK(kept.back() == n - 1);
      CHECK(std::count(kept.begin(), kept.end(), n / 3) == 1);
      CHECK(std::count(kept.begin(), kept.end(), n / 2) == 1);
    }
}

TEST_CASE("base64 is that of RFC 4648 over little-endian doubles", "[report]") {
  CHECK(base64_doubles(std::vector<double>{}).empty());
  CHECK(base64_doubles(std::vector<double>{1.0}) == "AAAAAAAA8D8=");
  CHECK(base64_doubles(std::vector<double>{1.0, -2.0}) == "AAAAAAAA8D8AAAAAAAAAwA==");
  CHECK(base64_doubles(std::vector<double>{0, 0, 0}) == std::string(32, 'A'));
}

TEST_CASE("one facet per method, one curve per step, each colour one mass matrix", "[report]") {
  const StudyResults results = synthetic::results();
  const CaseView view(results);
  CurveData curves(1000);
  const std::vector<Figure> figures = make_figures(view, curves);
  for (const char* id : {"final-energy-step", "energy", "tip", "force", "penetration-step"})
    CHECK_NOTHROW(find(figures, id));
  const Figure& energy = find(figures, "energy");
  CHECK(energy.charts.size() == 12);  // 4 masses × 3 time methods
  CHECK(energy.views.size() == 3);
  CHECK(energy.over_time);
  size_t with_curves = 0;
  for (const Chart& chart : energy.charts) {
    if (chart.views.empty()) {
      CHECK(!chart.notes.empty());  // an empty place says why
      continue;
    }
    ++with_curves;
    CHECK(chart.views.size() == energy.views.size());
    size_t lines = 0;
    for (const auto& series : chart.views[0].option.at("series")) lines += series.at("type") == "line";
    CHECK(lines == 3);
  }
  CHECK(with_curves == 10);
  std::set<std::string> colours;
  for (const CaseRecord& record : results.cases) colours.insert(view.colour(record));
  CHECK(colours.size() == view.masses().size());
}

TEST_CASE("axes hold everything that finished, and say when they do not start at zero", "[report]") {
  const StudyResults results = synthetic::results();
  const CaseView view(results);
  CurveData curves(1000);
  const auto figures = make_figures(view, curves);
  for (const Figure& figure : figures)
    for (const Chart& chart : figure.charts)
      for (const ChartView& v : chart.views) {
        const auto& axis = v.option.at("yAxis").is_array() ? v.option.at("yAxis")[0] : v.option.at("yAxis");
        const bool from_zero = axis.at("min") <= 0.0 && axis.at("max") >= 0.0;
        if (axis.at("type") == "value")
          CHECK(from_zero == (axis.at("name").get<std::string>().find("not from 0") == std::string::npos));
        CHECK(axis.at("min").get<double>() < axis.at("max").get<double>());
      }
  const Chart& first = find(figures, "energy").charts.front();
  CHECK(first.views[0].option.at("yAxis").at("min") == 0.0);
  CHECK(first.views[0].option.at("yAxis").at("max") >= 3.612908);
}

TEST_CASE("a logarithmic axis drops nothing in silence", "[report]") {
  const StudyResults results = synthetic::results();
  const CaseView view(results);
  CurveData curves(1000);
  const auto figures = make_figures(view, curves);
  const Figure& figure = find(figures, "penetration-step");
  const auto& chart = figure.charts.front();
  REQUIRE(chart.views.size() == 1);
  CHECK(points(chart.views[0], "consistent · beta 0.25").size() == 3);
  CHECK(points(chart.views[0], "singular, velocity P1 · beta 0.25").empty());
  bool said = false;
  for (const std::string& note : chart.views[0].notes) said = said || note.find("Exactly 0") == 0;
  CHECK(said);
}

TEST_CASE("what did not finish is marked where it stopped", "[report]") {
  const StudyResults results = synthetic::results();
  const CaseView view(results);
  CurveData curves(1000);
  const auto figures = make_figures(view, curves);
  size_t marks = 0;
  for (const Chart& chart : find(figures, "energy").charts)
    if (!chart.views.empty())
      for (const auto& series : chart.views[0].option.at("series"))
        if (series.at("type") == "scatter") {
          ++marks;
          const double y = series.at("data")[0].at("value")[1], top = chart.views[0].option.at("yAxis").at("max");
          CHECK(y <= top);
          CHECK(series.at("data")[0].at("text").get<std::string>().find("diverged at t = ") == 0);
        }
  CHECK(marks == view.with_status("diverged").size());
  size_t gutter = 0;
  for (const Chart& chart : find(figures, "final-energy-step").charts)
    for (const auto& series : chart.views.at(0).option.at("series"))
      if (series.at("type") == "scatter") gutter += series.at("data").size();
  CHECK(gutter == view.with_status("diverged").size() + view.with_status("refused").size());
}

TEST_CASE("a large study keeps every case within its facets", "[report]") {
  synthetic::Shape shape;
  shape.repeat = 6;
  const StudyResults results = synthetic::results(shape);
  REQUIRE(results.cases.size() > 200);
  const CaseView view(results);
  CurveData curves(1000);
  const auto figures = make_figures(view, curves);
  for (const char* id : {"final-energy-step", "final-energy-support-amplitude"})
    for (const Chart& chart : find(figures, id).charts) {
      std::set<std::string> names;
      for (const auto& series : chart.views.at(0).option.at("series"))
        names.insert(series.at("name").get<std::string>());
      CHECK(names.size() <= 8);
    }
}

TEST_CASE("a method without the parameter on the axis is drawn across", "[report]") {
  StudyResults results;
  results.kind = "trajectory";
  results.columns = {"mass", "contact", "contact.stiffness", "step"};
  const auto add = [&](const char* contact, std::optional<double> stiffness, double ratio) {
    CaseRecord record;
    record.id = contact + std::to_string(stiffness.value_or(0));
    record.axes = {{"mass", "consistent"}, {"contact", contact}, {"step", 1e-5}};
    if (stiffness) record.axes.emplace_back("contact.stiffness", *stiffness);
    record.status = "done";
    record.measures = {{"energy_start", 1}, {"energy_end", ratio}, {"energy_ratio", ratio}};
    results.cases.push_back(record);
  };
  for (const double stiffness : {1e3, 1e6, 1e9}) add("penalty", stiffness, 1 - 1 / stiffness);
  add("signorini", {}, 0.7);
  const CaseView view(results);
  CurveData curves(1000);
  const auto figures = make_figures(view, curves);
  const Figure& figure = find(figures, "final-energy-contact-stiffness");
  REQUIRE(figure.charts.size() == 1);
  CHECK(points(figure.charts[0].views[0], "penalty").size() == 3);
  const auto across = points(figure.charts[0].views[0], "signorini");
  REQUIRE(across.size() == 2);
  CHECK(across[0].second == across[1].second);
  CHECK(across[0].first < 1e4);
  CHECK(across[1].first > 1e8);
}

TEST_CASE("rounded intervals contain what they round", "[report]") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> exponent(-12, 12), sign(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    Interval given = Interval::nothing();
    given.include(sign(random) * std::pow(10, exponent(random)));
    given.include(sign(random) * std::pow(10, exponent(random)));
    const Interval round = round_outwards(given, 0), width{0, given.high - given.low};
    const double slack = 1e-8 * width.high;  // the step is rounded with a relative slack of 1e-9, of at most ten steps
    CHECK(round.low <= given.low + slack);
    CHECK(round.high >= given.high - slack);
    CHECK(round.high - round.low <= 2 * width.high);
  }
  const Interval decades = whole_decades({0.003, 0.2});
  CHECK(decades.low == Approx(1e-3));
  CHECK(decades.high == Approx(1));
}
