// Reports of every kind, as they are read: on a phone, on paper, on a dark screen, by keys.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <regex>

#include "tests/places.hpp"
#include "tests/runners/report/browser/browser.hpp"
#include "tests/runners/report/browser/driven.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace ricochet::browser;
using Catch::Matchers::Contains;

namespace {

const char* const read_kinds[] = {"trajectory",  "convergence", "work-precision", "stability",
                                  "bifurcation", "basins",      "continuation"};

// Expressions that the page answers.
// Boxes and words that pass the right edge of what is seen, but for what lies in a box that scrolls by itself.
const char* const beyond_edge =
    "Array.from(document.querySelectorAll('body *')).filter((e) => !e.closest('.scroll, .extremes, .hidden, .skip, "
    ".notes, pre, svg') && e.getClientRects().length && e.getBoundingClientRect().right > innerWidth + 1).map((e) => "
    "e.tagName + ' ' + e.className + ' ' + e.textContent.slice(0, 30))";
// A chart in the middle of the screen, drawn.
const char* const show_chart =
    "new Promise((done) => { document.documentElement.style.scrollBehavior = 'auto'; const chart = "
    "document.activeElement.closest('.chart') || Array.from(document.querySelectorAll('.chart')).find((one) => "
    "one.getClientRects().length), until = performance.now() + 10000; chart.scrollIntoView({block: 'center'}); "
    "(function look() { chart.querySelector('canvas') || performance.now() > until ? done(scrollY) : "
    "requestAnimationFrame(look); })(); })";

std::string file_of(const std::string& name) {
  return (std::filesystem::path(tests::places().build) / "browser" / "reading-print" / name).string();
}

}  // namespace

TEST_CASE("on a phone nothing is wider than the screen, and a swipe over a chart scrolls the page",
          "[report][browser]") {
  if (left_out()) return;
  browser::Json steps = browser::Json::array();
  for (const std::string kind : read_kinds) {
    steps.push_back({{"name", kind},
                     {"page", report_of("studies", kind)},
                     {"width", 420},
                     {"height", 900},
                     {"touch", true},
                     {"before", {show_chart}},
                     {"swipe", {{"x", 210}, {"from", 520}, {"to", 380}}},
                     {"evaluate", {page_width, "scrollY", beyond_edge}}});
  }
  const browser::Json said = driven("reading-phone", steps);
  for (const std::string kind : read_kinds) {
    INFO(kind);
    const browser::Json& values = said.at(kind).at("values");
    CHECK(values.at(0) == 420);
    const double before = said.at(kind).at("before").at(0), after = values.at(1);
    CHECK(after > before + 60);  // a swipe of 140 pixels, less what a browser takes to see that it is one
    CHECK(values.at(2) == browser::Json::array());
  }
}

TEST_CASE(
    "nothing passes an edge, no words lie on each other, all letters can be read, at any width, on a dark screen and "
    "on paper",
    "[report][browser]") {
  if (left_out()) return;
  const std::string audit = read_text(tests::places().source + "/tests/runners/report/browser/audit.js");
  browser::Json steps = browser::Json::array();
  const auto add = [&](const std::string& kind, const std::string& how, int width) -> browser::Json& {
    steps.push_back({{"name", kind + " " + how},
                     {"page", report_of("studies", kind)},
                     {"width", width},
                     {"height", 1000},
                     {"evaluate", {audit}}});
    return steps.back();
  };
  std::vector<std::string> kinds(std::begin(read_kinds), std::end(read_kinds));
  for (const char* more : {"asks", "film"}) kinds.emplace_back(more);
  for (const std::string& kind : kinds) {
    for (const int width : {1400, 800, 390}) add(kind, std::to_string(width), width);
    add(kind, "dark", 1400)["dark"] = true;
    add(kind, "paper", 680)["print"] = true;  // CSS pixels between the margins of A4
  }
  const browser::Json said = driven("reading-audit", steps);
  for (const auto& [name, answer] : said.items()) {
    INFO(name);
    CHECK(answer.at("values").at(0) == browser::Json::array());
  }
}

TEST_CASE("a legend names what the shown view needs, and folds no more than its list of methods", "[report][browser]") {
  if (left_out()) return;
  const char* const headings =
      "(() => { const {section, description} = ricochet.figures.find((one) => one.description.id === "
      "'diagram'), all = (selector) => Array.from(section.querySelectorAll('.legend ' + selector)); return "
      "description.views.map((name, view) => { section.querySelector('[data-view=\"' + view + '\"]').click(); return "
      "[name, all('> .entries').filter((one) => one.getClientRects().length).map((one) => "
      "one.querySelector('.heading').textContent), all('details button').length]; }); })()";
  const browser::Json views =
      driven("reading-legend",
             {{{"name", "legend"}, {"page", report_of("studies", "bifurcation")}, {"evaluate", {headings}}}})
          .at("legend")
          .at("values")
          .at(0);
  REQUIRE(views.size() > 1);
  for (const browser::Json& view : views) {
    const bool overlaid = view.at(0) == "overlaid";
    INFO(view.dump());
    CHECK((std::count(view.at(1).begin(), view.at(1).end(), "Method") == 1) == overlaid);
    CHECK((std::count(view.at(1).begin(), view.at(1).end(), "Regime") == 1) == !overlaid);
    CHECK(view.at(2) == 0);
  }
}

TEST_CASE("a wide table keeps its first column and says that it goes on", "[report][browser]") {
  if (left_out()) return;
  const char* const scrolled =
      "(() => { const box = document.getElementById('cases').closest('.scroll'), cell = "
      "document.getElementById('cases').tBodies[0].rows[0].cells[0], at = () => "
      "Math.round(cell.getBoundingClientRect().left), first = at(), wide = box.dataset.wide, hint = "
      "getComputedStyle(box, '::before').content; box.scrollLeft = 300; return [wide, hint, first, at(), "
      "box.tabIndex]; })()";
  const browser::Json values = driven("reading-table", {{{"name", "table"},
                                                         {"page", report_of("studies", "trajectory")},
                                                         {"width", 420},
                                                         {"height", 900},
                                                         {"evaluate", {scrolled}}}})
                                   .at("table")
                                   .at("values")
                                   .at(0);
  CHECK(values.at(0) == "more");
  CHECK_THAT(values.at(1).get<std::string>(), Contains("columns go on"));
  CHECK(values.at(2) == values.at(3));
  CHECK(values.at(4) == 0);
}

TEST_CASE("the table of cases takes words and conditions, and gives what it shows as CSV", "[report][browser]") {
  if (left_out()) return;
  const auto filtered = [](const std::string& text) {
    return "(() => { const box = document.getElementById('filter'); box.value = '" + text +
           "'; box.dispatchEvent(new Event('input')); return [Array.from(document.querySelectorAll('#cases tbody "
           "tr')).filter((row) => !row.hidden).length, document.getElementById('shown').textContent]; })()";
  };
  const std::string heads =
      "Array.from(document.querySelectorAll('#cases thead th')).slice(0, 3).map((head) => head.dataset.column)";
  const browser::Json values =
      driven("reading-cases",
             {{{"name", "cases"},
               {"page", report_of("studies", "trajectory")},
               {"evaluate",
                {heads, filtered(""), filtered("status = done"), filtered("status != done"), filtered("step > 0.015"),
                 filtered("step <= 0.015 signorini"), filtered("first release > 0"), filtered("enrgy_left > 0"),
                 filtered("step >"), filtered("contact=signorini"), "ricochet.casesShown()",
                 filtered("first release <= 0")}}}})
          .at("cases")
          .at("values");
  CHECK(values.at(0) == browser::Json({"case", "status", "contact"}));
  const int all = values.at(1).at(0);
  CHECK(all > 2);
  const int done = values.at(2).at(0), others = values.at(3).at(0);
  CHECK((done > 0 && others > 0 && done + others == all));
  const int coarse = values.at(4).at(0);
  CHECK((coarse > 0 && coarse < all));
  CHECK((values.at(5).at(0) > 0 && values.at(5).at(0) < all - coarse));
  // Cases without such a measure are neither above nor below.
  const int above = values.at(6).at(0), below = values.at(11).at(0);
  CHECK((above > 0 && above + below < all));
  CHECK(values.at(7).at(1) == "no column is called “enrgy_left”; did you mean energy_left?");
  CHECK_THAT(values.at(8).at(1).get<std::string>(), Contains("expects a value"));
  const std::string csv = values.at(10);
  CHECK_THAT(csv, Catch::Matchers::StartsWith("case,status,contact,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + values.at(9).at(0).get<int>());
  CHECK_THAT(csv, !Contains(",penalty,"));
}

TEST_CASE("a dark screen is dark, and its words and charts stand out", "[report][browser]") {
  if (left_out()) return;
  // Contrast of every element with words of its own against what lies behind it (WCAG 2.1), the least of them.
  const char* const least_contrast = R"js((() => {
    const { contrast, channels } = ricochet.theme, behind = (e) => {
      for (; e; e = e.parentElement) { const c = channels(getComputedStyle(e).backgroundColor); if (c && (c[3] === undefined || c[3] > 0.5)) return c; }
      return [255, 255, 255];
    };
    let least = [99, ""];
    for (const e of document.querySelectorAll("body *")) {
      if (!e.getClientRects().length || !Array.from(e.childNodes).some((n) => n.nodeType === 3 && n.textContent.trim())) continue;
      if (e.closest("[aria-pressed=false], svg, script, noscript, .skip")) continue;
      const found = contrast(channels(getComputedStyle(e).color), behind(e));
      if (found < least[0]) least = [found, e.tagName + "." + e.className + ": " + e.textContent.slice(0, 40)];
    }
    return least;
  })())js";
  const char* const paper = "ricochet.theme.channels(getComputedStyle(document.body).backgroundColor)";
  const char* const chart = R"js((() => {
    const slot = ricochet.figures.flatMap((f) => f.slots.map((s) => [f, s])).find(([f, s]) => f.visible(s) && f.viewOf(s)), [figure, first] = slot;
    if (!first.chart) figure.draw(first);
    const { contrast, channels, colour, letters } = ricochet.theme, ground = channels(colour("#ffffff")), seen = (said) => contrast(channels(colour(said)), ground);
    const colours = figure.viewOf(first).marks.map((mark) => mark.colour).filter((said) => typeof said === "string" && channels(said));
    return [ground, Math.min(...colours.concat(ricochet.ink).map((said) => seen(letters(said)))), Math.min(99, ...colours.map(seen))];
  })())js";
  browser::Json steps = browser::Json::array();
  // The screen turns light while the page is read, which carries what is drawn along.
  for (const std::string kind : read_kinds)
    steps.push_back({{"name", kind},
                     {"page", report_of("studies", kind)},
                     {"dark", true},
                     {"evaluate", {least_contrast, paper, chart}},
                     {"turn", {least_contrast, paper, chart}}});
  const browser::Json said = driven("reading-dark", steps);
  for (const std::string kind : read_kinds)
    for (const bool dark : {true, false}) {
      const browser::Json& values = said.at(kind).at(dark ? "values" : "turned");
      INFO(kind << " " << dark << " " << values);
      CHECK(values.at(0).at(0) >= 4.5);
      CHECK((values.at(1).at(0) < 60) == dark);
      CHECK((values.at(2).at(0).at(0) < 60) == dark);
      CHECK(values.at(2).at(1) >= 4.5);
      // A band that is pale on white may be as faint on a dark ground.
      const double light = said.at(kind).at("turned").at(2).at(2);
      if (dark) CHECK(values.at(2).at(2) >= std::min(3.0, light));
    }
}

TEST_CASE("a film and the patches of legends stand out on a dark screen, and have the colours of paper in print",
          "[report][browser]") {
  if (left_out()) return;
  const std::string seen = R"js((() => {
    if (!ricochet.film.films) ricochet.film.load();
    const { contrast, channels, ink } = ricochet.theme, paper = getComputedStyle(document.body).backgroundColor, names = [...document.querySelectorAll(".film-name")].map((name) => getComputedStyle(name).color);
    const drawn = ricochet.film.films.map((film) => ricochet.theme.colour(film.colour)), patches = [...document.querySelectorAll(".legend line")].map((line) => line.getAttribute("stroke"));
    return [Math.min(...names.concat(drawn, ink()).map((one) => contrast(channels(one), channels(paper)))), drawn, ink(), patches, names.map(channels)];
  })())js";
  const std::string printed = "(() => { dispatchEvent(new Event('beforeprint')); const out = " + seen +
                              "; dispatchEvent(new Event('afterprint')); return out; })()";
  const browser::Json said = driven("reading-film", {{{"name", "film"},
                                                      {"page", report_of("studies", "film")},
                                                      {"dark", true},
                                                      {"evaluate", {seen, printed, seen}},
                                                      {"turn", {seen}}}})
                                 .at("film");
  const browser::Json &dark = said.at("values").at(0), &paper = said.at("values").at(1),
                      &light = said.at("turned").at(0);
  CHECK(dark.at(0) >= 4.5);
  CHECK(light.at(0) >= 3.8);  // Okabe and Ito's orange on white
  CHECK(paper.at(1) == browser::Json({"#0072B2", "#D55E00"}));
  CHECK(paper.at(1) == light.at(1));
  CHECK(paper.at(2) == "#222222");
  CHECK(paper.at(3) == light.at(3));
  CHECK(paper.at(3) != dark.at(3));
  CHECK(paper.at(4) == light.at(4));
  // Legends grow as figures come near and are drawn; the others are as they were.
  for (const std::size_t k : {0U, 1U, 2U, 4U}) CHECK(said.at("values").at(2).at(k) == dark.at(k));
}

TEST_CASE("a list of studies is read on a phone, one after the other", "[report][browser]") {
  if (left_out()) return;
  std::string folders;
  for (const char* kind : {"film", "stability"})
    folders += " '" + std::filesystem::path(report_of("index", kind)).parent_path().string() + "'";
  const std::string file = (std::filesystem::path(tests::places().build) / "browser" / "index" / "index.html").string();
  words_of(tests::places().command + " report" + folders + " --out '" + file + "'");
  const char* const cells =
      "[...document.querySelectorAll('.studies tbody :is(th, td)')].map((cell) => "
      "cell.getBoundingClientRect()).map((box) => box.width > 200 && box.right <= innerWidth)";
  const browser::Json said =
      driven("reading-index",
             {{{"name", "index"}, {"page", file}, {"width", 420}, {"height", 900}, {"evaluate", {page_width, cells}}}})
          .at("index")
          .at("values");
  CHECK(said.at(0) == 420);
  CHECK(said.at(1) == browser::Json(std::vector<bool>(10, true)));
}

TEST_CASE("paper stays white, whatever the screen", "[report][browser]") {
  if (left_out()) return;
  // What stands on paper is drawn from the colours as they are said.
  const char* const drawn = R"js((() => {
    ricochet.paper.prepare();
    const svg = document.querySelector(".on-paper svg"), ground = svg.querySelector("rect").getAttribute("fill"), width = Number(svg.getAttribute("width"));
    ricochet.paper.finish();
    return [ground, width, document.querySelectorAll(".on-paper").length];
  })())js";
  const browser::Json values =
      driven("reading-paper",
             {{{"name", "paper"}, {"page", report_of("studies", "trajectory")}, {"dark", true}, {"evaluate", {drawn}}}})
          .at("paper")
          .at("values")
          .at(0);
  CHECK((values.at(0) == "#ffffff" || values.at(0) == "#fff" || values.at(0) == "rgb(255,255,255)"));
  CHECK(values.at(1) <= 680);
  CHECK(values.at(2) == 0);
}

TEST_CASE("a summary that is asked for stands alone, with its figure", "[report][browser]") {
  if (left_out()) return;
  const std::string seen =
      "[...['header', 'main', 'footer', '#summary', '#summary-figure svg'].map((one) => { const part = "
      "document.querySelector(one); return Boolean(part) && part.getClientRects().length > 0; })]";
  const std::string follow =
      "new Promise((done) => { addEventListener('hashchange', () => done(0), {once: true}); "
      "document.querySelector('a[href=\"#summary\"]').click(); })";
  const browser::Json said = driven("reading-summary", {{{"name", "summary"},
                                                         {"page", report_of("studies", "trajectory")},
                                                         {"before", {seen}},
                                                         {"evaluate", {follow, seen}}}})
                                 .at("summary");
  CHECK(said.at("before").at(0) == browser::Json({true, true, true, false, false}));
  CHECK(said.at("values").at(1) == browser::Json({false, false, false, true, true}));
}

TEST_CASE("a printed report has a summary on its first page, numbered pages, and nothing beyond the sheet",
          "[report][browser]") {
  if (left_out()) return;
  std::filesystem::create_directories(file_of(""));
  browser::Json steps = browser::Json::array();
  for (const std::string kind : read_kinds)
    steps.push_back({{"name", kind},
                     {"page", report_of("studies", kind)},
                     {"evaluate",
                      {"document.querySelector('.question').textContent",
                       "document.querySelector('#summary .answer li').textContent",
                       "Array.from(document.querySelectorAll('#summary dd'), (one) => one.textContent).find((text) => "
                       "/^[0-9a-f]{16} /.test(text)).slice(0, 16)",
                       "document.querySelectorAll('.figure .chart').length"}},
                     {"pdf", file_of(kind + ".pdf")}});
  const browser::Json answers = driven("reading-print", steps);
  const auto flat = [](std::string text) { return std::regex_replace(text, std::regex("[\\s-]+"), ""); };
  for (const std::string kind : read_kinds) {
    INFO(kind);
    const browser::Json& values = answers.at(kind).at("values");
    const std::string pdf = "'" + file_of(kind + ".pdf") + "'";
    const std::string info = words_of("pdfinfo " + pdf), first = flat(words_of("pdftotext -l 1 " + pdf + " -"));
    std::smatch pages;
    REQUIRE(std::regex_search(info, pages, std::regex("Pages: +([0-9]+)")));
    CHECK_THAT(info, Contains("A4"));
    CHECK_THAT(first, Contains(flat(values.at(0))));
    CHECK_THAT(first, Contains(flat(values.at(1)).substr(0, 60)));
    CHECK_THAT(first, Contains(values.at(2).get<std::string>()));
    CHECK_THAT(first, Contains("page1of" + pages[1].str()));
    CHECK_THAT(first, Contains("Identity"));    // the end of the summary is on the first page,
    CHECK_THAT(first, !Contains("Skiptothe"));  // and nothing of the screen is
    const std::string second = flat(words_of("pdftotext -f 2 -l 2 " + pdf + " -"));
    CHECK_THAT(second, Contains("Ricochet"));  // the report begins on a page of its own
    // Words that end right of the sheet's margin.
    const std::string boxes = words_of("pdftotext -bbox " + pdf + " -");
    const std::regex word("<word xMin=\"[0-9.]+\" yMin=\"[0-9.]+\" xMax=\"([0-9.]+)\"[^>]*>([^<]*)<");
    for (std::sregex_iterator at(boxes.begin(), boxes.end(), word); at != std::sregex_iterator(); ++at) {
      const double right = std::stod((*at)[1]);
      if (right > 595.3 - 15 * 72 / 25.4 + 1) FAIL_CHECK((*at)[2] << " ends at " << right << " of 595 points");
    }
  }
}

TEST_CASE("a report is worked by keys, and says in words what its charts show", "[report][browser]") {
  if (left_out()) return;
  const char* const focused = "document.activeElement.className + ' ' + document.activeElement.textContent";
  const char* const outline = "getComputedStyle(document.activeElement).outlineStyle";
  const std::string until_chart =
      "(() => { const charts = document.querySelectorAll('.figure .chart'); return [charts.length, "
      "Array.from(charts).filter((one) => one.tabIndex === 0).length, "
      "document.querySelectorAll('main').length, document.querySelectorAll('nav[aria-label]').length, "
      "document.documentElement.lang, Array.from(document.querySelectorAll('button, input')).filter((one) => "
      "!(one.textContent.trim() || one.getAttribute('aria-label') || one.closest('label') || one.title)).length]; })()";
  browser::Json steps = {
      {{"name", "skip"},
       {"page", report_of("studies", "trajectory")},
       {"keys", {"Tab"}},
       {"evaluate", {focused, outline}}},
      {{"name", "skipped"},
       {"page", report_of("studies", "trajectory")},
       {"keys", {"Tab", "Enter"}},
       {"evaluate", {"location.hash"}}},
      {{"name", "data"},
       {"page", report_of("studies", "trajectory")},
       {"before", {"document.querySelector('#figure-final-energy-step .chart').focus()", show_chart}},
       {"keys", {"Enter"}},
       {"evaluate",
        {"document.querySelectorAll('.chart-data tbody tr').length",
         "document.querySelector('.chart-data thead').textContent",
         "document.querySelector('#figure-final-energy-step [data-points]').getAttribute('aria-expanded')",
         "document.querySelector('#figure-final-energy-step .chart').getAttribute('aria-label')",
         "ricochet.figures.find((one) => one.description.id === "
         "'final-energy-step').slots[0].chart.view.marks.reduce((sum, one) => sum + "
         "ricochet.plot.countOf(one), 0)"}}},
      {{"name", "again"},
       {"page", report_of("studies", "trajectory")},
       {"before", {"document.querySelector('#figure-final-energy-step .chart').focus()", show_chart}},
       {"keys", {"Enter", "Enter"}},
       {"evaluate", {"document.querySelectorAll('.chart-data').length"}}}};
  for (const std::string kind : read_kinds)
    steps.push_back({{"name", kind}, {"page", report_of("studies", kind)}, {"evaluate", {until_chart}}});
  const browser::Json said = driven("reading-keys", steps);
  CHECK_THAT(said.at("skip").at("values").at(0).get<std::string>(), Contains("Skip to the answer"));
  CHECK(said.at("skip").at("values").at(1) == "solid");
  CHECK(said.at("skipped").at("values").at(0) == "#answer");
  const browser::Json& data = said.at("data").at("values");
  CHECK(data.at(0).get<int>() > 0);
  CHECK((data.at(0) == data.at(4) || data.at(0) == 200));
  CHECK_THAT(data.at(1).get<std::string>(), Contains("step h (s)"));
  CHECK(data.at(2) == "true");
  const std::string label = data.at(3);
  CHECK_THAT(label, Contains("Energy at the end against step h"));
  CHECK_THAT(label, Contains("3 series (newmark-dumont-paoli, beta 0"));
  CHECK_THAT(label, Contains("across step h from "));
  CHECK_THAT(label, Contains("upwards E(T) / E_in from "));
  CHECK(said.at("again").at("values").at(0) == 0);
  for (const std::string kind : read_kinds) {
    INFO(kind);
    const browser::Json& page = said.at(kind).at("values").at(0);
    CHECK(page.at(0).get<int>() > 0);
    CHECK(page.at(0) == page.at(1));
    CHECK(page.at(2) == 1);
    CHECK(page.at(3) == 1);
    CHECK(page.at(4) == "en");
    CHECK(page.at(5) == 0);
  }
}

TEST_CASE("tables are copied in three forms, and a view is sent by its address", "[report][browser]") {
  if (left_out()) return;
  const std::string page = report_of("studies", "trajectory");
  const std::string copied =
      "['CSV', 'Markdown', 'LaTeX'].map((form) => ricochet.tableText(document.querySelector('.asked table'), form))";
  const std::string chosen =
      "(() => { const figure = ricochet.figures.find((one) => one.description.id === 'energy'), {section} = figure; "
      "figure.drawAll(); section.querySelectorAll('[data-view]')[1].click(); section.querySelector('.legend "
      "button').click(); figure.slots[0].chart.zoom({x: [1, 2]}); return location.hash; })()";
  // The page goes to its place in its own time.
  const std::string shown =
      "new Promise((done) => { const figure = ricochet.figures.find((one) => one.description.id === 'energy'), until = "
      "performance.now() + 60000; figure.drawAll(); (function look() { scrollY > 0 || performance.now() > until ? "
      "done([figure.view, figure.hidden.size, figure.slots[0].chart.plot.xs[0].axis.min, scrollY > 0, "
      "figure.section.querySelectorAll('.legend [aria-pressed=false]').length]) : requestAnimationFrame(look); })(); "
      "})";
  const browser::Json first =
      driven("reading-address",
             {{{"name", "first"},
               {"page", page},
               {"evaluate", {copied, chosen, "(ricochet.address.ofCases('status = done'), location.hash)"}}}})
          .at("first")
          .at("values");
  const std::string csv = first.at(0).at(0), markdown = first.at(0).at(1), latex = first.at(0).at(2),
                    address = first.at(1), both = first.at(2);
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  CHECK(lines(csv) > 2);
  CHECK(lines(markdown) == lines(csv) + 1);
  CHECK(lines(latex) == lines(csv) + 5);
  CHECK_THAT(latex, Catch::Matchers::StartsWith("\\begin{tabular}{l"));
  CHECK_THAT(address, Catch::Matchers::StartsWith("#figure-energy?view=1&hide=") && Contains("&from=1&to=2"));
  const browser::Json again =
      driven("reading-address", {{{"name", "sent"}, {"page", page + address}, {"evaluate", {shown}}},
                                 {{"name", "cases"},
                                  {"page", page + "#all-cases?filter=status+%3D+done"},
                                  {"evaluate", {"document.getElementById('shown').textContent"}}},
                                 {{"name", "both"},
                                  {"page", page + both},
                                  {"evaluate", {"document.getElementById('shown').textContent", shown}}}});
  // What was set at one place stays where another is set later.
  CHECK_THAT(both, Catch::Matchers::StartsWith("#all-cases?filter=") && Contains("&also=figure-energy"));
  CHECK_THAT(again.at("both").at("values").at(0).get<std::string>(), Contains(" rows shown"));
  CHECK(again.at("both").at("values").at(1) == browser::Json({1, 1, 1, true, 1}));
  CHECK(again.at("sent").at("values").at(0) == browser::Json({1, 1, 1, true, 1}));
  CHECK_THAT(again.at("cases").at("values").at(0).get<std::string>(), Contains(" rows shown"));
}

TEST_CASE("figures are written as SVG and CSV, and as pages of one PDF", "[report][browser]") {
  if (left_out()) return;
  namespace fs = std::filesystem;
  const fs::path report = report_of("figures", "stability"), out = report.parent_path().parent_path() / "files";
  fs::remove_all(out);
  words_of(tests::places().command + " report '" + report.parent_path().string() + "' --figures '" + out.string() +
           "'");
  int drawings = 0, tables = 0;
  for (const auto& entry : fs::directory_iterator(out)) {
    INFO(entry.path());
    const std::string text = read_text(entry.path());
    if (entry.path().extension() == ".svg") {
      ++drawings;
      CHECK_THAT(text,
                 Catch::Matchers::StartsWith("<svg ") && Contains("xmlns=") && Catch::Matchers::EndsWith("</svg>"));
    } else if (entry.path().extension() == ".csv") {
      ++tables;
      CHECK(text.find(',') < text.find('\n'));
    }
  }
  CHECK(drawings > 4);
  CHECK(tables == drawings);
  // The answer's figure by all digits, the ends of its intervals in columns.
  const std::string steps = read_text(out / "ask-1.csv");
  CHECK_THAT(steps, Catch::Matchers::StartsWith("name,group"));
  CHECK_THAT(steps, Contains("value (s)") && !Contains("±"));
  CHECK_THAT(words_of("pdfinfo '" + (out / "figures.pdf").string() + "'"),
             Contains(std::regex_replace("Pages:           N", std::regex("N"), std::to_string(drawings))));
  // Where there is no browser the sentence says what to install.
  const std::string alone = "RICOCHET_BROWSER=/nowhere " + tests::places().command + " report '" +
                            report.parent_path().string() + "' --figures '" + out.string() + "' 2>&1; true";
  CHECK_THAT(words_of(alone), Contains("RICOCHET_BROWSER names \"/nowhere\", and there is no such program"));
}
