// A report does not grow with its study: a thousand cases, read back from the browser.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/places.hpp"
#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/browser/driven.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::browser;

namespace {

StudyResults thousand() {
  synthetic::Shape shape;
  shape.repeat = 27;
  return synthetic::results(shape);
}

}  // namespace

TEST_CASE("a study of a thousand cases has a page of a few screens", "[report][browser]") {
  if (left_out()) return;
  const StudyResults results = thousand();
  REQUIRE(results.cases.size() == 972);
  const Page page = page_of("many", results);
  CHECK(page.html.size() < 2'000'000);
  const browser::Json said = read_back("many", {page}).at("many");
  CHECK(said.at("height") < 12 * 900);
  // Nearly all of it is laid out when it is come near, and takes the room that it was given.
  CHECK(said.at("opened").at("nodes") < 4'000);
  CHECK(said.at("opened").at("height").get<double>() == Approx(said.at("height").get<double>()).epsilon(0.1));
  CHECK(said.at("nodes") < 45'000);  // 972 rows of the table of cases, and a cell of each map for each
  std::size_t maps = 0;
  for (const browser::Json& one : said.at("figures")) {
    INFO(one.at("id"));
    CHECK(one.at("charts").size() <= 24);
    if (!one.contains("map")) continue;
    ++maps;
    CHECK(one.at("map").at("cells") == results.cases.size());
    CHECK(one.at("map").at("rows") <= 60);
    CHECK(one.at("map").at("marks") > 0);  // what has no result says so without colour
    for (const browser::Json& charts : one.at("map").at("charts")) CHECK((charts > 0 && charts <= 24));
  }
  // The energy at the end and over time share a map; tip, force, penetration and impacts have their own.
  CHECK(maps == 5);
  CHECK(said.at("table").at("rows") == results.cases.size());
}

TEST_CASE(
    "maps and the table of a thousand cases are there when they are come near, looked for or printed, and without "
    "scripts",
    "[report][browser]") {
  if (left_out()) return;
  namespace fs = std::filesystem;
  const StudyResults results = thousand();
  const fs::path folder = fs::path(tests::places().build) / "browser" / "many-read", page = folder / "many.html";
  fs::create_directories(folder);
  std::ofstream(page, std::ios::binary) << page_of("many", results).html;
  const std::string here =
      "[document.querySelectorAll('.waits').length, document.querySelectorAll('.map').length, "
      "document.querySelectorAll('#cases tbody tr').length]";
  const auto come_near = [](const std::string& what, const std::string& there) {
    return "new Promise((done) => { document.documentElement.style.scrollBehavior = 'auto'; document.querySelector('" +
           what + "').scrollIntoView(); const until = performance.now() + 10000; (function look() { " + there +
           " || performance.now() > until ? done(0) : requestAnimationFrame(look); })(); })";
  };
  const std::string to_table = come_near("#all-cases", "document.getElementById('cases')");
  const std::string to_map = come_near("#figure-tip", "document.querySelector('#figure-tip .map')");
  const std::string pdf = (folder / "many.pdf").string();
  const auto step = [&](const std::string& name, browser::Json more) {
    more.update({{"name", name}, {"page", page.string()}});
    return more;
  };
  const std::string filter =
      "(() => { const box = document.getElementById('filter'); box.value = 'status = refused'; box.dispatchEvent(new "
      "Event('input')); const shown = Array.from(document.querySelectorAll('#cases tbody tr')).filter((row) => "
      "!row.hidden).length; box.value = ''; box.dispatchEvent(new Event('input')); return shown; })()";
  const browser::Json said =
      driven("many-read",
             {step("read",
                   {{"before",
                     {here, to_map, here, to_table, here, filter, "document.querySelector('#cases tbody tr').focus()"}},
                    {"keys", {"Enter"}},
                    {"evaluate", {"ricochet.sidePanel.shown().id"}}}),
              step("looked for", {{"keys", {"Control+f"}}, {"evaluate", {here}}}),
              step("phone", {{"width", 420},
                             {"height", 900},
                             {"before", {to_map}},
                             {"evaluate",
                              {"new Promise((done) => { const box = document.querySelector('#figure-tip .scroll'), "
                               "until = performance.now() + 5000, "
                               "answer = () => [box.dataset.wide || '', box.querySelector('th.own').offsetHeight, "
                               "box.querySelector('td').getBoundingClientRect().left < innerWidth]; (function look() { "
                               "box.dataset.wide || performance.now() > until ? done(answer()) : "
                               "requestAnimationFrame(look); })(); })"}}}),
              step("bare", {{"bare", true}, {"evaluate", {"document.querySelectorAll('#cases tbody tr').length"}}}),
              step("printed", {{"evaluate", {here}}, {"pdf", pdf}})});
  const browser::Json& read = said.at("read").at("before");
  const browser::Json &opened = read.at(0), &by_map = read.at(2);
  CHECK(opened.at(0).get<int>() >= 5);  // four maps and the table: what stands beside the answer is in sight
  CHECK(opened.at(2) == 0);
  CHECK(by_map.at(1) > opened.at(1));
  CHECK(by_map.at(2) == 0);
  CHECK(read.at(4).at(2) == results.cases.size());
  const auto refused = std::count_if(results.cases.begin(), results.cases.end(),
                                     [](const CaseRecord& record) { return record.status == Status::refused; });
  CHECK(read.at(5) == refused);
  CHECK(said.at("read").at("values").at(0) == results.cases.front().id);
  CHECK(said.at("looked for").at("values").at(0) == browser::Json({0, 5, results.cases.size()}));
  const browser::Json phone = said.at("phone").at("values").at(0);
  CHECK(phone.at(0) == "more");
  CHECK(phone.at(1) < 80);  // words of a header are not broken letter by letter: four lines
  CHECK(phone.at(2) == true);
  CHECK(said.at("bare").at("values").at(0) == results.cases.size());
  CHECK(said.at("printed").at("values").at(0) == opened);
  const std::string text = words_of("pdftotext '" + pdf + "' -");
  CHECK_THAT(text, Catch::Matchers::Contains(results.cases[149].id));  // the last row that is for paper
  size_t maps = 0;
  for (size_t at = 0; (at = text.find("Columns: ", at)) != std::string::npos; ++at) ++maps;
  CHECK(maps == 5);
}
