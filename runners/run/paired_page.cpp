// Two results beside each other, as a page.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/report/ask_figure.hpp"
#include "runners/report/assets.hpp"
#include "runners/report/html.hpp"
#include "runners/run/asked_text.hpp"
#include "runners/run/pair_results.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

using asks::VerdictRow;
using report::Fill;
using report::HtmlTable;
using Values = std::vector<const PairedValue*>;

constexpr std::size_t most_drawn = 12, most_rows = 400;

std::string unit_text(const VerdictRow& row) {
  return row.unit.empty() || row.unit == "1" ? "" : " " + row.unit;
}

std::string words_of(const VerdictRow& row) {
  const std::string words = subject_words(row);
  if (row.stop.empty() || words.find(row.stop) != std::string::npos) return words;
  return words + (words.empty() ? "" : " at ") + row.stop;
}

std::string name_of(const PairedValue& value, bool with_measure) {
  const std::string measure = with_measure ? words_of(value.any()) : "", level = value.level();
  const std::string name = measure + (measure.empty() || level.empty() ? "" : ", ") + level;
  return name.empty() ? "all" : name;
}

/// Values of one unit beside each other, as rows of two; "" where too many or none has a value in both.
std::string figure_of(const Values& values, bool with_measure) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::set<std::string> units;
  std::size_t drawn = 0;
  for (const PairedValue* one : values) {
    if (!one->a || !one->b || !one->a->value || !one->b->value) continue;
    if (++drawn > most_drawn) return "";
    units.insert(one->any().unit);
    for (const auto& [name, row] : {std::pair("A", &*one->a), {"B", &*one->b}}) {
      rows.push_back({{"pair", name_of(*one, with_measure)}, {"name", name}, {"value", *row->value}});
      if (row->low && row->high) rows.back().update({{"low", *row->low}, {"high", *row->high}});
    }
  }
  if (rows.empty() || units.size() != 1) return "";
  const VerdictRow& any = values.front()->any();
  return report::figure_svg({{"form", "pairs"},
                             {"measure", with_measure ? "value" : words_of(any)},
                             {"unit", any.unit == "1" ? "" : any.unit},
                             {"rows", std::move(rows)}});
}

std::string group_html(const std::string& head, const std::string& id, const Values& values) {
  if (values.empty() && head.empty()) return "";
  std::set<std::string> measures, units;
  bool verdicts = false;
  for (const PairedValue* one : values) {
    measures.insert(words_of(one->any()));
    units.insert(unit_text(one->any()).empty() ? "" : one->any().unit);
    for (const auto& row : {one->a, one->b}) verdicts = verdicts || (row && !row->verdict.empty());
  }
  const bool with_measure = measures.size() > 1;
  const auto head_of = [&](const char* name) {
    return HtmlTable::Head{
        units.size() == 1 && !units.begin()->empty() ? fmt::format("{} ({})", name, *units.begin()) : name, true};
  };
  HtmlTable table("", {{"value of"}, {"change"}, head_of("A"), head_of("B"), {"B − A", true}, {"u of both", true}},
                  "verdicts");
  if (verdicts) table.add({"verdicts"});
  for (const PairedValue* one : values) {
    table.row(name_of(*one, with_measure));
    table.text(word(one->change), one->change == PairChange::beyond ? "changed" : "");
    for (const auto& row : {one->a, one->b})
      if (row && (row->value || row->low))
        table.number(value_cell(*row) + (units.size() == 1 ? "" : unit_text(*row)));
      else
        table.absent();
    table.number(one->difference, 3).number(one->u, 3);
    if (!verdicts) continue;
    const std::string a = one->a ? one->a->verdict : "–", b = one->b ? one->b->verdict : "–";
    table.text(a == b ? a : a + " → " + b);
  }
  const std::string figure = figure_of(values, with_measure);
  return fmt::format("<div class=\"asked\" id=\"{}\">\n{}<div class=\"told\">\n{}{}</div></div>\n", id, head,
                     table.html(most_rows), figure.empty() ? "" : "<div class=\"scroll drawn\">" + figure + "</div>\n");
}

std::string asks_html(const PairedResults& pairs) {
  std::string out;
  for (std::size_t k = 0; k < pairs.asks.size(); ++k) {
    const PairedAsk& ask = pairs.asks[k];
    Values values;
    for (const PairedValue& one : pairs.values)
      if (one.table == "verdicts" && one.of == ask.ask) values.push_back(&one);
    std::string head;
    const auto line = [&](const char* which, const asks::Answered* answered) {
      head += fmt::format("<p class=\"headline\"><b>{}</b> {}</p>\n", which,
                          answered ? report::escape(answered->sentence) : "does not ask this.");
    };
    if (ask.a && ask.b && ask.a->sentence == ask.b->sentence) {
      line("A and B:", ask.a);
    } else {
      line("A:", ask.a);
      line("B:", ask.b);
    }
    out += group_html(head, fmt::format("ask-{}", k + 1), values);
  }
  return out;
}

/// A table's values, a group for each measure and unit.
std::string table_html(const PairedResults& pairs, const char* name) {
  InOrderMet<std::string, Values> groups;
  for (const PairedValue& one : pairs.values)
    if (one.table == name) groups[words_of(one.any()) + unit_text(one.any())].push_back(&one);
  std::string out;
  std::size_t k = 0;
  for (const auto& [words, values] : std::move(groups).list())
    out += group_html("<h3>" + report::escape(words_of(values.front()->any())) + "</h3>\n",
                      fmt::format("{}-{}", name, ++k), values);
  return out;
}

std::string facts_html(const PairedResults& pairs, const StudyResults& a, const StudyResults& b) {
  HtmlTable table("", {{"differs"}, {"A"}, {"B"}}, "plain environment");
  const auto add = [&](const std::string& name, const std::string& in_a, const std::string& in_b) {
    if (in_a != in_b) table.row(name).text(in_a.empty() ? "–" : in_a).text(in_b.empty() ? "–" : in_b);
  };
  add("name", a.name, b.name);
  add("cases", std::to_string(a.cases.size()), std::to_string(b.cases.size()));
  add("ran", environment_entry(a.environment, kStarted), environment_entry(b.environment, kStarted));
  for (const ChangedText& one : pairs.facts.inputs)
    if (one.where != "/name") add("study " + one.where, one.a, one.b);
  for (const ChangedText& one : pairs.facts.environment) add(one.where, one.a, one.b);
  const StudyComparison& facts = pairs.facts;
  const std::string cases = fmt::format(
      "Cases: {} in both, {} only in A, {} only in B, {} with another status. Of {} in these, {} are equal to the last "
      "bit, {} within round-off, {} beyond it.",
      facts.pairs.size(), facts.only_a.size(), facts.only_b.size(), facts.status_changes().size(),
      report::count_text(facts.measures.size(), "number", "numbers"), facts.count(NumberChange::none),
      facts.count(NumberChange::round_off), facts.count(NumberChange::beyond));
  return (table.size() == 0 ? "<p>The studies and what computed them are the same.</p>\n" : table.html(most_rows)) +
         "<p class=\"fine\">" + cases + "</p>\n";
}

}  // namespace

std::string paired_page(const PairedResults& pairs, const AnalysedResults& a, const AnalysedResults& b) {
  Fill page;
  page.set("style", std::string(report::asset("page.css")));
  page.set("kind", a.kind);
  page.set("a", a.name);
  page.set("b", b.name);
  page.set("verdict", paired_verdict(pairs));
  page.set("counts", counts_line(pairs));
  page.set("facts", facts_html(pairs, a, b));
  for (const auto& [key, html] : {std::pair("asks", asks_html(pairs)),
                                  {"limits", table_html(pairs, "limits")},
                                  {"stops", table_html(pairs, "uncertainty")}})
    if (!html.empty()) {
      Fill part;
      part.set("html", html);
      page.set(key, part);
    }
  return report::filled("pair", page);
}

}  // namespace ricochet
