#include <fmt/format.h>

#include <algorithm>

#include "runners/report/evidence.hpp"
#include "runners/report/evidence_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/report/options.hpp"

namespace ricochet::report {
namespace {

constexpr size_t most_bars = 12;

struct Share {
  std::string factor;
  double share = 0, low = 0, high = 0;
  size_t order = 1;  ///< factors that take part; 4 for all that is higher, 0 for repeats
};

struct Measure {
  std::string name;
  bool log = false;
  std::vector<Share> shares;  ///< largest first
  bool told() const { return !shares.empty() && shares.front().share > 0; }
};

struct Kind {
  const char *name, *colour;
};
constexpr Kind kinds[] = {{"repeats", "#999999"},
                          {"one choice", "#0072B2"},
                          {"interaction of two", "#E69F00"},
                          {"interaction of three", "#009E73"},
                          {"higher interactions", "#CC79A7"}};

std::vector<std::string> members(const std::string& factor) {
  static const std::string times = " × ";
  std::vector<std::string> out;
  size_t from = 0;
  for (size_t at; (at = factor.find(times, from)) != std::string::npos; from = at + times.size())
    out.push_back(factor.substr(from, at - from));
  out.push_back(factor.substr(from));
  return out;
}

std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::vector<Measure> measures(const StudyResults& results) {
  const EvidenceRows rows(results, "effects");
  std::vector<Measure> out;
  for (size_t row = 0; row < rows.size(); ++row) {
    const std::string name = rows.text(row, "measure");
    if (out.empty() || out.back().name != name) out.push_back({name, rows.flag(row, "log"), {}});
    Share share{rows.text(row, "factor"), rows.number(row, "share").value_or(0), 0, 0, 1};
    share.low = rows.number(row, "low").value_or(share.share);
    share.high = rows.number(row, "high").value_or(share.share);
    share.order = share.factor == "higher" ? 4 : share.factor == "repeats" ? 0 : members(share.factor).size();
    out.back().shares.push_back(std::move(share));
  }
  for (Measure& measure : out)
    std::stable_sort(measure.shares.begin(), measure.shares.end(),
                     [](const Share& a, const Share& b) { return a.share > b.share; });
  return out;
}

std::string percent(double share) {
  return share < 0.095 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

std::string share_with_interval(const Share& share) {
  return fmt::format("{} [{}, {}]", percent(share.share), percent(share.low), percent(share.high));
}

std::string spoken(const std::string& factor) {
  if (factor == "mass") return "the mass matrix";
  if (factor == "contact") return "the contact law";
  if (factor == "time") return "the time scheme";
  if (factor == "step") return "the step";
  if (factor == "elements") return "the mesh";
  return factor;
}

std::string source(const Share& share, const std::string& first) {
  if (share.order == 4) return "interactions of more than three choices";
  if (share.order == 0) return "what the choices do not tell apart";
  std::vector<std::string> names = members(share.factor);
  if (names.size() == 1) return spoken(names[0]);
  const bool own = std::erase(names, first) > 0;
  std::string out = own ? "its interaction with " : "the interaction of ";
  for (size_t k = 0; k < names.size(); ++k)
    out += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + spoken(names[k]);
  return out;
}

/// "87 % of the spread of energy end comes from the mass matrix, 9 % from its interaction with the step."
std::string sentence(const Measure& measure) {
  if (!measure.told()) return fmt::format("No shares for {}.", spaced(measure.name));
  const Share& largest = measure.shares.front();
  const std::string first = largest.order == 1 ? largest.factor : "";
  std::string out = fmt::format("{} of the spread of {}{} comes from {}", percent(largest.share), spaced(measure.name),
                                measure.log ? " (on a logarithmic scale)" : "", source(largest, ""));
  for (size_t k = 1; k < std::min<size_t>(measure.shares.size(), 3); ++k)
    if (measure.shares[k].share >= 0.01)
      out += fmt::format(", {} from {}", percent(measure.shares[k].share), source(measure.shares[k], first));
  return out + ".";
}

/// What the shares are not of: cases without the measure, choices that do not vary.
std::string caveats(const CaseView& view, const Measure& measure) {
  std::string out, statuses;
  size_t without = 0;
  for (const char* status : {"refused", "diverged", "failed", "done"}) {
    size_t count = 0;
    for (const CaseRecord* record : view.with_status(status))
      count += !CaseView::measure(*record, measure.name).has_value();
    without += count;
    if (count) statuses += fmt::format("{}{} {}", statuses.empty() ? "" : ", ", count, status);
  }
  const auto single = [&](const Share& share) {
    return share.share == 0 && share.order == 1 && !view.varies(share.factor);
  };
  std::string fixed;
  for (const Share& share : measure.shares)
    if (single(share)) fixed += (fixed.empty() ? "" : ", ") + share.factor;
  if (!measure.told()) out += " Either all its values are the same, or too many cases have none.";
  if (without)
    out += fmt::format(" {} of {} have no value ({}){}.", without,
                       count_text(view.results().cases.size(), "case", "cases"), statuses,
                       measure.told() ? "; what they would be is estimated from the others" : "");
  if (!fixed.empty()) out += fmt::format(" One level only, so no share: {}.", fixed);
  return out;
}

ChartView chart_view(const Measure& measure) {
  const size_t count = std::min(measure.shares.size(), most_bars);
  ChartView out;
  out.x = {"share of the variance", "%"};
  out.y = {measure.log ? "log₁₀ " + spaced(measure.name) : spaced(measure.name), "1"};
  Json names = Json::array();
  for (size_t k = 0; k < count; ++k) names.push_back(measure.shares[k].factor);
  Json y = {
      {"type", "category"},
      {"data", std::move(names)},
      {"inverse", true},
      {"axisTick", {{"show", false}}},
      {"axisLine", {{"show", true}, {"lineStyle", {{"color", "#9a9a9a"}}}}},
      {"axisLabel", {{"color", "#333333"}, {"fontSize", 11}, {"width", 150}, {"overflow", "break"}, {"interval", 0}}}};
  Json x = value_axis(out.x, {0, 100}, false);
  out.option = base_option(std::move(x), std::move(y), false, true);
  out.option["grid"]["left"] = 165;
  for (size_t order : {1, 2, 3, 4, 0}) {
    Json bars = Json::array();
    for (size_t k = 0; k < count; ++k) {
      const Share& share = measure.shares[k];
      if (share.order == order)
        bars.push_back({{"value", {100 * share.share, share.factor}}, {"text", share_with_interval(share)}});
    }
    if (bars.empty()) continue;
    out.option["series"].push_back({{"type", "bar"},
                                    {"name", kinds[order].name},
                                    {"stack", "share"},
                                    {"barWidth", "58%"},
                                    {"color", kinds[order].colour},
                                    {"itemStyle", {{"color", lighten(kinds[order].colour, 0.25)}}},
                                    {"data", std::move(bars)}});
  }
  for (size_t order : {1, 2, 3, 4, 0}) {
    Json ends = Json::array();
    for (size_t k = 0; k < count; ++k) {
      const Share& share = measure.shares[k];
      if (share.order != order) continue;
      for (const double end : {share.low, share.high})
        ends.push_back({{"value", {100 * end, share.factor}}, {"text", share_with_interval(share)}});
      ends.push_back({{"value", {"-", share.factor}}});
    }
    if (ends.empty()) continue;
    out.option["series"].push_back({{"type", "line"},
                                    {"name", kinds[order].name},
                                    {"symbol", "rect"},
                                    {"symbolSize", {1.4, 9}},
                                    {"z", 4},
                                    {"color", "#222222"},
                                    {"lineStyle", {{"color", "#222222"}, {"width", 1.4}}},
                                    {"data", std::move(ends)}});
  }
  if (measure.shares.size() > count) {
    double rest = 0;
    for (size_t k = count; k < measure.shares.size(); ++k) rest += measure.shares[k].share;
    out.notes.push_back(
        fmt::format("Not drawn: {} smaller, together {}.", measure.shares.size() - count, percent(rest)));
  }
  return out;
}

}  // namespace

std::vector<Figure> effects_figures(const CaseView& view) {
  Figure figure{"effects",
                "What each choice is worth",
                "Shares of the variance of a measure over all combinations of the choices: of one choice alone, and of "
                "interactions, where what one does depends on the others. Lines: 95 % of the shares when levels are "
                "given random weights; wide where a share hangs on which levels the study holds.",
                {"share of the variance"},
                {},
                {},
                false};
  std::vector<char> used(std::size(kinds), 0);
  for (const Measure& measure : measures(view.results())) {
    if (!measure.told()) continue;
    Chart chart{spaced(measure.name), {chart_view(measure)}, {sentence(measure)}};
    for (size_t k = 0; k < std::min(measure.shares.size(), most_bars); ++k) used[measure.shares[k].order] = 1;
    figure.charts.push_back(std::move(chart));
  }
  if (figure.charts.empty()) return {};
  for (const size_t order : {1, 2, 3, 4, 0})
    if (used[order]) figure.legend.push_back({kinds[order].name, kinds[order].colour, "", "rect"});
  return {std::move(figure)};
}

std::string effects_html(const CaseView& view) {
  const std::vector<Measure> all = measures(view.results());
  if (all.empty()) return "";
  std::string sentences = "<ul class=\"answer\">\n", rows;
  for (const Measure& measure : all) {
    sentences += fmt::format("<li>{}<span class=\"fine\">{}</span></li>\n", escape(sentence(measure)),
                             escape(caveats(view, measure)));
    for (const Share& share : measure.shares)
      if (share.share >= 1e-3)
        rows += fmt::format(
            "<tr><td>{}</td><td>{}</td><td class=\"number\" title=\"{}\">{}</td><td class=\"number\">{} to "
            "{}</td></tr>\n",
            escape(spaced(measure.name) + (measure.log ? " (log)" : "")), escape(share.factor), exact_text(share.share),
            percent(share.share), percent(share.low), percent(share.high));
  }
  sentences += "</ul>\n";
  if (rows.empty()) return sentences;
  return sentences +
         fmt::format(
             "<details><summary>Shares of 0.1 % and more, with 95 % intervals</summary>\n<table "
             "class=\"plain\"><thead><tr><th scope=\"col\">measure</th><th scope=\"col\">choice</th><th scope=\"col\" "
             "class=\"number\">share</th><th scope=\"col\" class=\"number\">interval</th></tr></thead>\n<tbody>\n{}"
             "</tbody></table></details>\n",
             rows);
}

}  // namespace ricochet::report
