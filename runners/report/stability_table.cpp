#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"
#include "runners/report/stability_report.hpp"
#include "runners/report/stability_rows.hpp"

namespace ricochet::report {
namespace {

std::string limit_text(const StabilityRange& range, const std::optional<double>& limit, bool observed) {
  if (limit) return number_text(*limit, 5);
  const bool any = std::any_of(range.cells.begin(), range.cells.end(), [&](const StabilityCell& cell) {
    return observed ? !cell.behaviour.empty() : cell.radius.has_value();
  });
  const bool bad = std::any_of(range.cells.begin(), range.cells.end(), [&](const StabilityCell& cell) {
    return observed ? cell.observed_unstable() : cell.predicted_unstable();
  });
  return !any ? "–" : bad ? "below the range" : "none";
}

/// What grows at the smallest unstable step, or why there is no prediction; what was seen there is left to the map.
std::string why(const StabilityRange& range) {
  for (const StabilityCell& cell : range.cells)
    if (cell.status == "unstable" || cell.status == "failed" || cell.status == "refused") {
      const std::string first = cell.reason.substr(0, cell.reason.find("; "));
      return cell.status == "refused" ? first : fmt::format("h = {} s: {}", number_text(cell.step, 3), first);
    }
  return "";
}

std::string marginal(const StabilityRange& range) {
  std::vector<std::string> said;
  for (const StabilityCell& cell : range.cells)
    if (!cell.marginal.empty() && std::find(said.begin(), said.end(), cell.marginal) == said.end())
      said.push_back(cell.marginal);
  if (said.size() > 2) {
    const size_t more = said.size() - 2;
    said.resize(2);
    said.push_back(fmt::format("and {} more", more));
  }
  return fmt::format("{}", fmt::join(said, "; "));
}

}  // namespace

std::string stability_html(const CaseView& view) {
  std::string rows;
  size_t ranges = 0, both = 0, agreeing = 0, apart = 0;
  for (const bool closed : {false, true})
    for (const CaseRecord* record : stability_cases(view, closed)) {
      const StabilityRange range = *stability_range(*record, closed);
      ++ranges;
      std::vector<std::string> columns = closed ? view.varying() : view.varying_without({"contact"});
      const std::string label = view.label(*record, columns);
      std::string ratio = "–";
      if (range.expected && range.observed) {
        ++both;
        agreeing += std::abs(*range.observed / *range.expected - 1) <= 0.02;
        ratio = number_text(*range.observed / *range.expected, 4);
      }
      apart += !disagreements(range).empty();
      std::string limits = marginal(range);
      if (const std::string grows = why(range); !grows.empty()) limits += (limits.empty() ? "" : "; ") + grows;
      rows += fmt::format(
          "<tr><th scope=\"row\"><span class=\"swatch\" style=\"background:{}\"></span>{}</th><td>{}</td><td "
          "class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td "
          "class=\"reason\">{}</td></tr>\n",
          view.colour(*record), escape(label.empty() ? "the one method" : label), closed ? "closed" : "open",
          limit_text(range, range.predicted, false), limit_text(range, range.observed, true), ratio, escape(limits));
    }
  if (ranges == 0) return "";
  std::string lead = fmt::format("{} of steps.", count_text(ranges, "range", "ranges"));
  if (both > 0)
    lead += fmt::format(" Where a limit is both predicted and observed, {} of {} agree to 2 %.", agreeing, both);
  if (apart > 0)
    lead += fmt::format(
        " In {} the marches and the spectra disagree at some step: contacts that open and close make "
        "energy that no spectrum of a fixed contact set shows, and growth may need longer than the "
        "horizon.",
        count_text(apart, "range", "ranges"));
  return fmt::format(
      "<p class=\"lead\">{}</p>\n<div class=\"scroll{}\"><table class=\"matrix\"><caption>Step limits in seconds. "
      "Open: "
      "the structure alone. Closed: predicted with points held on both sides, the worst of several sets; observed in "
      "the scene itself, which is open as well: the ratio is to the smaller of both "
      "predictions.</caption>\n<thead><tr><th scope=\"col\">method</th><th scope=\"col\">contact</th><th "
      "scope=\"col\" class=\"number\">predicted limit</th><th scope=\"col\" class=\"number\">observed limit</th><th "
      "scope=\"col\" class=\"number\">observed / predicted</th><th scope=\"col\">marginal roots, and what "
      "grows at the first step that is not stable</th></tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
      lead, ranges > 24 ? " tall" : "", rows);
}

}  // namespace ricochet::report
