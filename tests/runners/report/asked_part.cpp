// The first screen of a study that asks: each sentence with all its rows and its figure, what warns above it.
#include "runners/report/asked_part.hpp"

#include <catch2/catch.hpp>

#include "runners/report/report.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::report;
using Catch::Matchers::Contains;
using synthetic::count;

namespace {

AskedPart part_of(std::size_t number, std::size_t rows) {
  AskedPart out;
  out.number = number;
  out.sentence = "Yes: sentence " + std::to_string(number) + ".";
  out.table = {{"level", "value (N)", "verdict"}, {}, 1};
  nlohmann::ordered_json drawn = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < rows; ++k) {
    out.table.rows.push_back({"level" + std::to_string(k) + ".", k == 0 ? "" : "7 ± 1", "yes"});
    drawn.push_back({{"name", "level" + std::to_string(k)}, {"value", 7.0}});
  }
  out.figure = {{"form", "bars"}, {"measure", "force"}, {"unit", "N"}, {"rows", drawn}};
  return out;
}

}  // namespace

TEST_CASE("every row of an answer is on its page, in a box of its own", "[report][asks]") {
  const std::string html = asked_html({{}, {part_of(1, 240)}});
  for (int k = 0; k < 240; ++k) CHECK_THAT(html, Contains(">level" + std::to_string(k) + ".</th>"));
  CHECK_THAT(html, !Contains("more") && !Contains("<details") && Contains("<div class=\"scroll"));
  CHECK(count(html, "<svg class=\"ask-figure\"") == 1);
  CHECK_THAT(html, Contains("<td class=\"number absent\">–</td>"));
}

TEST_CASE("what warns stands above the sentence that it touches, once", "[report][asks]") {
  AskedAnswers asked{{"Nothing touched a stop.", "<b>"}, {part_of(1, 2), part_of(2, 2)}};
  asked.parts[0].aside = asked.parts[1].aside = {"Left out: 2 diverged."};
  asked.parts[1].aside.push_back("Left out: 3 refused.");
  const std::string html = asked_html(asked);
  const auto at = [&](const std::string& text) { return html.find(text); };
  CHECK(at("Nothing touched") < at("Left out: 2"));
  CHECK(at("Left out: 2") < at("sentence 1"));
  CHECK(at("sentence 1") < at("Left out: 3"));
  CHECK(at("Left out: 3") < at("sentence 2"));
  CHECK(count(html, "2 diverged") == 1);
  CHECK_THAT(html, Contains("&lt;b&gt;"));
}

TEST_CASE("the chart of the kind stands beside the ask that it answers", "[report][asks]") {
  AskedAnswers asked{{}, {part_of(1, 2), part_of(2, 2)}};
  CHECK_THAT(asked_html(asked), !Contains("answer-figure"));
  // Of some without a figure none; of all without the first.
  asked.parts[0].figure = nullptr;
  CHECK_THAT(asked_html(asked), !Contains("answer-figure"));
  asked.parts[1].figure = nullptr;
  std::string html = asked_html(asked);
  CHECK(count(html, "answer-figure") == 1);
  CHECK(html.find("answer-figure") < html.find("id=\"ask-2\""));
  asked.parts[1].figure = {{"form", "own"}};
  html = asked_html(asked);
  CHECK(count(html, "answer-figure") == 1);
  CHECK(html.find("answer-figure") > html.find("id=\"ask-2\""));
}

TEST_CASE("what was not asked stands beneath what was", "[report][asks]") {
  const StudyResults results = synthetic::results();
  KindPage kind;
  kind.answer = [](const Choices&) { return std::string("<p>the kind's own</p>"); };
  kind.asked.parts = {part_of(1, 3)};
  const std::string page = render_report(Choices(results), kind);
  const std::size_t asked = page.find("id=\"ask-1\""), beneath = page.find("id=\"beneath\""),
                    own = page.find("the kind's own");
  REQUIRE(own != std::string::npos);
  CHECK(asked < beneath);
  CHECK(beneath < own);
  CHECK(own < page.find("id=\"figures\""));
}
