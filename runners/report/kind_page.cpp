#include "runners/report/kind_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "runners/report/assets.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/store/study_tables.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {

std::vector<std::string_view> scripts(std::initializer_list<const char*> names) {
  std::vector<std::string_view> out;
  for (const std::string name : names) {
    out.push_back(asset("kinds/" + name + ".js"));
    if (out.back().empty()) throw std::logic_error("no kind has a script " + name + ".js");
  }
  return out;
}

std::vector<Table> page_tables(const Choices& choices, const KindPage& page) {
  const StudyResults& results = choices.results();
  std::vector<Table> out;
  const auto add = [&](Table table) {
    if (!find_table(results.derived, table.name) && !table.rows.empty()) out.push_back(std::move(table));
  };
  for (const auto& make : page.derived) add(make(choices));
  add(effects_said(choices));
  return out;
}

namespace {

constexpr size_t most_shares = 12;  // that a chart shows

/// The share of a measure's variance that one choice, or an interaction, has.
struct MeasureShare {
  std::string factor;
  double share = 0, low = 0, high = 0;
  size_t order = 1;  ///< factors that take part; 4 for all that is higher, 0 for repeats
};

/// The shares of one measure, largest first.
struct MeasureShares {
  std::string name;
  bool log = false;
  std::vector<MeasureShare> shares;
  bool told() const { return !shares.empty() && shares.front().share > 0; }
};

std::vector<std::string> choices_in(const std::string& factor) {
  static const std::string times = " × ";
  std::vector<std::string> out;
  size_t from = 0;
  for (size_t at; (at = factor.find(times, from)) != std::string::npos; from = at + times.size())
    out.push_back(factor.substr(from, at - from));
  out.push_back(factor.substr(from));
  return out;
}

std::string source_of_spread(const MeasureShare& share, const std::string& first) {
  if (share.order == 4) return "interactions of more than three choices";
  if (share.order == 0) return "what the choices do not tell apart";
  std::vector<std::string> names = choices_in(share.factor);
  if (names.size() == 1) return spoken_choice(names[0]);
  const bool own = std::erase(names, first) > 0;
  std::string out = own ? "its interaction with " : "the interaction of ";
  for (size_t k = 0; k < names.size(); ++k)
    out += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + spoken_choice(names[k]);
  return out;
}

/// A share in per cent: two digits where it is small, no decimals where it is not.
std::string effects_percent(double share) {
  return share < 0.095 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

/// The table `effects` by measure.
std::vector<MeasureShares> measure_shares(const StudyResults& results) {
  std::vector<MeasureShares> out;
  for (const EffectRow& row : effects_type().read(results.derived)) {
    if (out.empty() || out.back().name != row.measure) out.push_back({row.measure, row.log, {}});
    MeasureShare share{row.factor, row.share, row.low.value_or(row.share), row.high.value_or(row.share), 1};
    share.order = share.factor == "higher" ? 4 : share.factor == "repeats" ? 0 : choices_in(share.factor).size();
    out.back().shares.push_back(std::move(share));
  }
  for (MeasureShares& measure : out)
    std::stable_sort(measure.shares.begin(), measure.shares.end(),
                     [](const MeasureShare& a, const MeasureShare& b) { return a.share > b.share; });
  return out;
}

/// "87 % of the spread of energy end comes from the mass matrix, 9 % from its interaction with the step."
std::string effects_sentence(const MeasureShares& measure) {
  if (!measure.told()) return fmt::format("No shares for {}.", in_words(measure.name));
  const MeasureShare& largest = measure.shares.front();
  const std::string first = largest.order == 1 ? largest.factor : "";
  std::string out =
      fmt::format("{} of the spread of {}{} comes from {}", effects_percent(largest.share), in_words(measure.name),
                  measure.log ? " (on a logarithmic scale)" : "", source_of_spread(largest, ""));
  for (size_t k = 1; k < std::min<size_t>(measure.shares.size(), 3); ++k)
    if (measure.shares[k].share >= 0.01)
      out += fmt::format(", {} from {}", effects_percent(measure.shares[k].share),
                         source_of_spread(measure.shares[k], first));
  return out + ".";
}

/// What the shares are not of: cases without the measure, choices that do not vary.
std::string effects_caveats(const Choices& choices, const MeasureShares& measure) {
  std::string out, statuses;
  size_t without = 0;
  for (const Status status : {Status::refused, Status::diverged, Status::failed, Status::done}) {
    size_t count = 0;
    for (const CaseRecord* record : with_status(all_cases(choices.results()), status))
      count += !ricochet::measure(*record, measure.name).has_value();
    without += count;
    if (count) statuses += fmt::format("{}{} {}", statuses.empty() ? "" : ", ", count, word(status));
  }
  const auto single = [&](const MeasureShare& share) {
    return share.share == 0 && share.order == 1 && !choices.varies(share.factor);
  };
  std::string fixed;
  for (const MeasureShare& share : measure.shares)
    if (single(share)) fixed += (fixed.empty() ? "" : ", ") + share.factor;
  // Choices without any share, and what of the spread no share tells.
  std::set<std::string> told;
  double sum = 0;
  for (const MeasureShare& share : measure.shares) {
    sum += share.share;
    for (const std::string& choice : choices_in(share.factor)) told.insert(choice);
  }
  std::string untold;
  for (const std::string& column : choices.results().columns)
    if (const std::string choice = axis_role(column); choices.varies(column) && told.insert(choice).second)
      untold += (untold.empty() ? "" : ", ") + spoken_choice(choice);
  constexpr double much = 0.05;
  if (!measure.told())
    out += " Either all its values are the same, too many cases have none, or round-off explains what differs.";
  else if (!untold.empty())
    out += fmt::format(
        " Choices of two levels have no share: {}{}.", untold,
        1 - sum > much ? fmt::format("; {} of the spread is theirs, or of no choice", effects_percent(1 - sum)) : "");
  if (without)
    out += fmt::format(" {} of {} have no value ({}){}.", without,
                       count_text(choices.results().cases.size(), "case", "cases"), statuses,
                       measure.told() ? "; what they would be is estimated from the others" : "");
  if (!fixed.empty()) out += fmt::format(" One level only, so no share: {}.", fixed);
  return out;
}

}  // namespace

Table effects_said(const Choices& choices) {
  Table out{"effects_said",
            "One row per measure: what the shares of effects.csv say, in words.",
            {{"measure", "", "Name of the measure, a column of cases.csv."},
             {"log", "", "Whether its logarithm was taken."},
             {"sentence", "", "The largest shares as a sentence."},
             {"caveats", "", "What the shares leave out."},
             {"rest", "1", "Number of small shares that a chart shows together."},
             {"rest_share", "1", "What these explain together."}},
            {}};
  for (const MeasureShares& measure : measure_shares(choices.results())) {
    size_t rest = 0;
    double together = 0;
    for (size_t k = most_shares; k < measure.shares.size(); ++k) {
      ++rest;
      together += measure.shares[k].share;
    }
    out.rows.push_back(
        {measure.name, measure.log, effects_sentence(measure), effects_caveats(choices, measure), rest, together});
  }
  return out;
}

std::string effects_html(const Choices& choices) {
  const std::vector<MeasureShares> all = measure_shares(choices.results());
  if (all.empty()) return "";
  // What the study observes first; where it observes none of these, all of them.
  const std::vector<answers::Clause> said = answers::answers_type().read(choices.results().derived);
  const auto main = [&](const MeasureShares& measure) {
    return std::any_of(said.begin(), said.end(), [&](const auto& one) { return one.measure == measure.name; });
  };
  const auto mains = static_cast<size_t>(std::count_if(all.begin(), all.end(), main));
  std::string first, rest;
  HtmlTable table("", {{"measure"}, {"choice"}, {"share", true}, {"interval", true}}, "plain");
  for (const MeasureShares& measure : all) {
    (mains == 0 || main(measure) ? first : rest) +=
        fmt::format("<li>{}<span class=\"fine\">{}</span></li>\n", escape(effects_sentence(measure)),
                    escape(effects_caveats(choices, measure)));
    for (const MeasureShare& share : measure.shares)
      if (share.share >= 1e-3) {
        table.row().text(in_words(measure.name) + (measure.log ? " (log)" : "")).text(share.factor);
        table.number(effects_percent(share.share), exact_text(share.share));
        table.number(effects_percent(share.low) + " to " + effects_percent(share.high));
      }
  }
  std::string sentences = "<ul class=\"answer\">\n" + first + "</ul>\n";
  if (!rest.empty())
    sentences += fmt::format("<details><summary>Of {} more</summary><ul class=\"answer\">\n{}</ul></details>\n",
                             count_text(all.size() - mains, "measure", "measures"), rest);
  if (table.size() == 0) return sentences;
  return sentences + "<details><summary>Shares of 0.1 % and more, with 95 % intervals</summary>\n" + table.html() +
         "</details>\n";
}

}  // namespace ricochet::report
