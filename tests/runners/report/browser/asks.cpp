// The report of a study that asks, on a phone and on a wide screen: every row can be reached, nothing is wider than it.
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <sstream>

#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/browser/driven.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace ricochet::browser;

namespace {

// What passes the right edge, but for what lies in a box that scrolls.
const char* const beyond_answer =
    "Array.from(document.querySelectorAll('#answer *')).filter((e) => !e.closest('.scroll, svg') && "
    "e.getClientRects().length && e.getBoundingClientRect().right > innerWidth + 1).map((e) => e.tagName + ' ' + "
    "e.className)";
// Of each ask: its rows, and those that are within their box when it is scrolled to them.
const char* const rows_reached =
    "Array.from(document.querySelectorAll('.asked')).map((ask) => { const rows = "
    "Array.from(ask.querySelectorAll('tbody tr')), box = ask.querySelector('.scroll'), reached = rows.filter((row) => "
    "{ "
    "box.scrollTop += row.getBoundingClientRect().top - box.getBoundingClientRect().top - box.clientHeight / 2; const "
    "a = row.getBoundingClientRect(), b = box.getBoundingClientRect(); return a.top >= b.top - 1 && a.bottom <= "
    "b.bottom + 1; }); return [rows.length, reached.length]; })";
// Boxes that hold more than they show, and of these those that keys reach.
const char* const boxes =
    "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => { const tall = "
    "Array.from(document.querySelectorAll('.asked .scroll')).filter((box) => box.scrollHeight > box.clientHeight + 1); "
    "done([tall.length, tall.filter((box) => box.tabIndex === 0).length]); })))";
// Figures, how wide the widest is, and the height of the letters in pixels.
const char* const figures =
    "(() => { const all = Array.from(document.querySelectorAll('.ask-figure')), letters = all.map((one) => "
    "parseFloat(getComputedStyle(one).fontSize) * one.getBoundingClientRect().width / one.viewBox.baseVal.width); "
    "return "
    "[all.length, Math.max(...all.map((one) => one.getBoundingClientRect().width)), Math.min(...letters), "
    "Math.max(...letters)]; })()";
// The colours of dots and letters and that of the page.
const char* const colours =
    "(() => { const colour = (where) => getComputedStyle(document.querySelector(where)).fill; return "
    "[colour('.ask-figure .dot.s0'), colour('.ask-figure text'), getComputedStyle(document.body).backgroundColor]; "
    "})()";

}  // namespace

TEST_CASE("every row of an answer can be reached, on a phone as on a wide screen", "[report][browser][asks]") {
  if (left_out()) return;
  const std::string page = report_of("studies", "asks");
  const auto seen = [&](const char* name, int width, bool dark = false) {
    return browser::Json{
        {"name", name},   {"page", page},
        {"width", width}, {"height", 900},
        {"dark", dark},   {"evaluate", {page_width, beyond_answer, boxes, rows_reached, figures, colours}}};
  };
  const browser::Json said = driven(
      "asks",
      {seen("phone", 390),
       seen("wide", 1400),
       seen("dark", 1400, true),
       {{"name", "bare"}, {"page", page}, {"width", 390}, {"height", 900}, {"bare", true}, {"evaluate", {figures}}}});
  std::map<std::string, int> rows;
  std::istringstream table(read_text(std::filesystem::path(page).parent_path() / "verdicts.csv"));
  for (std::string line; std::getline(table, line);) ++rows[line.substr(0, line.find(','))];
  rows.erase("ask");
  for (const auto& [name, width] : {std::pair("phone", 390), std::pair("wide", 1400)}) {
    INFO(name);
    const browser::Json& values = said.at(name).at("values");
    CHECK(values.at(0) == width);
    CHECK(values.at(1) == browser::Json::array());
    CHECK(values.at(2).at(0).get<int>() > 3);
    CHECK(values.at(2).at(0) == values.at(2).at(1));
    REQUIRE(values.at(3).size() == rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
      // One row of the table is the sentence.
      CHECK(values.at(3).at(k).at(0) == rows.at(std::to_string(k + 1)) - 1);
      CHECK(values.at(3).at(k).at(0) == values.at(3).at(k).at(1));
    }
    CHECK(values.at(4).at(0) == 6);  // all but that of runs
    CHECK(values.at(4).at(1).get<double>() <= width);
    CHECK(values.at(4).at(2).get<double>() > 9.5);
    CHECK(values.at(4).at(3).get<double>() < 17);
  }
  CHECK(said.at("bare").at("values").at(0).at(0) == 6);
  CHECK(said.at("dark").at("values").at(5) != said.at("wide").at("values").at(5));
  for (int k = 0; k < 3; ++k)
    CHECK(said.at("dark").at("values").at(5).at(k) != said.at("wide").at("values").at(5).at(k));
}
