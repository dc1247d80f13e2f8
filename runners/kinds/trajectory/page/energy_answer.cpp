#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/kinds/trajectory/page/page.hpp"
#include "runners/report/html.hpp"

namespace ricochet::report {
namespace {

/// A table that was derived of the cases; null where it has no rows.
const Table* derived(const CaseView& view, std::string_view name) {
  const Table* table = find_table(view.results().derived, name);
  return table && !table->rows.empty() ? table : nullptr;
}

std::string item(const std::string& text) {
  return "<li>" + text + "</li>\n";
}

/// "72.40 %" or "71.20 % to 74.90 %".
std::string range_text(double low, double high) {
  const std::string from = percent_text(low), to = percent_text(high);
  return from == to ? from : from + " to " + to;
}

/// One finished case with an energy ratio, as `energy_ends` has it.
struct EnergyEnd {
  const CaseRecord* record = nullptr;
  double ratio = 0, change = 0, noise = 0, step = 0;
  bool kept = false;
};

std::vector<EnergyEnd> energy_ends(const CaseView& view) {
  std::vector<EnergyEnd> out;
  const Table* table = derived(view, "energy_ends");
  if (!table) return out;
  const TableReader rows(*table);
  const size_t id = rows.column("case"), ratio = rows.column("ratio"), change = rows.column("change"),
               noise = rows.column("noise_floor"), kept = rows.column("kept");
  std::map<std::string, const CaseRecord*> by_id;
  for (const CaseRecord& record : view.results().cases) by_id[record.id] = &record;
  for (size_t row = 0; row < rows.size(); ++row) {
    const auto found = by_id.find(rows.text(row, id));
    if (found == by_id.end() || !rows.number(row, ratio)) continue;
    out.push_back({found->second, *rows.number(row, ratio), rows.number(row, change).value_or(0),
                   rows.number(row, noise).value_or(0), CaseView::number(*found->second, "step").value_or(INFINITY),
                   rows.truth(row, kept) == true});
  }
  return out;
}

std::string with_ratio(const CaseView& view, const EnergyEnd& end) {
  const std::string label = view.label(*end.record, view.varying_without({"step"}));
  return fmt::format("<strong>{}</strong>, which keeps {} of the energy brought in",
                     label.empty() ? "the only method" : escape(label), percent_text(end.ratio));
}

/// "", or how many others end exactly as this one.
std::string ties(const std::vector<EnergyEnd>& ends, const EnergyEnd& end) {
  const auto same = static_cast<size_t>(
      std::count_if(ends.begin(), ends.end(), [&](const EnergyEnd& other) { return other.ratio == end.ratio; }));
  return same < 2 ? "" : same == 2 ? " (one other ends the same)" : fmt::format(" ({} others end the same)", same - 1);
}

/// What the methods end at with the finest step, and who is farthest apart.
std::string headline(const CaseView& view) {
  const std::vector<EnergyEnd> ends = energy_ends(view);
  if (ends.empty()) return "";
  double finest = INFINITY, noise = 0;
  size_t kept = 0;
  for (const EnergyEnd& end : ends) {
    finest = std::min(finest, end.step);
    noise = std::max(noise, end.noise);
    kept += end.kept;
  }
  std::vector<EnergyEnd> at_finest;
  for (const EnergyEnd& end : ends)
    if (!view.varies("step") || end.step == finest) at_finest.push_back(end);
  const bool keeps = conservative(view);
  const auto [least, most] = std::minmax_element(
      at_finest.begin(), at_finest.end(),
      [&](const EnergyEnd& a, const EnergyEnd& b) { return keeps ? a.change < b.change : a.ratio < b.ratio; });
  // Of several that end the same the first is named.
  const EnergyEnd& low = *least;
  const EnergyEnd& high = *std::find_if(at_finest.begin(), at_finest.end(), [&, most = most](const EnergyEnd& end) {
    return keeps ? end.change == most->change : end.ratio == most->ratio;
  });
  const std::string step = view.varies("step") ? fmt::format("With the finest step, {} s: ", exact_text(finest)) : "";
  std::string out = "<p class=\"lead\">" + step;
  if (keeps ? low.change == high.change : low.ratio == high.ratio)
    out += fmt::format("{} with {} of the energy brought in.",
                       at_finest.size() == 1 ? "the one finished case ends" : "every case ends",
                       percent_text(at_finest.front().ratio));
  else if (keeps)
    out += fmt::format("closest to its start is {}{}; farthest is {}{}.", with_ratio(view, low), ties(at_finest, low),
                       with_ratio(view, high), ties(at_finest, high));
  else
    out += fmt::format("the most energy is left by {}{}, the least by {}{}: {} of the larger.", with_ratio(view, high),
                       ties(at_finest, high), with_ratio(view, low), ties(at_finest, low),
                       percent_text(low.ratio / high.ratio));
  if (keeps)
    out += fmt::format(" {} of {} over all steps {} where {} began, to within the noise floor.",
                       kept == 0 ? "None" : std::to_string(kept),
                       count_text(ends.size(), "finished case", "finished cases"), kept == 1 ? "ends" : "end",
                       kept == 1 ? "it" : "they");
  out += fmt::format(
      "</p>\n<p class=\"fine\">Noise floor of a case: the larger of 2<sup>−52</sup> × its number of steps and the "
      "residual of "
      "its energy balance, where that is exact, over the energy brought in; at most {} in these cases. Smaller "
      "differences are not "
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
    std::vector<double> works;
    for (const CaseRecord* record : done)
      if (const auto work = ricochet::measure(*record, measure)) works.push_back(*work);
    if (works.empty()) return;
    const auto [low, high] = std::minmax_element(works.begin(), works.end());
    if (*low == 0 && *high == 0) return;
    parts += fmt::format("{}{} {} to {} J", parts.empty() ? "" : ", ", what, number_text(*low), number_text(*high));
  };
  add("damping", "work_of_damping");
  add("loads and support", "work_of_loads");
  if (parts.empty()) return "";
  return "<p>Not only contact changes the energy here. Work over the run, by case: " + parts +
         ". What went at contact is measured apart and said for each mass.</p>\n";
}

/// One row of `energy_by_mass`, as sentences.
class MassRow {
 public:
  MassRow(const CaseView& view, const TableReader& rows, size_t row) : view_(view), rows_(rows), row_(row) {}

  std::string sentences() const {
    const CaseRecord* record = view_.find(rows_.text(row_, "case"));
    if (!record) return "";
    const std::string mass = view_.mass_label(*record);
    std::string text =
        swatch(view_.colour(*record)) + "<strong>" + escape(mass.empty() ? "all cases" : mass) + "</strong>: " + ends();
    if (!conservative(view_)) text += contact();
    return text + gains() + unfinished();
  }

 private:
  std::optional<double> number(const char* column) const { return rows_.number(row_, column); }
  size_t count(const char* column) const { return static_cast<size_t>(number(column).value_or(0)); }

  std::string ends() const {
    if (count("finished") > 0) {
      std::string text = fmt::format("over {} the energy ends at {} of what was brought in",
                                     count_text(count("finished"), "finished case", "finished cases"),
                                     range_text(number("ratio_low").value_or(0), number("ratio_high").value_or(0)));
      if (const auto finest = number("finest_step"))
        text += fmt::format("; at its finest step, {} s, at {}", exact_text(*finest),
                            range_text(number("finest_low").value_or(0), number("finest_high").value_or(0)));
      return text + ".";
    }
    if (count("ended") == 0) return "no finished case.";
    return fmt::format("over {} the energy ends between {} and {} J (nothing was brought in, so there is no ratio).",
                       count_text(count("ended"), "finished case", "finished cases"),
                       number_text(number("end_low").value_or(0)), number_text(number("end_high").value_or(0)));
  }

  /// What contact took, where the ratio alone does not say it.
  std::string contact() const {
    const auto low = number("contact_low"), high = number("contact_high");
    if (!low || !high) return "";
    return fmt::format(" Contact took {} to {} of the energy brought in.", share_text(*low), share_text(*high));
  }

  std::string gains() const {
    if (count("audited") == 0) return "";
    const double largest = number("largest_gain").value_or(0);
    if (count("gaining") == 0)
      return fmt::format(" No step gains more than 1e-9 of the energy brought in (largest: {} of it).",
                         number_text(largest, 2));
    const CaseRecord* record = view_.find(rows_.text(row_, "largest_gain_case"));
    const std::string label = record ? view_.label(*record) : "";
    return fmt::format(" In {} of {} single steps gain energy, at most {} of the energy brought in in one step{}.",
                       count("gaining"), count_text(count("audited"), "case", "cases"), share_text(largest),
                       label.empty() ? "" : " (" + escape(label) + ")");
  }

  std::string unfinished() const {
    std::string out;
    for (const char* status : {"refused", "diverged", "failed"})
      if (count(status) > 0) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count(status), status);
    return out.empty() ? "" : " Without a result: " + out + ".";
  }

  const CaseView& view_;
  const TableReader& rows_;
  size_t row_;
};

/// One sentence per mass matrix.
std::string mass_sentences(const CaseView& view) {
  const Table* table = derived(view, "energy_by_mass");
  if (!table) return "";
  const TableReader rows(*table);
  std::string out;
  for (size_t row = 0; row < rows.size(); ++row) out += item(MassRow(view, rows, row).sentences());
  return out;
}

void ratio_cell(HtmlTable& table, const CaseRecord* record, const EnergyEnd* end, bool conservative_study) {
  const bool kept = end && conservative_study && end->kept;
  if (!record)
    table.absent(true, "not run yet");
  else if (record->status != "done")
    table.number(record->status, record->reason, "status " + record->status);
  else if (!end)
    table.absent();
  else
    table.number(percent_text(end->ratio), exact_text(end->ratio) + (kept ? ": kept within the noise floor" : ""),
                 kept ? "kept" : "");
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
  const std::vector<EnergyEnd> ends = energy_ends(view);
  const Table* found = derived(view, "energy_trends");
  if (ends.empty() || !found) return "";
  std::map<const CaseRecord*, const EnergyEnd*> end_of;
  for (const EnergyEnd& end : ends) end_of[end.record] = &end;
  const TableReader trends(*found);
  std::map<std::string, size_t> trend_of;  // by the case that stands for the method
  for (size_t row = 0; row < trends.size(); ++row) trend_of[trends.text(row, "case")] = row;
  const bool keeps = conservative(view);
  std::vector<double> steps;
  for (const CaseRecord* record : view.all())
    if (const auto step = CaseView::number(*record, "step");
        step && std::find(steps.begin(), steps.end(), *step) == steps.end())
      steps.push_back(*step);
  std::sort(steps.rbegin(), steps.rend());
  if (steps.empty()) return "";
  const std::vector<CaseGroup> groups = view.group(view.all(), view.varying_without({"step"}));
  HtmlTable table(
      fmt::format("Energy at the end over the energy brought in: that of the start, and what loads brought in. "
                  "Columns: step h (s), coarse to fine. {}",
                  keeps ? "Bold: kept within the noise floor. Order: of |ratio − 1| between the two finest steps, "
                          "where it falls."
                        : "Order: of the moves between neighbouring steps, from the three finest, where they shrink."),
      {{"method"}});
  for (const double step : steps) table.add({exact_text(step), true});
  table.add({"order", true});
  table.add({"as the step shrinks"});
  for (const CaseGroup& group : groups) {
    table.row(group.label.empty() ? "all" : group.label, view.colour(*group.cases.front()));
    for (const double step : steps) {
      const auto at = std::find_if(group.cases.begin(), group.cases.end(),
                                   [&](const CaseRecord* r) { return CaseView::number(*r, "step") == step; });
      const CaseRecord* record = at == group.cases.end() ? nullptr : *at;
      const auto end = end_of.find(record);
      ratio_cell(table, record, end == end_of.end() ? nullptr : end->second, keeps);
    }
    std::string order = "–", words = "no finished case";
    for (const CaseRecord* record : group.cases)
      if (const auto trend = trend_of.find(record->id); trend != trend_of.end()) {
        words = trend_sentence(trends, trend->second);
        if (const auto fitted = trends.number(trend->second, "order")) order = number_text(*fitted, 2);
      }
    table.number(order).text(words + unfinished_steps(group.cases));
  }
  return table.html();
}

/// What each choice is worth: its rows of `choice_worth`, one for the energy and one for the tip, side by side.
std::string choice_worth(const CaseView& view) {
  const Table* found = derived(view, "choice_worth");
  if (!found) return "";
  const TableReader worth(*found);
  std::vector<std::string> choices;
  std::map<std::string, size_t> energy, tip;  // rows
  bool ratios = false;
  for (size_t row = 0; row < worth.size(); ++row) {
    const std::string choice = worth.text(row, "choice"), measure = worth.text(row, "measure");
    if (choices.empty() || choices.back() != choice) choices.push_back(choice);
    (measure == "tip_displacement_end" ? tip : energy)[choice] = row;
    ratios = ratios || measure == "energy_left";
  }
  const std::string what = ratios ? "energy left" : "E(T) (J)";
  HtmlTable table(
      "What each choice is worth: the spread of a result over the finished cases that differ in this choice alone. A "
      "method's name stands for the method with its parameters.",
      {{"choice"},
       {"comparisons", true},
       {what + ": median", true},
       {what + ": largest", true},
       {"tip at the end (m): median", true},
       {"tip at the end (m): largest", true}});
  for (const std::string& choice : choices) {
    double comparisons = 0;
    for (const auto* rows : {&energy, &tip})
      if (const auto row = rows->find(choice); row != rows->end())
        comparisons = std::max(comparisons, worth.number(row->second, "comparisons").value_or(0));
    table.row(choice).number(fmt::format("{}", comparisons));
    for (const auto* rows : {&energy, &tip})
      for (const char* spread : {"median", "largest"}) {
        const auto row = rows->find(choice);
        if (row == rows->end())
          table.absent();
        else
          table.number(number_text(worth.number(row->second, spread).value_or(0), 3));
      }
  }
  return table.html();
}

}  // namespace

bool conservative(const CaseView& view) {
  const Table* ends = derived(view, "energy_ends");
  return ends && TableReader(*ends).truth(0, "conservative") == true;
}

std::string energy_answer(const CaseView& view) {
  if (view.with_status("done").empty()) return "";
  if (!derived(view, "energy_ends"))
    return "<p>These cases have no energy measures; their figures are in the table below.</p>\n";
  return matrix(view) + "<details><summary>Energies of each mass matrix, and what each choice is worth</summary>\n" +
         headline(view) + "<ul class=\"answer\">\n" + mass_sentences(view) + "</ul>\n" + work_sentence(view) +
         choice_worth(view) + "</details>\n";
}

}  // namespace ricochet::report
