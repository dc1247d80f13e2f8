// Figures of trajectories, read back from the browser.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/rendered.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::browser;
using Catch::Matchers::Contains;

namespace {

/// A penalty against stiffness, and a rigid law without one.
StudyResults stiffnesses() {
  StudyResults results;
  results.kind = "trajectory";
  results.columns = {"mass", "contact", "contact.stiffness", "step"};
  const auto add = [&](const char* contact, std::optional<double> stiffness, double ratio) {
    CaseRecord record;
    record.id = contact + std::to_string(stiffness.value_or(0));
    record.axes = {{"mass", "consistent"}, {"contact", contact}, {"step", 1e-5}};
    if (stiffness) record.axes.emplace_back("contact.stiffness", *stiffness);
    record.status = Status::done;
    record.measures = {{"energy_brought_in", 1}, {"energy_end", ratio}, {"energy_left", ratio}};
    results.cases.push_back(record);
  };
  for (const double stiffness : {1e3, 1e6, 1e9}) add("penalty", stiffness, 1 - 1 / stiffness);
  add("signorini", {}, 0.7);
  return results;
}

std::vector<std::pair<double, double>> some_numbers() {
  std::vector<std::pair<double, double>> out = {{0.003, 0.2}, {1e-7, 0.25}, {12000, 1e5}, {0.0005, 0.1}};
  std::mt19937 random(2);
  std::uniform_real_distribution<double> exponent(-12, 12), sign(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const double a = sign(random) * std::pow(10, exponent(random)), b = sign(random) * std::pow(10, exponent(random));
    out.emplace_back(std::min(a, b), std::max(a, b));
  }
  return out;
}

void check_facets(const StudyResults& results, const browser::Json& page) {
  const Choices view(results);
  for (const char* id : {"final-energy-step", "energy", "tip", "force", "penetration-step", "impacts-step"})
    CHECK(has_figure(page, id));
  const browser::Json& energy = figure(page, "energy");
  CHECK(energy.at("charts").size() == 12);  // 4 masses × 3 time methods
  CHECK(energy.at("views").size() == 4);    // E, its ratio, its change, and the difference to one of the curves
  CHECK(energy.at("linked_along") == true);
  // Overlaid instead: the four masses, a chart per time method and step.
  CHECK(energy.at("overlay").at("charts") == 9);
  CHECK(energy.at("overlay").at("names").size() == 4);
  CHECK(energy.at("overlay").at("anew") == true);
  CHECK(energy.at("overlay").at("back") == true);
  size_t with_curves = 0;
  for (const browser::Json& chart : energy.at("charts")) {
    if (chart.at("views").empty()) {
      CHECK(!chart.at("notes").empty());  // an empty place says why
      continue;
    }
    ++with_curves;
    CHECK(chart.at("views").size() == energy.at("views").size());
    size_t lines = 0;
    for (const browser::Json& series : chart.at("views")[0].at("series")) lines += series.at("mark") == "line";
    CHECK(lines == 3);
  }
  CHECK(with_curves == 10);
  // Every curve that the cases have is drawn, sample by sample.
  size_t samples = 0, stored = 0;
  for (const browser::Json& series :
       series_of(energy, 0, [](const browser::Json& s) { return s.at("mark") == "line"; }))
    samples += series.at("count").get<size_t>();
  for (const CaseRecord& record : results.cases)
    if (!record.curve.columns.empty()) stored += record.curve.columns[0].size();
  CHECK(samples == stored);
  std::set<std::string> colours, drawn;
  for (const CaseRecord& record : results.cases) colours.insert(view.colour(record));
  CHECK(colours.size() == view.masses().size());
  for (const browser::Json& series : series_of(figure(page, "final-energy-step"), 0, is_curve))
    drawn.insert(series.at("colour"));
  CHECK(drawn == colours);
}

void check_axes(const browser::Json& page) {
  for (const browser::Json& one : page.at("figures"))
    for (const browser::Json& chart : one.at("charts"))
      for (const browser::Json& view : chart.at("views")) {
        if (view.at("series").empty()) continue;
        const browser::Json& axis = view.at("yAxis")[0];
        INFO(one.at("id") << " " << chart.at("title"));
        if (axis.at("type") == "category") continue;
        const bool from_zero = axis.at("min") <= 0.0 && axis.at("max") >= 0.0;
        if (axis.at("type") == "value")
          CHECK(from_zero == (axis.at("name").get<std::string>().find("not from 0") == std::string::npos));
        CHECK(axis.at("min").get<double>() < axis.at("max").get<double>());
      }
  const browser::Json& first = figure(page, "energy").at("charts")[0].at("views")[0].at("yAxis")[0];
  CHECK(first.at("min") == 0.0);
  CHECK(first.at("max") >= 3.612908);
  CHECK(first.at("name") == "energy E (J)");
  // Both stops are lines across the tip's charts.
  int lower = 0, upper = 0;
  for (const browser::Json& series : series_of(figure(page, "tip"), 0, named("stops"))) {
    const double stop = series.at("at").at("y");
    CHECK(std::abs(stop) == 0.1);
    (stop < 0 ? lower : upper) += 1;
  }
  CHECK(lower == 10);  // of 12 charts two have no curve
  CHECK(upper == lower);
}

/// A curve ends where its case's samples end.
void check_samples(const StudyResults& results, const browser::Json& page) {
  for (const auto& [id, column] :
       {std::pair("energy", "energy"), {"tip", "tip_displacement"}, {"force", "contact_force_peak"}}) {
    INFO(id);
    size_t ends = 0;
    for (const browser::Json& series : series_of(
             figure(page, id), 0, [](const browser::Json& s) { return s.at("mark") == "line" && s.at("count") > 0; })) {
      const browser::Json& last = series.at("data").back().at("value");
      ends += std::any_of(results.cases.begin(), results.cases.end(), [&, column = column](const CaseRecord& record) {
        const Curve& curve = record.curve;
        const auto at = std::find(curve.names.begin(), curve.names.end(), column) - curve.names.begin();
        return !curve.columns.empty() && last[0].get<double>() == Approx(curve.columns[0].back()) &&
               last[1].get<double>() == Approx(curve.columns[at].back());
      });
    }
    CHECK(ends == 30);  // 12 charts of 3 steps, but 6 cases were refused
  }
}

void check_zeros(const browser::Json& page) {
  const browser::Json& chart = figure(page, "penetration-step").at("charts")[0];
  REQUIRE(chart.at("views").size() == 1);
  const auto count = [&](const std::string& name) {
    size_t n = 0;
    for (const browser::Json& series : chart.at("views")[0].at("series"))
      if (series.at("name") == name && series.at("mark") == "line") n += series.at("data").size();
    return n;
  };
  CHECK(count("consistent · beta 0.25") == 3);
  CHECK(count("singular, velocity P1 · beta 0.25") == 0);
  const auto deepest = items_of(figure(page, "penetration-step"), 0, [](const browser::Json& series) {
    return is_curve(series) && series.at("name") == "consistent · beta 0.25";
  });
  REQUIRE(!deepest.empty());
  for (const browser::Json& item : deepest)
    CHECK(item.at("value")[1].get<double>() == Approx(0.03 * item.at("value")[0].get<double>()));
  CHECK(says(chart.at("views")[0].at("notes"), "Exactly 0"));
  // Every synthetic case that marched has eight impacts.
  const auto impacts = items_of(figure(page, "impacts-step"), 0, is_curve);
  CHECK(impacts.size() > 20);
  for (const browser::Json& item : impacts) CHECK(item.at("value")[1] == 8);
}

void check_unfinished(const StudyResults& results, const browser::Json& page) {
  const Choices view(results);
  size_t marks = 0, gutter = 0;
  for (const browser::Json& chart : figure(page, "energy").at("charts"))
    if (!chart.at("views").empty())
      for (const browser::Json& series : chart.at("views")[0].at("series"))
        if (is_mark(series)) {
          ++marks;
          CHECK(series.at("data")[0].at("value")[1] <= chart.at("views")[0].at("yAxis")[0].at("max"));
          CHECK_THAT(series.at("data")[0].at("text").get<std::string>(),
                     Catch::Matchers::StartsWith("diverged at t = "));
        }
  CHECK(marks == with_status(all_cases(view.results()), Status::diverged).size());
  // In a strip that is wider than its axis, so that marks at the ends are whole.
  for (const browser::Json& chart : figure(page, "final-energy-step").at("charts")) {
    const browser::Json& drawn = chart.at("views")[0];
    for (const browser::Json& series : drawn.at("series")) {
      if (!is_mark(series)) continue;
      gutter += series.at("data").size();
      REQUIRE(series.at("yAxis") == 1);
      CHECK(drawn.at("frames")[drawn.at("yAxis")[1].at("frame").get<size_t>()].at("pad") > 0);
    }
  }
  CHECK(gutter == with_status(all_cases(view.results()), Status::diverged).size() +
                      with_status(all_cases(view.results()), Status::refused).size());
}

}  // namespace

TEST_CASE("figures of trajectories draw what the cases hold", "[report][browser]") {
  if (left_out()) return;
  const StudyResults results = synthetic::results();
  synthetic::Shape shape;
  shape.repeat = 6;
  const StudyResults large = synthetic::results(shape), stiff = stiffnesses();
  REQUIRE(large.cases.size() > 200);
  Page first = page_of("trajectory", results), second = page_of("large", large), third = page_of("stiffness", stiff);
  first.numbers = some_numbers();
  second.controls = false;
  const browser::Json pages = read_back("trajectory", {first, second, third});

  const browser::Json& page = pages.at("trajectory");
  require_works(page, results.cases.size());
  check_facets(results, page);
  check_axes(page);
  check_samples(results, page);
  check_zeros(page);
  check_unfinished(results, page);

  // A large study keeps every case within its facets.
  for (const char* id : {"final-energy-step", "final-energy-support-amplitude"})
    for (const browser::Json& chart : figure(pages.at("large"), id).at("charts")) {
      std::set<std::string> names;
      for (const browser::Json& series : chart.at("views")[0].at("series")) names.insert(series.at("name"));
      CHECK(names.size() <= 8);
    }

  // A method without the parameter on the axis is drawn across.
  const browser::Json& against = figure(pages.at("stiffness"), "final-energy-contact-stiffness");
  REQUIRE(against.at("charts").size() == 1);
  CHECK(items_of(against, 0, named("penalty")).size() == 3);
  const auto across = items_of(against, 0, named("signorini"));
  REQUIRE(across.size() == 2);
  CHECK(across[0].at("value")[1] == across[1].at("value")[1]);
  CHECK(across[0].at("value")[0] < 1e4);
  CHECK(across[1].at("value")[0] > 1e8);

  // Rounded intervals contain what they round; numbers are written as the tables write them.
  for (size_t i = 0; i < first.numbers.size(); ++i) {
    const auto [low, high] = first.numbers[i];
    const browser::Json& said = page.at("words")[i];
    const double slack =
        1e-8 * (high - low);  // the step is rounded with a relative slack of 1e-9, of at most ten steps
    CHECK(said.at("round").at("low").get<double>() <= low + slack);
    CHECK(said.at("round").at("high").get<double>() >= high - slack);
    CHECK(said.at("round").at("high").get<double>() - said.at("round").at("low").get<double>() <= 2 * (high - low));
    CHECK(said.at("text") == report::number_text(low));
    CHECK(said.at("exact") == report::exact_text(low));
  }
  CHECK(page.at("words")[0].at("decades").at("low") == 1e-3);
  CHECK(page.at("words")[0].at("decades").at("high") == 1);
}

TEST_CASE("tens of thousands of samples per curve are drawn", "[report][browser]") {
  if (left_out()) return;
  synthetic::Shape shape;
  shape.samples = 40000;
  StudyResults results = synthetic::results(shape);
  results.cases.resize(3);  // one chart per figure: what is new here is the length
  const browser::Json pages = read_back("long", {page_of("long", results)});
  require_works(pages.at("long"), results.cases.size());
  for (const browser::Json& series : series_of(figure(pages.at("long"), "energy"), 0,
                                               [](const browser::Json& s) { return s.at("mark") == "line"; })) {
    CHECK(series.at("given") == 40001);
    CHECK(series.at("count") > 500);  // what is left for each pixel
  }
  CHECK_THAT(figure(pages.at("long"), "energy").at("caption").get<std::string>(),
             Contains("the smallest and the largest of each pixel are drawn"));
}
