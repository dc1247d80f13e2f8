#include "runners/kinds/stability/stability_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/stability/stability.hpp>

#include "runners/store/record_values.hpp"
#include "runners/store/rows_of_cases.hpp"

namespace ricochet {
namespace {

const Column step_column{"step", "s", "Time step h of the range."};

}  // namespace

TableType<StabilityRow> stability_type() {
  RowType<StabilityRow> rows;
  rows.add(step_column, &StabilityRow::step)
      .add({"closed", "",
            "Whether contact is closed: predicted with points held on both sides, observed in the scene itself, whose "
            "contacts open and close. Otherwise the structure alone."},
           &StabilityRow::closed)
      .add({"radius", "1", "Spectral radius of the step, the largest modulus of its eigenvalues."},
           &StabilityRow::radius)
      .add({"marginal", "", "Which roots on the unit circle are the scheme's own, and what they do."},
           &StabilityRow::marginal)
      .add({"limit_predicted", "s", "Largest step of the range up to which the radius stays at 1; empty: none found."},
           &StabilityRow::limit_predicted)
      .add({"limit_observed", "s",
            "Largest step up to which these marches stay bounded, by bisection; empty: none found."},
           &StabilityRow::limit_observed)
      .add({"status", "", "stable, marginal, unstable, failed or refused."}, &StabilityRow::status)
      .add({"reason", "", "What grows and how fast, and where prediction and march disagree."}, &StabilityRow::reason);
  return {"stability",
          "One step of the range, with the contact held open or closed: what the plan predicts, and what was seen.",
          rows};
}

TableType<ObservedRow> stability_observed_type() {
  RowType<ObservedRow> rows;
  rows.add(step_column, &ObservedRow::step)
      .add({"closed", "", "Whether the scene with its contacts was marched; otherwise the structure alone."},
           &ObservedRow::closed)
      .add({"behaviour", "", "stable, marginal (grows like the number of steps), unstable, diverged or failed."},
           &ObservedRow::behaviour)
      .add({"growth", "1", "Growth of the amplitudes per step, where they grow geometrically."}, &ObservedRow::growth)
      .add({"gain", "1", "Largest energy that nothing gave, over all that was given."}, &ObservedRow::gain)
      .add({"impacts", "1", "Number of times that a contact point closed, summed over the points."},
           &ObservedRow::impacts)
      .add({"changes_per_impact", "1",
            "Changes of the set of closed points for each time that contact began anywhere; 2: it closes and opens."},
           &ObservedRow::changes_per_impact)
      .add({"fast_share", "1", "Share of the contact force's power above a quarter of the step frequency."},
           &ObservedRow::fast_share)
      .add({"chatter", "",
            "Whether contact flickers: over 0.75 of the power is fast, or over 20 changes for each time that contact "
            "began."},
           &ObservedRow::chatter)
      .add({"first_bad_step", "1", "Number of the step at which the growth showed."}, &ObservedRow::first_bad_step)
      .add({"steps", "1", "Steps that were marched."}, &ObservedRow::steps)
      .add({"cause", "", "What was seen, one sentence; empty where it is stable."}, &ObservedRow::cause);
  return {"stability_observed",
          "One integration: a step of the range, of the structure alone or of the scene with its contacts.", rows};
}

TableType<RestitutionRow> restitution_type() {
  RowType<RestitutionRow> rows;
  rows.of_case(&RestitutionRow::id)
      .add({"step", "s", "Step of the plan that was asked: the smallest of the range that has one."},
           &RestitutionRow::step)
      .add({"least", "1", "Smallest −v⁺/v⁻ over 64 phases of the impact within the step."}, &RestitutionRow::least)
      .add({"mean", "1", "Their mean."}, &RestitutionRow::mean)
      .add({"most", "1", "The largest; beyond 1 the scheme throws a mass back faster than it came."},
           &RestitutionRow::most)
      .add({"rho_inf", "1", "What a step leaves of the highest frequencies, ρ∞; nothing for an explicit step."},
           &RestitutionRow::rho_inf);
  return {"restitution",
          "What a free mass keeps of its speed at a rigid stop, over the phases of the step at which it arrives. It "
          "follows from the plan alone.",
          rows};
}

void describe_stability(std::vector<CaseRecord>& cases) {
  const std::vector<Table> heads = {stability_type().head(), stability_observed_type().head(),
                                    stability_roots_type().head(), restitution_type().head()};
  for (CaseRecord& record : cases)
    for (Table& table : record.tables) {
      const auto contact = find_column(table.columns, "contact");
      if (!contact || !find_table(heads, table.name)) continue;
      table.columns.own()[*contact].name = "closed";
      for (Row& row : table.rows) row.at(*contact) = row.at(*contact) == "closed";
    }
  describe(cases, heads);
}

namespace {

std::string prediction_at(const StepCell& cell) {
  if (cell.predicted_unstable()) return "predicted unstable";
  if (!cell.worst) return "not predicted";
  return cell.marginal.empty() ? "predicted stable" : "predicted marginal";
}

// Calls `use` with each contact state of each case that has one.
template <class Use>
void each_range(const StudyResults& results, Use use) {
  for (const bool closed : {false, true})
    for (const CaseRecord& record : results.cases)
      if (const auto range = step_range(record, closed)) use(record, closed, *range);
}

const std::vector<Column> range_columns = {{"case", "", "Identity of the case: its row in cases.csv."},
                                           {"closed", "", "Whether the contact is closed."}};

Table table_of_ranges(std::string name, std::string text, const std::vector<Column>& columns) {
  Table out{std::move(name), std::move(text), range_columns, {}};
  out.columns = joined(out.columns, columns);
  return out;
}

}  // namespace

Table stability_cells_table(const StudyResults& results) {
  Table out = table_of_ranges(
      "stability_cells", "One row per case, contact state and step: what was predicted there, and what was observed.",
      {{"step", "s", "The step."},
       {"radius", "1", "Spectral radius of one step of this contact state."},
       {"growth", "1", "Spectral radius less one."},
       {"worst", "1", "Largest radius of the states that a marched scene meets: it is open as well."},
       {"prediction", "", "predicted stable, marginal or unstable; not predicted."},
       {"behaviour", "", "What marching showed; nothing where the cell was not marched."},
       {"unstable", "", "Whether it was observed to grow."},
       {"disagrees", "", "Whether prediction and observation differ."},
       {"marginal", "", "Roots on the unit circle, where there are any."},
       {"status", "", "stable, marginal, unstable, failed or refused."},
       {"reason", "", "Why, where it is not stable."}});
  each_range(results, [&](const CaseRecord& record, bool closed, const StepRange& range) {
    for (const StepCell& cell : range.cells) {
      const auto growth = cell.radius ? std::optional(*cell.radius - 1) : std::nullopt;
      out.rows.push_back({record.id, closed, cell.step, Cell(cell.radius), Cell(growth), Cell(cell.worst),
                          prediction_at(cell), cell.behaviour ? word(*cell.behaviour) : "", cell.observed_unstable(),
                          cell.disagrees(), cell.marginal, word(cell.status), cell.reason});
    }
  });
  return out;
}

Table stability_disagreements_table(const StudyResults& results) {
  Table out = table_of_ranges(
      "stability_disagreements",
      "One row per range of neighbouring steps at which prediction and observation differ in the same way.",
      {{"from", "s", "Smallest step of the range."},
       {"to", "s", "Largest step of the range."},
       {"steps", "1", "Steps in the range."},
       {"predicted", "", "stable or unstable."},
       {"observed", "", "stable or unstable."}});
  const auto did = [](bool unstable) { return unstable ? "unstable" : "stable"; };
  each_range(results, [&](const CaseRecord& record, bool closed, const StepRange& range) {
    for (const Disagreement& one : disagreements(range))
      out.rows.push_back(
          {record.id, closed, one.from, one.to, one.steps, did(one.predicted_unstable), did(!one.predicted_unstable)});
  });
  return out;
}

namespace {

std::map<double, Behaviour> behaviours_of(const CaseRecord& record, bool closed) {
  std::map<double, Behaviour> out;
  for (const ObservedRow& row : stability_observed_type().read(record.tables))
    if (row.step && row.closed == closed) out[*row.step] = row.behaviour;
  return out;
}

// The range as the case left it; nothing where it has none.
std::optional<StepRange> own_range(const CaseRecord& record, bool closed) {
  const std::map<double, Behaviour> behaviours = behaviours_of(record, closed);
  StepRange out;
  for (const StabilityRow& row : stability_type().read(record.tables)) {
    if (row.closed != closed || !row.step) continue;
    const auto seen = behaviours.find(*row.step);
    out.cells.push_back({*row.step, row.radius, row.radius, row.marginal, row.status, row.reason,
                         seen == behaviours.end() ? std::nullopt : std::optional(seen->second)});
    out.predicted = row.limit_predicted;
    out.observed = row.limit_observed;
  }
  if (out.cells.empty()) return std::nullopt;
  out.expected = out.predicted;
  std::stable_sort(out.cells.begin(), out.cells.end(),
                   [](const StepCell& a, const StepCell& b) { return a.step < b.step; });
  return out;
}

}  // namespace

std::optional<StepRange> step_range(const CaseRecord& record, bool closed) {
  std::optional<StepRange> out = own_range(record, closed);
  const std::optional<StepRange> open = out && closed ? own_range(record, false) : std::nullopt;
  if (!open) return out;
  if (open->predicted) out->expected = std::min(*open->predicted, out->predicted.value_or(*open->predicted));
  for (StepCell& one : out->cells) {
    const auto apart = std::lower_bound(open->cells.begin(), open->cells.end(), one.step,
                                        [](const StepCell& cell, double step) { return cell.step < step; });
    if (apart != open->cells.end() && apart->step == one.step && apart->radius && one.radius)
      one.worst = std::max(*one.radius, *apart->radius);
  }
  return out;
}

bool StepCell::predicted_unstable() const {
  return worst && *worst > 1 + growth_tolerance;
}

std::vector<Disagreement> disagreements(const StepRange& range) {
  std::vector<Disagreement> out;
  const std::vector<StepCell>& cells = range.cells;
  for (std::size_t i = 0; i < cells.size();) {
    if (!cells[i].disagrees()) {
      ++i;
      continue;
    }
    std::size_t end = i;
    const bool predicted = cells[i].predicted_unstable();
    while (end < cells.size() && cells[end].disagrees() && cells[end].predicted_unstable() == predicted) ++end;
    out.push_back({cells[i].step, cells[end - 1].step, end - i, predicted});
    i = end;
  }
  return out;
}

namespace {

// Whether the range has a limit, and which way it has none.
template <class Known, class Unstable>
RangeLimit where(const StepRange& range, const std::optional<double>& limit, Known known, Unstable unstable) {
  if (limit) return RangeLimit::limit;
  if (std::none_of(range.cells.begin(), range.cells.end(), known)) return RangeLimit::not_made;
  return std::any_of(range.cells.begin(), range.cells.end(), unstable) ? RangeLimit::below : RangeLimit::none;
}

RangeLimit prediction(const StepRange& range) {
  // Of its own spectrum: what grows apart from the stops has a limit of its own.
  const auto known = [](const StepCell& cell) { return cell.radius.has_value(); };
  const auto unstable = [](const StepCell& cell) { return cell.radius && *cell.radius > 1 + growth_tolerance; };
  return where(range, range.predicted, known, unstable);
}

RangeLimit observation(const StepRange& range) {
  const auto known = [](const StepCell& cell) { return cell.behaviour.has_value(); };
  return where(range, range.observed, known, std::mem_fn(&StepCell::observed_unstable));
}

std::string marginal(const StepRange& range) {
  std::vector<std::string> said;
  for (const StepCell& cell : range.cells)
    if (!cell.marginal.empty() && std::find(said.begin(), said.end(), cell.marginal) == said.end())
      said.push_back(cell.marginal);
  if (said.size() > 2) {
    const std::size_t more = said.size() - 2;
    said.resize(2);
    said.push_back(fmt::format("and {} more", more));
  }
  return fmt::format("{}", fmt::join(said, "; "));
}

// The smallest step that is not stable, and what grows there: the first sentence of its reason, the others say what was
// seen.
const StepCell* first_unstable(const StepRange& range) {
  const auto found = std::find_if(range.cells.begin(), range.cells.end(), [](const StepCell& cell) {
    return cell.status != StepStatus::stable && cell.status != StepStatus::marginal;
  });
  return found == range.cells.end() ? nullptr : &*found;
}

bool is_contact(const std::string& column) {
  return column == "contact" || column.starts_with("contact.");
}

// Of the cases that differ in the contact law alone: the first that was done, or the first.
Cases counted_open(const StudyResults& results) {
  std::vector<std::string> others;
  for (const std::string& column : results.columns)
    if (!is_contact(column)) others.push_back(column);
  Cases open = all_cases(results), out;
  std::erase_if(open, [](const CaseRecord* record) { return !step_range(*record, false); });
  for (const Cases& group : groups_of(open, others)) {
    const auto done = std::find_if(group.begin(), group.end(),
                                   [](const CaseRecord* record) { return record->status == Status::done; });
    out.push_back(done == group.end() ? group.front() : *done);
  }
  return out;
}

}  // namespace

TableType<LimitRow> step_limits_type() {
  RowType<LimitRow> rows;
  rows.of_case(&LimitRow::id)
      .add({"closed", "",
            "Whether contact is closed: predicted with points held on both sides, observed in the scene itself. "
            "Otherwise the structure alone."},
           &LimitRow::closed)
      .add(
          {"counted", "",
           "Whether the row counts in step_limit_agreement.csv: the open structure of cases that differ in the contact "
           "law alone counts once."},
          &LimitRow::counted)
      .add({"prediction", "", "limit, none (every step of the range is stable), below the range, or empty: not made."},
           &LimitRow::prediction)
      .add({"predicted", "s", "Largest stable step, from the plan alone."}, &LimitRow::predicted)
      .add({"observation", "", "limit, none (every step of the range is stable), below the range, or empty: not made."},
           &LimitRow::observation)
      .add({"observed", "s", "Largest stable step, from marches and bisection."}, &LimitRow::observed)
      .add({"expected", "s", "The smallest predicted limit that the marched cell meets: a scene is open as well."},
           &LimitRow::expected)
      .add({"ratio", "1", "observed over expected."}, &LimitRow::ratio)
      .add({"agrees", "", "Whether the ratio is one to 2 %; empty where a limit is missing."}, &LimitRow::agrees)
      .add({"disagreeing_steps", "1", "Steps of the range at which the integration does not do what the spectra say."},
           &LimitRow::disagreeing)
      .add({"marginal", "", "Which roots on the unit circle are the scheme's own, over the range."},
           &LimitRow::marginal)
      .add({"first_unstable", "s", "Smallest step of the range that is unstable, failed or refused."},
           &LimitRow::first_unstable)
      .add({"grows", "", "What grows there, or why it is refused."}, &LimitRow::grows)
      .add({"refused", "", "Whether that step is refused."}, &LimitRow::refused);
  return {"step_limits", "One case with its contact open or closed: the step limits that its cells come to.", rows};
}

std::vector<LimitRow> step_limit_rows(const StudyResults& results) {
  std::vector<LimitRow> rows;
  const Cases counted = counted_open(results);
  for (const bool closed : {false, true})
    for (const CaseRecord& record : results.cases) {
      const std::optional<StepRange> range = step_range(record, closed);
      if (!range) continue;
      LimitRow row;
      row.id = record.id;
      row.closed = closed;
      row.counted = closed || std::find(counted.begin(), counted.end(), &record) != counted.end();
      row.prediction = prediction(*range);
      row.predicted = range->predicted;
      row.observation = observation(*range);
      row.observed = range->observed;
      row.expected = range->expected;
      if (range->expected && range->observed) row.ratio = *range->observed / *range->expected;
      if (row.ratio) row.agrees = std::abs(*row.ratio - 1) <= limit_tolerance;
      row.disagreeing = static_cast<int>(std::count_if(range->cells.begin(), range->cells.end(),
                                                       [](const StepCell& cell) { return cell.disagrees(); }));
      row.marginal = marginal(*range);
      if (const StepCell* grows = first_unstable(*range)) {
        row.first_unstable = grows->step;
        row.grows = grows->reason.substr(0, grows->reason.find("; "));
        row.refused = grows->status == StepStatus::refused;
      }
      rows.push_back(std::move(row));
    }
  return rows;
}

Table step_limits_table(const StudyResults& results, const std::vector<LimitRow>& rows) {
  return rows_of_cases(results, step_limits_type(), rows);
}

Table step_limit_agreement_table(const Table& step_limits) {
  Table table{"step_limit_agreement",
              "Over all cases: how often observed step limits are those that are expected.",
              {{"contact", "", "open, closed, or both together."},
               {"ranges", "1", "Ranges of steps: a method with its contact open or closed."},
               {"limits", "1", "Ranges whose limit is both predicted and observed."},
               {"agree", "1", "Those whose limits agree within the tolerance."},
               {"tolerance", "1", "Difference, relative to the expected limit, up to which limits agree."},
               {"disagree", "1", "Ranges with a step at which the integration does not do what the spectra say."}},
              {}};
  const std::vector<LimitRow> rows = step_limits_type().rows.read(step_limits);
  for (const char* contact : {"open", "closed", "both"}) {
    int ranges = 0, limits = 0, agree = 0, disagree = 0;
    for (const LimitRow& row : rows) {
      const bool asked = contact == std::string("both") || row.closed == (contact == std::string("closed"));
      if (!asked || !row.counted) continue;
      ++ranges;
      limits += row.agrees.has_value();
      agree += row.agrees == true;
      disagree += row.disagreeing > 0;
    }
    table.rows.push_back({contact, ranges, limits, agree, limit_tolerance, disagree});
  }
  return table;
}

}  // namespace ricochet
