#include "runners/report/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "runners/report/dynamics_report.hpp"
#include "runners/report/evidence.hpp"
#include "runners/report/html.hpp"
#include "runners/report/stability_report.hpp"

namespace ricochet::report {
namespace {

using Getter = std::function<std::optional<double>(const CaseRecord&)>;

Getter measured(std::string name) {
  return [name = std::move(name)](const CaseRecord& record) { return CaseView::measure(record, name); };
}

struct Extremes {
  double low = 0, high = 0;
  const CaseRecord *lowest = nullptr, *highest = nullptr;
  size_t count = 0;
};

Extremes extremes(const Cases& cases, const Getter& of) {
  Extremes out;
  for (const CaseRecord* record : cases) {
    const auto value = of(*record);
    if (!value || !std::isfinite(*value)) continue;
    if (out.count == 0 || *value < out.low) out.low = *value, out.lowest = record;
    if (out.count == 0 || *value > out.high) out.high = *value, out.highest = record;
    ++out.count;
  }
  return out;
}

std::string swatch(const std::string& colour) {
  return fmt::format("<span class=\"swatch\" style=\"background:{}\"></span>", colour);
}

std::string item(const std::string& text) {
  return "<li>" + text + "</li>\n";
}

std::string in_case(const CaseView& view, const CaseRecord& record) {
  const std::string label = view.label(record);
  return label.empty() ? "" : " (" + escape(label) + ")";
}

/// "72.40 %" or "71.20 % to 74.90 %".
std::string range_text(const Extremes& e) {
  const std::string low = percent_text(e.low), high = percent_text(e.high);
  return low == high ? low : low + " to " + high;
}

double gain_share(const CaseRecord& record) {
  const auto gain = CaseView::measure(record, "largest_step_gain"), start = CaseView::measure(record, "energy_start");
  return gain && start && *start > 0 ? *gain / *start : 0;
}

/// What steps gained, over some cases.
std::string gain_sentence(const CaseView& view, const Cases& cases) {
  Cases with, gaining;
  for (const CaseRecord* record : cases) {
    if (!CaseView::measure(*record, "largest_step_gain") || CaseView::measure(*record, "energy_start").value_or(0) <= 0)
      continue;
    with.push_back(record);
    if (gain_share(*record) > step_gain_threshold) gaining.push_back(record);
  }
  if (with.empty()) return "";
  const Extremes e = extremes(with, gain_share);
  if (gaining.empty())
    return fmt::format(" No step gains more than {} of the starting energy (largest: {} of it).",
                       number_text(step_gain_threshold), number_text(e.high, 2));
  return fmt::format(" In {} of {} single steps gain energy, at most {} of the starting energy in one step{}.",
                     gaining.size(), count_text(with.size(), "case", "cases"), share_text(e.high),
                     in_case(view, *e.highest));
}

std::string unfinished_sentence(const Cases& cases) {
  std::string out;
  for (const char* status : {"refused", "diverged", "failed"}) {
    const auto count = static_cast<size_t>(
        std::count_if(cases.begin(), cases.end(), [&](const CaseRecord* r) { return r->status == status; }));
    if (count) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, status);
  }
  return out.empty() ? "" : " Without a result: " + out + ".";
}

std::string with_ratio(const CaseView& view, const CaseRecord& record) {
  const std::string label = view.label(record, view.varying_without({"step"}));
  return fmt::format("<strong>{}</strong>, which ends at {} of its start",
                     label.empty() ? "the only method" : escape(label),
                     percent_text(*CaseView::measure(record, "energy_ratio")));
}

/// "", or how many others end exactly as this one.
std::string ties(const Cases& cases, const CaseRecord& record) {
  const auto same = static_cast<size_t>(std::count_if(cases.begin(), cases.end(), [&](const CaseRecord* other) {
    return CaseView::measure(*other, "energy_ratio") == CaseView::measure(record, "energy_ratio");
  }));
  return same < 2 ? "" : same == 2 ? " (one other ends the same)" : fmt::format(" ({} others end the same)", same - 1);
}

/// What the methods end at with the finest step, and who is farthest apart.
std::string headline(const CaseView& view) {
  Cases done = view.with_status("done");
  std::erase_if(done, [](const CaseRecord* r) { return !CaseView::measure(*r, "energy_ratio"); });
  if (done.empty()) return "";
  double finest = INFINITY;
  for (const CaseRecord* record : done) finest = std::min(finest, CaseView::number(*record, "step").value_or(INFINITY));
  Cases at_finest;
  for (const CaseRecord* record : done)
    if (!view.varies("step") || CaseView::number(*record, "step") == finest) at_finest.push_back(record);
  const bool keeps = conservative(view);
  const Getter change = [](const CaseRecord& r) {
    return std::optional(std::abs(*CaseView::measure(r, "energy_ratio") - 1));
  };
  const Extremes e = extremes(at_finest, keeps ? change : measured("energy_ratio"));
  const std::string step = view.varies("step") ? fmt::format("With the finest step, {} s: ", exact_text(finest)) : "";
  std::string out = "<p class=\"lead\">" + step;
  if (e.low == e.high)
    out += fmt::format("{} at {} of its starting energy.",
                       at_finest.size() == 1 ? "the one finished case ends" : "every case ends",
                       percent_text(*CaseView::measure(*at_finest.front(), "energy_ratio")));
  else if (keeps)
    out += fmt::format("closest to its starting energy is {}{}; farthest is {}{}.", with_ratio(view, *e.lowest),
                       ties(at_finest, *e.lowest), with_ratio(view, *e.highest), ties(at_finest, *e.highest));
  else
    out += fmt::format("the most energy is left by {}{}, the least by {}{}: {} of the larger.",
                       with_ratio(view, *e.highest), ties(at_finest, *e.highest), with_ratio(view, *e.lowest),
                       ties(at_finest, *e.lowest), percent_text(e.low / e.high));
  size_t kept = 0;
  double noise = 0;
  for (const CaseRecord* record : done) {
    noise = std::max(noise, noise_of(*record));
    kept += *change(*record) <= noise_of(*record);
  }
  if (keeps)
    out += fmt::format(" {} of {} over all steps {} where {} began, to within the noise floor.",
                       kept == 0 ? "None" : std::to_string(kept),
                       count_text(done.size(), "finished case", "finished cases"), kept == 1 ? "ends" : "end",
                       kept == 1 ? "it" : "they");
  out += fmt::format(
      "</p>\n<p class=\"fine\">Noise floor of a case: the larger of 2<sup>−52</sup> × its number of steps and the "
      "residual of "
      "its energy balance, relative to its starting energy; at most {} in these cases. Smaller differences are not "
      "told from "
      "round-off.</p>\n",
      number_text(noise, 2));
  return out;
}

/// What other than the method changed the energy, so that the ratio is not taken for what it is not.
std::string work_sentence(const CaseView& view) {
  if (conservative(view)) return "";
  const Cases done = view.with_status("done");
  std::string parts;
  const auto add = [&](const char* what, const char* measure) {
    const Extremes e = extremes(done, measured(measure));
    if (e.count == 0 || (e.low == 0 && e.high == 0)) return;
    parts += fmt::format("{}{} {} to {} J", parts.empty() ? "" : ", ", what, number_text(e.low), number_text(e.high));
  };
  add("damping", "work_of_damping");
  add("loads and support", "work_of_loads");
  if (parts.empty()) return "";
  return "<p>Not only contact changes the energy here. Work over the run, by case: " + parts +
         ". What went at contact is measured apart and said for each mass.</p>\n";
}

/// What contact took, where the ratio alone does not say it.
std::string contact_sentence(const Cases& cases) {
  const Extremes lost = extremes(cases, [](const CaseRecord& record) -> std::optional<double> {
    const auto dissipated = CaseView::measure(record, "dissipated_at_contact"),
               start = CaseView::measure(record, "energy_start");
    return dissipated && start && *start > 0 ? std::optional(*dissipated / *start) : std::nullopt;
  });
  if (lost.count == 0) return "";
  return fmt::format(" Contact took {} to {} of the starting energy.", share_text(lost.low), share_text(lost.high));
}

/// One sentence per mass matrix.
std::string mass_sentences(const CaseView& view) {
  const Getter ratio = measured("energy_ratio");
  const bool keeps = conservative(view);
  std::string out;
  for (const std::string& mass : view.masses()) {
    Cases all, done;
    for (const CaseRecord* record : view.all()) {
      if (view.mass_label(*record) != mass) continue;
      all.push_back(record);
      if (record->status == "done") done.push_back(record);
    }
    std::string text =
        swatch(view.colour(*all.front())) + "<strong>" + escape(mass.empty() ? "all cases" : mass) + "</strong>: ";
    const Extremes over_all = extremes(done, ratio);
    if (over_all.count > 0) {
      text += fmt::format("over {} the energy ends at {} of its start",
                          count_text(over_all.count, "finished case", "finished cases"), range_text(over_all));
      double finest = INFINITY;
      for (const CaseRecord* record : done)
        if (ratio(*record)) finest = std::min(finest, CaseView::number(*record, "step").value_or(INFINITY));
      if (view.varies("step") && std::isfinite(finest)) {
        Cases at_finest;
        for (const CaseRecord* record : done)
          if (CaseView::number(*record, "step") == finest) at_finest.push_back(record);
        text += fmt::format("; at its finest step, {} s, at {}", exact_text(finest),
                            range_text(extremes(at_finest, ratio)));
      }
      text += ".";
    } else {
      const Extremes end = extremes(done, measured("energy_end"));
      if (end.count > 0)
        text += fmt::format("over {} the energy ends between {} and {} J (it starts from 0, so there is no ratio).",
                            count_text(end.count, "finished case", "finished cases"), number_text(end.low),
                            number_text(end.high));
      else
        text += "no finished case.";
    }
    if (!keeps) text += contact_sentence(done);
    text += gain_sentence(view, done) + unfinished_sentence(all);
    out += item(text);
  }
  return out;
}

std::string matrix_cell(const CaseRecord* record, bool conservative_study) {
  if (!record) return "<td class=\"number absent\">not run yet</td>";
  const auto ratio = CaseView::measure(*record, "energy_ratio");
  if (record->status != "done")
    return fmt::format("<td class=\"number status {0}\" title=\"{1}\">{0}</td>", escape(record->status),
                       escape(record->reason));
  if (!ratio) return "<td class=\"number absent\">–</td>";
  const bool kept = conservative_study && std::abs(*ratio - 1) <= noise_of(*record);
  return fmt::format("<td class=\"number{}\" title=\"{}{}\">{}</td>", kept ? " kept" : "", exact_text(*ratio),
                     kept ? ": kept within the noise floor" : "", percent_text(*ratio));
}

/// "; diverged at 1e-6", so that a trend is not read without its missing end.
std::string unfinished_steps(const Cases& cases) {
  std::string out;
  for (const char* status : {"diverged", "failed"}) {
    std::string at;
    for (const CaseRecord* record : cases)
      if (record->status == status)
        at += (at.empty() ? "" : ", ") + exact_text(CaseView::number(*record, "step").value_or(0));
    if (!at.empty()) out += fmt::format("; {} at {}", status, at);
  }
  return out;
}

/// Methods × steps: energy ratio and trend.
std::string matrix(const CaseView& view) {
  const Cases done = view.with_status("done");
  if (extremes(done, measured("energy_ratio")).count == 0) return "";
  const bool keeps = conservative(view);
  std::vector<double> steps;
  for (const CaseRecord* record : view.all())
    if (const auto step = CaseView::number(*record, "step");
        step && std::find(steps.begin(), steps.end(), *step) == steps.end())
      steps.push_back(*step);
  std::sort(steps.rbegin(), steps.rend());
  if (steps.empty()) return "";
  const std::vector<CaseGroup> groups = view.group(view.all(), view.varying_without({"step"}));
  std::string out = fmt::format(
      "<div class=\"scroll{}\"><table class=\"matrix\"><caption>Energy at the end over energy at the start, E(T)/E(0). "
      "Columns: step h (s), coarse to fine. {}</caption>\n<thead><tr><th scope=\"col\">method</th>",
      groups.size() > 24 ? " tall" : "",
      keeps
          ? "Bold: kept within the noise floor. Order: of |E(T)/E(0) − 1| between the two finest steps, where it falls."
          : "Order: of the moves between neighbouring steps, from the three finest, where they shrink.");
  for (const double step : steps) out += "<th scope=\"col\" class=\"number\">" + exact_text(step) + "</th>";
  out +=
      "<th scope=\"col\" class=\"number\">order</th><th scope=\"col\">as the step shrinks</th></tr></thead>\n<tbody>\n";
  for (const CaseGroup& group : groups) {
    std::vector<double> at, ratios;
    double noise = 0;
    out += fmt::format("<tr><th scope=\"row\">{}{}</th>", swatch(view.colour(*group.cases.front())),
                       escape(group.label.empty() ? "all" : group.label));
    for (const double step : steps) {
      const auto found = std::find_if(group.cases.begin(), group.cases.end(),
                                      [&](const CaseRecord* r) { return CaseView::number(*r, "step") == step; });
      const CaseRecord* record = found == group.cases.end() ? nullptr : *found;
      out += matrix_cell(record, keeps);
      const auto ratio = record && record->status == "done" ? CaseView::measure(*record, "energy_ratio") : std::nullopt;
      if (!ratio) continue;
      at.push_back(step);
      ratios.push_back(*ratio);
      noise = std::max(noise, noise_of(*record));
    }
    const Trend trend = step_trend(at, ratios, noise, keeps);
    out += fmt::format("<td class=\"number\">{}</td><td>{}</td></tr>\n",
                       trend.order ? number_text(*trend.order, 2) : "–", trend.words + unfinished_steps(group.cases));
  }
  return out + "</tbody></table></div>\n";
}

/// By how much a quantity moves when one choice alone changes.
struct Effect {
  size_t groups = 0;
  double largest = 0, median = 0;
};

Effect effect_of(const CaseView& view, const Cases& cases, const std::string& choice, const Getter& of) {
  Effect out;
  std::vector<double> spreads;
  for (const CaseGroup& group : view.group(cases, view.varying_without({choice}))) {
    const Extremes e = extremes(group.cases, of);
    if (e.count > 1) spreads.push_back(e.high - e.low);
  }
  if (spreads.empty()) return out;
  std::sort(spreads.begin(), spreads.end());
  out.groups = spreads.size();
  out.largest = spreads.back();
  out.median = spreads[(spreads.size() - 1) / 2];
  return out;
}

std::string effects(const CaseView& view) {
  const Cases done = view.with_status("done");
  std::vector<std::string> choices;
  for (const std::string& column : view.varying())
    for (const std::string& choice : {role_of(column), column})
      if (std::find(choices.begin(), choices.end(), choice) == choices.end()) choices.push_back(choice);
  const bool has_ratio = extremes(done, measured("energy_ratio")).count > 0;
  const Getter energy = measured(has_ratio ? "energy_ratio" : "energy_end"), tip = measured("tip_displacement_end");
  std::string rows;
  for (const std::string& choice : choices) {
    const Effect e = effect_of(view, done, choice, energy), d = effect_of(view, done, choice, tip);
    if (e.groups == 0 && d.groups == 0) continue;
    const auto cells = [](const Effect& effect) {
      if (effect.groups == 0)
        return std::string("<td class=\"number absent\">–</td><td class=\"number absent\">–</td>");
      return fmt::format("<td class=\"number\">{}</td><td class=\"number\">{}</td>", number_text(effect.median, 3),
                         number_text(effect.largest, 3));
    };
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td>{}{}</tr>\n", escape(choice),
                        std::max(e.groups, d.groups), cells(e), cells(d));
  }
  if (rows.empty()) return "";
  return fmt::format(
      "<div class=\"scroll\"><table class=\"matrix\"><caption>What each choice is worth: the spread of a result over "
      "the finished cases that "
      "differ in this choice alone. A method's name stands for the method with its "
      "parameters.</caption>\n<thead><tr><th "
      "scope=\"col\">choice</th><th scope=\"col\" class=\"number\">comparisons</th><th scope=\"col\" "
      "class=\"number\">{0}: median</th><th "
      "scope=\"col\" class=\"number\">{0}: largest</th><th scope=\"col\" class=\"number\">tip at the end (m): "
      "median</th><th scope=\"col\" "
      "class=\"number\">tip at the end (m): largest</th></tr></thead>\n<tbody>\n{1}</tbody></table></div>\n",
      has_ratio ? "E(T)/E(0)" : "E(T) (J)", rows);
}

}  // namespace

bool conservative(const CaseView& view) {
  for (const CaseRecord* record : view.with_status("done"))
    for (const char* work : {"work_of_damping", "work_of_loads"})
      // A scheme that declares no work form leaves it open.
      if (const auto value = CaseView::measure(*record, work); !value || *value != 0) return false;
  return true;
}

std::string answer_html(const CaseView& view) {
  const Cases done = view.with_status("done");
  if (view.results().cases.empty()) return "<p>No case has run yet.</p>\n";
  if (const std::string dynamics = dynamics_answer_html(view) + basins_html(view); !dynamics.empty()) return dynamics;
  if (done.empty()) return "<p>No case has finished with a result; the table below says why.</p>\n";
  const StudyResults& results = view.results();
  if (results.kind != "trajectory") return stability_html(view) + work_precision_html(view) + orders_html(view);
  const bool energies = extremes(done, measured("energy_end")).count > 0;
  if (!energies) return "<p>These cases have no energy measures; their figures are in the table below.</p>\n";
  return headline(view) + "<ul class=\"answer\">\n" + mass_sentences(view) + "</ul>\n" + work_sentence(view) +
         matrix(view) + effects(view);
}

}  // namespace ricochet::report
