#include "tests/runners/report/browser/browser.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/places.hpp"
#include "tests/runners/report/browser/driven.hpp"
#include "tests/runners/report/rendered.hpp"

namespace ricochet::browser {
namespace {

namespace fs = std::filesystem;
const fs::path source = tests::places().source + "/tests/runners/report/browser";

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The probe goes before everything else of the page, so that it hears of every error.
std::string with_probe(const Page& page) {
  std::string out = page.html, asked = Json{{"controls", page.controls}, {"numbers", page.numbers}}.dump();
  for (size_t at = 0; (at = asked.find('"', at)) != std::string::npos; at += 6) asked.replace(at, 1, "&quot;");
  const size_t html = out.find("<html lang=\"en\">");
  REQUIRE(html != std::string::npos);
  out.replace(html, 16, "<html lang=\"en\" data-asked=\"" + asked + "\">");
  const size_t head = out.find("<title>");
  REQUIRE(head != std::string::npos);
  return out.insert(head, "<script>" + content(source / "readback.js") + content(source / "probe.js") + "</script>");
}

}  // namespace

Page page_of(const std::string& name, const StudyResults& results) {
  return {name, synthetic::rendered(results)};
}

bool left_out() {
  const char* said = std::getenv("RICOCHET_WITHOUT_BROWSER");
  if (!said || std::string(said) != "1") return false;
  WARN("RICOCHET_WITHOUT_BROWSER is set: no report was opened in a browser");
  return true;
}

Json read_back(const std::string& folder, const std::vector<Page>& pages) {
  const fs::path here = fs::path(tests::places().build) / "browser" / folder;
  fs::remove_all(here);
  fs::create_directories(here);
  Json steps = Json::array(), out;
  for (const Page& page : pages) {
    const fs::path file = here / (page.name + ".html");
    std::ofstream(file, std::ios::binary) << with_probe(page);
    steps.push_back(
        {{"name", page.name}, {"page", file.string()}, {"width", 1300}, {"height", 1800}, {"evaluate", {"probed"}}});
  }
  INFO("what the browser was given is in " << here);
  Json answers = driven(folder, steps);
  for (auto& [name, answer] : answers.items()) {
    INFO("page " << name);
    out[name] = std::move(answer.at("values").at(0));
    REQUIRE(out[name].at("errors") == Json::array());
  }
  return out;
}

bool has_figure(const Json& page, const std::string& id) {
  return std::any_of(page.at("figures").begin(), page.at("figures").end(),
                     [&](const Json& f) { return f.at("id") == id; });
}

const Json& figure(const Json& page, const std::string& id) {
  for (const Json& one : page.at("figures"))
    if (one.at("id") == id) return one;
  FAIL("no figure " << id);
  static const Json none;
  return none;
}

std::vector<Json> series_of(const Json& figure, size_t view, const Accept& accept) {
  std::vector<Json> out;
  for (const Json& chart : figure.at("charts"))
    if (view < chart.at("views").size())
      for (const Json& series : chart.at("views")[view].at("series"))
        if (accept(series)) out.push_back(series);
  return out;
}

std::vector<Json> items_of(const Json& figure, size_t view, const Accept& accept) {
  std::vector<Json> out;
  for (const Json& series : series_of(figure, view, accept))
    for (const Json& item : series.at("data")) out.push_back(item);
  return out;
}

bool is_curve(const Json& series) {
  return series.at("mark") == "line" && series.value("size", Json()) == 8;
}
bool is_mark(const Json& series) {
  return series.at("mark") == "dots" || series.at("mark") == "words";
}
Accept named(const std::string& name) {
  return [name](const Json& series) { return series.at("name") == name; };
}

bool says(const Json& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const Json& text) { return text.get<std::string>().find(part) != std::string::npos; });
}

void require_works(const Json& page, size_t cases) {
  REQUIRE(!page.at("figures").empty());
  for (const Json& one : page.at("figures")) {
    INFO("figure " << one.at("id"));
    for (const Json& chart : one.at("charts")) {
      INFO("chart " << chart.at("title"));
      for (const Json& view : chart.at("views")) {
        const bool any =
            !view.at("sources").empty() || std::any_of(view.at("series").begin(), view.at("series").end(),
                                                       [](const Json& series) { return series.at("count") > 0; });
        // A curve across half of a small chart colours hundreds of pixels, a lone mark about 60.
        if (any) CHECK(view.at("coloured") > 40);
        for (const char* what : {"collisions", "beyond"})
          if (view.contains(what)) CHECK(view.at(what) == Json::array());
      }
    }
    for (const char* what : {"hidden", "linked", "aligned", "reset"})
      if (one.contains(what)) CHECK(one.at(what) == true);
    if (one.at("linked_along") == true) CHECK(one.contains("linked"));
    CHECK(one.at("anchored") == true);
    CHECK(one.at("charts").size() <= 50);  // 24 and, in views of their own, those of each start or measure
    if (one.at("charts").empty()) continue;
    CHECK(one.at("svg") > 2000);  // axes and their labels alone are about this many bytes
    CHECK(one.at("png") > 20000);
    CHECK(one.at("hovered").get<std::string>().find("<div") != std::string::npos);
  }
  CHECK(page.at("table").at("rows") == cases);
  CHECK(page.at("table").at("sorts") == true);
  CHECK(page.at("table").at("filtered") == 0);
  CHECK(page.at("table").at("restored") == cases);
}

}  // namespace ricochet::browser
