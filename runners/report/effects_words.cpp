#include "runners/report/effects_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/report/axis_rows.hpp"
#include "runners/report/html.hpp"

namespace ricochet::report {
namespace {

std::vector<std::string> choices_in(const std::string& factor) {
  static const std::string times = " × ";
  std::vector<std::string> out;
  size_t from = 0;
  for (size_t at; (at = factor.find(times, from)) != std::string::npos; from = at + times.size())
    out.push_back(factor.substr(from, at - from));
  out.push_back(factor.substr(from));
  return out;
}

std::string spoken(const std::string& factor) {
  if (factor == "mass") return "the mass matrix";
  if (factor == "contact") return "the contact law";
  if (factor == "time") return "the time scheme";
  if (factor == "step") return "the step";
  if (factor == "elements") return "the mesh";
  return factor;
}

std::string source_of_spread(const MeasureShare& share, const std::string& first) {
  if (share.order == 4) return "interactions of more than three choices";
  if (share.order == 0) return "what the choices do not tell apart";
  std::vector<std::string> names = choices_in(share.factor);
  if (names.size() == 1) return spoken(names[0]);
  const bool own = std::erase(names, first) > 0;
  std::string out = own ? "its interaction with " : "the interaction of ";
  for (size_t k = 0; k < names.size(); ++k)
    out += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + spoken(names[k]);
  return out;
}

}  // namespace

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string effects_percent(double share) {
  return share < 0.095 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

std::vector<MeasureShares> measure_shares(const StudyResults& results) {
  const AxisRows rows(results, "effects");
  std::vector<MeasureShares> out;
  for (size_t row = 0; row < rows.size(); ++row) {
    const std::string name = rows.text(row, "measure");
    if (out.empty() || out.back().name != name) out.push_back({name, rows.flag(row, "log"), {}});
    MeasureShare share{rows.text(row, "factor"), rows.number(row, "share").value_or(0), 0, 0, 1};
    share.low = rows.number(row, "low").value_or(share.share);
    share.high = rows.number(row, "high").value_or(share.share);
    share.order = share.factor == "higher" ? 4 : share.factor == "repeats" ? 0 : choices_in(share.factor).size();
    out.back().shares.push_back(std::move(share));
  }
  for (MeasureShares& measure : out)
    std::stable_sort(measure.shares.begin(), measure.shares.end(),
                     [](const MeasureShare& a, const MeasureShare& b) { return a.share > b.share; });
  return out;
}

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

std::string effects_caveats(const CaseView& view, const MeasureShares& measure) {
  std::string out, statuses;
  size_t without = 0;
  for (const char* status : {"refused", "diverged", "failed", "done"}) {
    size_t count = 0;
    for (const CaseRecord* record : view.with_status(status))
      count += !CaseView::measure(*record, measure.name).has_value();
    without += count;
    if (count) statuses += fmt::format("{}{} {}", statuses.empty() ? "" : ", ", count, status);
  }
  const auto single = [&](const MeasureShare& share) {
    return share.share == 0 && share.order == 1 && !view.varies(share.factor);
  };
  std::string fixed;
  for (const MeasureShare& share : measure.shares)
    if (single(share)) fixed += (fixed.empty() ? "" : ", ") + share.factor;
  if (!measure.told()) out += " Either all its values are the same, or too many cases have none.";
  if (without)
    out += fmt::format(" {} of {} have no value ({}){}.", without,
                       count_text(view.results().cases.size(), "case", "cases"), statuses,
                       measure.told() ? "; what they would be is estimated from the others" : "");
  if (!fixed.empty()) out += fmt::format(" One level only, so no share: {}.", fixed);
  return out;
}

}  // namespace ricochet::report
