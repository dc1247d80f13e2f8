#include "runners/kinds/trajectory/energy_tables.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "runners/kinds/trajectory/energy_trend.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet {
namespace {

using Measured = std::function<std::optional<double>(const CaseRecord&)>;

Measured measured(std::string name) {
  return [name = std::move(name)](const CaseRecord& record) { return measure(record, name); };
}

/// Smallest and largest of what some cases have.
struct Extent {
  std::optional<double> low, high;
  const CaseRecord* highest = nullptr;
  std::size_t count = 0;
};

Extent extent_of(const Cases& cases, const Measured& of) {
  Extent out;
  for (const CaseRecord* record : cases) {
    const auto value = of(*record);
    if (!value || !std::isfinite(*value)) continue;
    if (!out.low || *value < *out.low) out.low = *value;
    if (!out.high || *value > *out.high) {
      out.high = *value;
      out.highest = record;
    }
    ++out.count;
  }
  return out;
}

/// A measure over the energy that was brought in; nothing where that is not positive.
std::optional<double> of_brought_in(const CaseRecord& record, const char* name) {
  const auto value = measure(record, name), all = measure(record, "energy_brought_in");
  return value && all && *all > 0 ? std::optional(*value / *all) : std::nullopt;
}

Cases done_cases(const StudyResults& results) {
  return with_status(all_cases(results), "done");
}

double step_of(const CaseRecord& record) {
  return axis(record, "step").number().value_or(std::numeric_limits<double>::infinity());
}

/// The case with the smallest step; the first of several.
const CaseRecord* finest_of(const Cases& cases) {
  const auto finest = std::min_element(
      cases.begin(), cases.end(), [](const CaseRecord* a, const CaseRecord* b) { return step_of(*a) < step_of(*b); });
  return finest == cases.end() ? nullptr : *finest;
}

Cases with_ratio(const Cases& cases) {
  Cases done = with_status(cases, "done");
  std::erase_if(done, [](const CaseRecord* record) { return !measure(*record, "energy_left"); });
  return done;
}

bool varies(const StudyResults& results, const std::string& column) {
  return std::any_of(results.cases.begin(), results.cases.end(), [&](const CaseRecord& record) {
    return !(axis(record, column) == axis(results.cases.front(), column));
  });
}

/// A row that begins with the case that stands for a group, and the axes that the group shares.
Table table_of_groups(const StudyResults& results, const char* name, const char* text,
                      const std::vector<std::string>& shared, const std::vector<Column>& columns) {
  Table table{name, text, {{"case", "", "The case that stands for the row: the finest step, finished if any is."}}, {}};
  table.columns = joined(joined(std::move(table.columns), axis_columns(results, shared)), columns);
  return table;
}

Row group_place(const Cases& group, const std::vector<std::string>& shared) {
  const Cases finished = with_ratio(group);
  Row row = place_of(*group.front(), shared);
  row.front() = finest_of(finished.empty() ? group : finished)->id;
  return row;
}

}  // namespace

double energy_noise(const CaseRecord& record) {
  const double round_off = 0x1p-52 * static_cast<double>(record.steps);
  const auto residual = of_brought_in(record, "balance_residual");
  return residual && std::abs(*residual) <= exact_balance ? std::max(round_off, std::abs(*residual)) : round_off;
}

bool energy_is_kept(const StudyResults& results) {
  // A scheme that declares no work form leaves it open: those that do tell it for the scene that they share.
  std::vector<std::string> scene;
  for (const std::string& column : results.columns)
    if (const std::string role = axis_role(column);
        role != "mass" && role != "contact" && role != "time" && role != "step" && role != "elements")
      scene.push_back(column);
  for (const Cases& cases : groups_of(done_cases(results), scene)) {
    bool told = false;
    for (const CaseRecord* record : cases)
      for (const char* work : {"work_of_damping", "work_of_loads"})
        if (const auto value = measure(*record, work)) {
          if (*value != 0) return false;
          told = true;
        }
    if (!told) return false;
  }
  return true;
}

Table energy_ends_table(const StudyResults& results) {
  Table table = table_of_cases(
      results, "energy_ends", "One finished case: what its energy ends at, and what is told from round-off.",
      {{"energy", "J", "The common mechanical energy at the end."},
       {"ratio", "1",
        "The same over the energy brought in: that of the start, and what loads brought in beyond what they took."},
       {"change", "1", "Distance of that ratio from 1."},
       {"noise_floor", "1",
        "What of the change is not told from round-off: 2⁻⁵² times the number of steps, or the residual of the energy "
        "balance over the energy brought in where the balance is exact, whichever is larger."},
       {"kept", "", "Whether the change is within the noise floor."},
       {"step_gain", "1", "Largest gain of one step over the energy brought in."},
       {"gains", "", "Whether that is more than 1e-9 of it."},
       {"lost_at_contact", "1", "What the contact efforts took out, over the energy brought in."},
       {"conservative", "", "Whether nothing but contact changes the energy of the study's finished cases."}});
  const bool conservative = energy_is_kept(results);
  for (const CaseRecord* record : done_cases(results)) {
    const auto end = measure(*record, "energy_end"), ratio = measure(*record, "energy_left");
    if (!end && !ratio) continue;
    const auto gain = of_brought_in(*record, "largest_step_gain");
    const double noise = energy_noise(*record);
    add_row(
        table, place_of(results, *record),
        {end, ratio, ratio ? Cell(std::abs(*ratio - 1)) : Cell(), noise,
         ratio ? Cell(std::abs(*ratio - 1) <= noise) : Cell(), gain, gain ? Cell(*gain > step_gain_threshold) : Cell(),
         of_brought_in(*record, "dissipated_at_contact"), conservative});
  }
  return table;
}

Table energy_by_mass_table(const StudyResults& results) {
  std::vector<std::string> shared;
  for (const std::string& column : results.columns)
    if (axis_role(column) == "mass") shared.push_back(column);
  Table table =
      table_of_groups(results, "energy_by_mass", "One mass matrix, over everything else that varies.", shared,
                      {{"cases", "1", "Cases with this mass."},
                       {"refused", "1", "Cases to which it does not apply."},
                       {"diverged", "1", "Cases that diverged."},
                       {"failed", "1", "Cases that failed."},
                       {"finished", "1", "Finished cases with an energy ratio."},
                       {"ratio_low", "1", "Smallest energy at the end over that brought in."},
                       {"ratio_high", "1", "Largest such ratio."},
                       {"finest_step", "s", "Smallest step of these cases; empty where the step does not vary."},
                       {"finest_low", "1", "Smallest ratio at that step."},
                       {"finest_high", "1", "Largest ratio at that step."},
                       {"ended", "1", "Finished cases with an energy at the end."},
                       {"end_low", "J", "Smallest energy at the end."},
                       {"end_high", "J", "Largest energy at the end."},
                       {"contact_low", "1", "Least that the contact efforts took out, over the energy brought in."},
                       {"contact_high", "1", "Most that they took out."},
                       {"audited", "1", "Finished cases whose steps are told to gain energy or not."},
                       {"gaining", "1", "Those in which single steps gain more than 1e-9 of the energy brought in."},
                       {"largest_gain", "1", "Largest gain of one step over the energy brought in."},
                       {"largest_gain_case", "", "The case that makes it."}});
  const Measured ratio = measured("energy_left");
  for (const Cases& all : groups_of(all_cases(results), shared)) {
    const Cases done = with_status(all, "done"), finished = with_ratio(done);
    Cases at_finest;
    std::optional<double> finest;
    if (!finished.empty() && varies(results, "step") && std::isfinite(step_of(*finest_of(finished)))) {
      finest = step_of(*finest_of(finished));
      for (const CaseRecord* record : done)
        if (step_of(*record) == *finest) at_finest.push_back(record);
    }
    const Extent ratios = extent_of(done, ratio), fine = extent_of(at_finest, ratio),
                 ends = extent_of(done, measured("energy_end")),
                 contact =
                     extent_of(done, [](const CaseRecord&r) { return of_brought_in(r, "dissipated_at_contact"); }),
                 gains = extent_of(done, [](const CaseRecord&r) { return of_brought_in(r, "largest_step_gain"); });
    const auto gaining = std::count_if(done.begin(), done.end(), [](const CaseRecord* record) {
      return of_brought_in(*record, "largest_step_gain").value_or(0) > step_gain_threshold;
    });
    add_row(table, group_place(all, shared),
            {all.size(), with_status(all, "refused").size(), with_status(all, "diverged").size(),
             with_status(all, "failed").size(), ratios.count, ratios.low, ratios.high, finest, fine.low, fine.high,
             ends.count, ends.low, ends.high, contact.low, contact.high, gains.count, gaining, gains.high,
             gains.highest ? gains.highest->id : std::string()});
  }
  return table;
}

Table energy_trends_table(const StudyResults& results) {
  std::vector<std::string> shared = results.columns;
  std::erase(shared, "step");
  Table table = table_of_groups(
      results, "energy_trends", "One method: how its energy behaves as the step shrinks.", shared,
      {{"steps", "1", "Steps that finished."},
       {"finest_step", "s", "The smallest of them."},
       {"ratio", "1", "Energy at the end over that brought in, at the finest step."},
       {"noise_floor", "1", "The largest noise floor of these cases; see energy_ends.csv."},
       {"first_change", "1",
        "Distance of the ratio from 1 at the coarsest step; empty where energy is not to be kept."},
       {"last_change", "1", "The same at the finest step."},
       {"smallest_change", "1", "The smallest over the steps."},
       {"largest_change", "1", "The largest over the steps."},
       {"last_move", "1", "By how much the ratios of the two finest steps differ."},
       {"order", "1",
        "Order in the step of the change between the two finest steps, where it falls; where energy is not to be kept, "
        "of the moves between the three finest."},
       {"trend", "", "What the change does as the step shrinks, in a few words."}});
  const bool conservative = energy_is_kept(results);
  for (const Cases& group : groups_of(all_cases(results), shared)) {
    std::map<double, const CaseRecord*, std::greater<>> by_step;  // coarse to fine, the first of several
    for (const CaseRecord* record : group)
      if (std::isfinite(step_of(*record))) by_step.emplace(step_of(*record), record);
    std::vector<double> steps, ratios;
    double noise = 0;
    for (const auto& [step, record] : by_step) {
      const auto ratio = record->status == "done" ? measure(*record, "energy_left") : std::nullopt;
      if (!ratio) continue;
      steps.push_back(step);
      ratios.push_back(*ratio);
      noise = std::max(noise, energy_noise(*record));
    }
    const EnergyTrend trend = energy_trend(steps, ratios, noise, conservative);
    add_row(table, group_place(group, shared),
            {steps.size(), steps.empty() ? Cell() : Cell(steps.back()), trend.ratio,
             steps.empty() ? Cell() : Cell(noise), trend.first_change, trend.last_change, trend.smallest_change,
             trend.largest_change, trend.last_move, trend.order, trend_word(trend.trend)});
  }
  return table;
}

Table choice_worth_table(const StudyResults& results) {
  Table table{"choice_worth",
              "Over all cases: what one choice is worth for one measure, the spread of the measure over the finished "
              "cases that differ in this choice alone.",
              {{"choice", "", "The axis; the name of a role stands for the method with its parameters."},
               {"measure", "", "The measure, a column of cases.csv."},
               {"comparisons", "1", "Groups of two or more finished cases that differ in the choice alone."},
               {"median", "that of the measure", "Median spread over the groups, the lower one of two."},
               {"largest", "that of the measure", "Largest spread."}},
              {}};
  const Cases done = done_cases(results);
  std::vector<std::string> choices;
  for (const std::string& column : results.columns)
    if (varies(results, column))
      for (const std::string& choice : {axis_role(column), column})
        if (std::find(choices.begin(), choices.end(), choice) == choices.end()) choices.push_back(choice);
  const bool ratios = extent_of(done, measured("energy_left")).count > 0;
  for (const std::string& choice : choices) {
    std::vector<std::string> others;
    for (const std::string& column : results.columns)
      if (column != choice && axis_role(column) != choice) others.push_back(column);
    const std::vector<Cases> groups = groups_of(done, others);
    for (const std::string name : {ratios ? "energy_left" : "energy_end", "tip_displacement_end"}) {
      std::vector<double> spreads;
      for (const Cases& group : groups)
        if (const Extent extent = extent_of(group, measured(name)); extent.count > 1)
          spreads.push_back(*extent.high - *extent.low);
      if (spreads.empty()) continue;
      table.rows.push_back(
          {choice, name, spreads.size(), lower_median(spreads), *std::max_element(spreads.begin(), spreads.end())});
    }
  }
  return table;
}

Table energy_ledger_table(const StudyResults& results) {
  Table table = table_of_cases(
      results, "energy_ledger",
      "One finished case: where its energy came from and where it went. end = start + loads − damping − stops − scheme "
      "− "
      "form + residual.",
      {{"start", "J", "The common energy of the initial state."},
       {"loads", "J", "What the load and the moving support brought in."},
       {"damping", "J", "What the viscous forces took."},
       {"stops", "J", "What contact took, less what springs at the stops still hold."},
       {"scheme", "J", "What the scheme itself took in flight: the losses that it declares, else 0."},
       {"form", "J",
        "Change of what the scheme's own energy, whose balance this is, holds beyond the common one; 0 where it "
        "declares "
        "none."},
       {"residual", "J",
        "What the balance fails to close by: round-off where the scheme's balance is exact, else losses that it does "
        "not declare."},
       {"end", "J", "The common energy at the end."},
       {"closes", "",
        "exact: the residual is below 1e-8 of the energy brought in; not exact; not known: the scheme declares no work "
        "form, so that works and residual are empty."}});
  for (const CaseRecord* record : with_status(all_cases(results), "done")) {
    const auto of = [&](const char* name) { return measure(*record, name); };
    const auto start = of("energy_start"), end = of("energy_end");
    if (!start || !end) continue;
    const auto residual = of("balance_residual"), brought_in = of("energy_brought_in");
    if (!residual || !brought_in) {
      add_row(table, place_of(results, *record), {*start, {}, {}, {}, {}, {}, {}, *end, "not known"});
      continue;
    }
    const auto own_start = of("scheme_energy_start"), own_end = of("scheme_energy_end");
    const double stored = of("stored_at_stops").value_or(0);
    const double form = own_start && own_end ? (*own_end - *own_start) - (*end - stored - *start) : 0.0;
    add_row(table, place_of(results, *record),
            {*start, of("work_of_loads"), of("work_of_damping"), of("dissipated_at_contact"),
             of("dissipated_by_scheme").value_or(0), form, *residual, *end,
             std::abs(*residual) <= exact_balance * *brought_in ? "exact" : "not exact"});
  }
  return table;
}

}  // namespace ricochet
