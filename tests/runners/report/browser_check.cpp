#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "runners/report/assets.hpp"
#include "runners/report/figures.hpp"
#include "runners/report/page.hpp"
#include "runners/report/report.hpp"
#include "tests/runners/report/synthetic.hpp"
#include "tests/runners/report/synthetic_dynamics.hpp"

using namespace ricochet;
namespace fs = std::filesystem;

namespace {

std::string library() {
  std::ifstream file(RICOCHET_SOURCE_DIR "/runners/report/node_modules/echarts/dist/echarts.min.js", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Opens the page in a browser and returns what it says of itself.
nlohmann::json check_in_browser(const std::string& name, const std::string& page, size_t charts) {
  const fs::path folder = fs::path(RICOCHET_BINARY_DIR) / "browser_check" / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::ofstream(folder / "report.html", std::ios::binary) << page;
  const std::string command = "sh '" RICOCHET_SOURCE_DIR "/tests/runners/report/browser_check.sh' '" +
                              (folder / "report.html").string() + "' '" + folder.string() + "' " +
                              std::to_string(charts);
  INFO("what the browser left is in " << folder);
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  REQUIRE(WEXITSTATUS(status) == 0);
  std::ifstream file(folder / "selfcheck.json");
  return nlohmann::json::parse(file);
}

/// Left out only where somebody says so: a missing browser is a failure.
bool without_browser() {
  const char* said = std::getenv("RICOCHET_WITHOUT_BROWSER");
  if (!said || std::string(said) != "1") return false;
  WARN("RICOCHET_WITHOUT_BROWSER is set: the report was not opened in a browser");
  return true;
}

size_t count_charts(const StudyResults& results) {
  const report::CaseView view(results);
  report::CurveData curves(report::sample_limit(report::series_shown(results)));
  size_t count = 0;
  for (const report::Figure& figure : report::make_figures(view, curves))
    for (const report::Chart& chart : figure.charts) count += !chart.views.empty();
  return count;
}

void require_everything_works(const nlohmann::json& said, const StudyResults& results) {
  size_t drawn = 0;
  for (const auto& figure : said.at("figures")) {
    INFO("figure " << figure.at("id"));
    for (const auto& view : figure.at("drawn"))
      for (const int pixels : view)
        CHECK(pixels > 40);  // a curve across half of a small chart colours hundreds, a lone mark about 60
    drawn += figure.at("charts").get<size_t>();
    if (figure.contains("hidden")) CHECK(figure.at("hidden") == true);
    if (figure.contains("linked")) CHECK(figure.at("linked") == true);
    if (figure.contains("aligned")) CHECK(figure.at("aligned") == true);
    if (figure.contains("reset")) CHECK(figure.at("reset") == true);
    CHECK(figure.at("svg") > 5000);  // axes and their labels alone are about this many bytes
    CHECK(figure.at("png") > 20000);
    CHECK(figure.at("tooltip").get<std::string>().find(" = ") != std::string::npos);
  }
  CHECK(drawn == count_charts(results));
  CHECK(said.at("table").at("rows") == results.cases.size());
  CHECK(said.at("table").at("sorts") == true);
  CHECK(said.at("table").at("filtered") == 0);
  CHECK(said.at("table").at("restored") == results.cases.size());
}

}  // namespace

TEST_CASE("a report with the chart library draws every chart in a browser", "[report][browser]") {
  if (without_browser()) return;
  const std::string charts = library();
  INFO("`npm ci` in runners/report brings the chart library (tests/run.sh does it)");
  REQUIRE(!charts.empty());
  const StudyResults results = synthetic::results();
  const std::string page = report::render_page(results, charts, "6");
  require_everything_works(check_in_browser("charts", page, count_charts(results)), results);
}

TEST_CASE("a hundred thousand samples per curve are drawn", "[report][browser]") {
  if (without_browser()) return;
  const std::string charts = library();
  REQUIRE(!charts.empty());
  synthetic::Shape shape;
  shape.samples = 100000;
  StudyResults results = synthetic::results(shape);
  results.cases.resize(3);  // one chart per figure: what is new here is the length
  const std::string page = report::render_page(results, charts, "6");
  require_everything_works(check_in_browser("long", page, count_charts(results)), results);
}

TEST_CASE("a diagram of 265200 stored points is drawn, and a click on a point opens its orbit", "[report][browser]") {
  if (without_browser()) return;
  const std::string charts = library();
  REQUIRE(!charts.empty());
  synthetic::DynamicsShape shape;
  shape.values = 450;
  shape.kept = 600;
  shape.starts = {"up"};
  shape.methods.resize(1);
  for (const bool large : {false, true}) {
    const StudyResults results = large ? synthetic::dynamics(shape) : synthetic::dynamics();
    const std::string page = report::render_page(results, charts, "6");
    const auto said = check_in_browser(large ? "diagram-large" : "diagram", page, count_charts(results));
    require_everything_works(said, results);
    const auto& panel = said.at("figures").at(0).at("panel");
    CHECK(panel.at("opened") == true);
    CHECK(panel.at("orbit") == true);
    CHECK(panel.at("closed") == true);
    CHECK(panel.at("facts") > 8);
    const std::string command = panel.at("command");
    CHECK(command.find("ricochet point ") == 0);
    CHECK(command.find(" thr50 --parameter 0.0") != std::string::npos);
    CHECK(command.find(" --start ") != std::string::npos);
  }
}

TEST_CASE("images of basins are drawn, their difference too, and a click opens a cell", "[report][browser]") {
  if (without_browser()) return;
  const std::string charts = library();
  REQUIRE(!charts.empty());
  const StudyResults results = synthetic::basins();
  const auto said = check_in_browser("basins", report::render_page(results, charts, "6"), count_charts(results));
  require_everything_works(said, results);
  const auto& cell = said.at("figures").at(0).at("cell");
  CHECK(cell.at("opened") == true);
  CHECK(cell.at("cell") == true);
  CHECK(cell.at("lines") == 2);  // one per case
  const std::string command = cell.at("command");
  CHECK(command.find("ricochet point ") == 0);
  CHECK(command.find(" --cell=" + cell.at("wanted").get<std::string>()) != std::string::npos);
}

TEST_CASE("the tables alone work in a browser", "[report][browser]") {
  if (without_browser()) return;
  const StudyResults results = synthetic::results();
  const nlohmann::json said = check_in_browser("tables", report::render_page(results, "", ""), 0);
  CHECK(said.at("figures").empty());
  CHECK(said.at("table").at("rows") == results.cases.size());
  CHECK(said.at("table").at("sorts") == true);
}

TEST_CASE("the program carries the chart library that lies beside it", "[report]") {
  const std::string charts = library();
  // A build without charts carries none; a build with them carries exactly the file.
  if (!report::chart_library().empty()) CHECK(report::chart_library() == charts);
  CHECK(report::chart_library().empty() == report::chart_library_version().empty());
  CHECK(report::page_script().find("selfcheck") != std::string::npos);
  CHECK(report::page_style().find("@media print") != std::string::npos);
}
