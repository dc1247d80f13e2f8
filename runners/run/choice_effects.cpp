#include "runners/run/choice_effects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/measure/statistics/effects.hpp>
#include <set>

#include "runners/report/html.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet {

MeasureScale::MeasureScale(const std::string& measure) : measure_(measure) {
  if (const MeasureInfo* info = measure_info(measure)) scale_ = info->scale;
}

std::optional<double> MeasureScale::of(const CaseRecord& record) const {
  if (share()) return 1.0;
  if (!own()) return measure(record, scale_);
  const auto value = measure(record, measure_);
  return value ? std::optional(std::abs(*value)) : std::nullopt;
}

MeasureSpread spread_of(const StudyResults& results, const std::string& name) {
  const MeasureScale scale(name);
  MeasureSpread spread;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const CaseRecord& record : results.cases) {
    const auto value = record.status == "done" ? measure(record, name) : std::nullopt;
    if (!value) continue;
    low = std::min(low, *value);
    high = std::max(high, *value);
    const double own = scale.of(record).value_or(0);
    spread.scale = std::max(spread.scale, own);
    spread.floor = std::max(spread.floor, round_off(record) * own);
  }
  spread.width = high - low;
  return spread;
}

double round_off(const CaseRecord& record) {
  return 0x1p-52 * static_cast<double>(record.steps);
}

namespace {

double number_on(const CaseRecord& record, const char* column) {
  return axis(record, column).number().value_or(0);
}

/// A measure over its scale; what has none is scaled by its group later.
std::optional<double> scaled(const CaseRecord& record, const std::string& name, const MeasureScale& scale) {
  const auto value = measure(record, name);
  if (!value || scale.own()) return value;
  const auto size = scale.of(record);
  return size && *size > 0 ? std::optional(*value / *size) : std::nullopt;
}

std::string scale_words(const MeasureScale& scale) {
  if (scale.share()) return "";
  return scale.own() ? "of the larger" : "of the " + report::in_words(scale.name());
}

/// A case with its value, and with half the interval of that where it is a mean over a window.
struct Reading {
  const CaseRecord* record;
  double value;
  std::optional<double> sampling;
};

/// One level: its cases with a value, and the finest of them.
struct FinestLevel {
  std::vector<Reading> cases;

  const Reading& finest() const {
    return *std::max_element(cases.begin(), cases.end(), [](const Reading& a, const Reading& b) {
      const double mesh_a = number_on(*a.record, "elements"), mesh_b = number_on(*b.record, "elements");
      return mesh_a != mesh_b ? mesh_a < mesh_b : number_on(*a.record, "step") > number_on(*b.record, "step");
    });
  }
  /// By how much the value moved from the next coarser size of `refined` to the finest, all else being the same.
  std::optional<double> last_move(const char* refined, const char* other) const {
    const Reading& chosen = finest();
    const bool step = std::string_view(refined) == "step";
    const double size = number_on(*chosen.record, refined);
    std::optional<double> next, move;
    for (const auto& [record, own, sampling] : cases) {
      const double at = number_on(*record, refined);
      if (number_on(*record, other) != number_on(*chosen.record, other) || (step ? at <= size : at >= size)) continue;
      if (next && (step ? at >= *next : at <= *next)) continue;
      next = at;
      move = std::abs(own - chosen.value);
    }
    return move;
  }
};

GroupEffect group_effect(std::vector<FinestLevel>& levels, bool own_scale) {
  GroupEffect out;
  double largest = 0, floor = 0;
  for (const FinestLevel& level : levels) largest = std::max(largest, std::abs(level.finest().value));
  if (own_scale && largest > 0)
    for (FinestLevel& level : levels)
      for (Reading& one : level.cases) {
        one.value /= largest;
        if (one.sampling) *one.sampling /= largest;
      }
  std::vector<LevelValue> values;
  for (const FinestLevel& level : levels) {
    const Reading& best = level.finest();
    out.levels.push_back(best.record);
    out.elements = std::max(out.elements, number_on(*best.record, "elements"));
    const double step = number_on(*best.record, "step");
    if (out.step == 0 || (step > 0 && step < out.step)) out.step = step;
    values.push_back(
        {best.value, level.last_move("step", "elements"), level.last_move("elements", "step"), best.sampling});
    // A measure that is its own scale is known to all its digits, but for those that a run loses.
    if (!own_scale) floor = std::max(floor, round_off(*best.record));
  }
  out.found = resolved_effect(values, answer_threshold, floor);
  return out;
}

}  // namespace

bool refines(const std::string& column) {
  return column == "step" || column == "elements";
}

std::size_t ChoiceEffects::count(EffectVerdict verdict) const {
  return static_cast<std::size_t>(std::count_if(
      groups.begin(), groups.end(), [&](const GroupEffect& group) { return group.found.verdict == verdict; }));
}

std::vector<ChoiceEffects> choice_effects(const StudyResults& results, const std::vector<std::string>& measures) {
  const Cases done = with_status(all_cases(results), "done");
  std::vector<std::string> choices;
  for (const std::string& column : results.columns) {
    const std::string choice = axis_role(column);
    if (refines(column) || std::find(choices.begin(), choices.end(), choice) != choices.end()) continue;
    choices.push_back(choice);
  }
  std::vector<ChoiceEffects> out;
  for (const std::string& choice : choices) {
    std::vector<std::string> own, others;
    for (const std::string& column : results.columns)
      if (!refines(column)) (axis_role(column) == choice ? own : others).push_back(column);
    const std::vector<Cases> groups = groups_of(done, others);
    for (const std::string& name : measures) {
      const MeasureScale scale(name);
      ChoiceEffects effects{choice, name, scale_words(scale), {}};
      for (const Cases& group : groups) {
        std::vector<FinestLevel> levels;
        for (const Cases& cases : groups_of(group, own)) {
          FinestLevel level;
          for (const CaseRecord* record : cases)
            if (const auto value = scaled(*record, name, scale))
              level.cases.push_back({record, *value, scaled(*record, "confidence." + name, scale)});
          if (!level.cases.empty()) levels.push_back(std::move(level));
        }
        if (levels.size() > 1) effects.groups.push_back(group_effect(levels, scale.own()));
      }
      if (!effects.groups.empty()) out.push_back(std::move(effects));
    }
  }
  return out;
}

namespace {

// A measure that no kind declares is taken for one of the motion.
bool of_the_motion(const std::string& measure) {
  const MeasureInfo* info = measure_info(measure);
  return !info || info->of == MeasureInfo::Of::motion;
}

// Whether the cases of some level that were run to their end never have this measure while those of another do: then
// the method (or the step, the mesh) has none, and what is absent may neither be filled in nor taken for zero.
bool absent_by_level(const StudyResults& results, const std::vector<Factor>& factors,
                     const std::vector<std::optional<double>>& values) {
  for (const Factor& factor : factors) {
    std::vector<int> done(factor.levels.size(), 0), present(factor.levels.size(), 0);
    for (std::size_t c = 0; c < values.size(); ++c) {
      done[factor.level[c]] += results.cases[c].status == "done" ? 1 : 0;
      present[factor.level[c]] += values[c] ? 1 : 0;
    }
    for (std::size_t l = 0; l < done.size(); ++l)
      if (done[l] > 0 && present[l] == 0) return true;
  }
  return false;
}

/// Whether what the finished cases differ by is more than round-off makes of the measure: 2⁻⁵² × steps of its scale.
bool beyond_round_off(const StudyResults& results, const std::string& name) {
  const MeasureSpread spread = spread_of(results, name);
  return spread.width > spread.floor;
}

/// Two levels have a difference, and no share that another choice of levels would not change: a factor needs three.
bool has_share(const EffectShare& share, const std::vector<Factor>& factors) {
  static const std::string times = " × ";
  constexpr std::size_t fewest = 3;
  const std::string padded = times + share.factor + times;
  return std::none_of(factors.begin(), factors.end(), [&](const Factor& factor) {
    return factor.levels.size() < fewest && padded.find(times + factor.name + times) != std::string::npos;
  });
}

}  // namespace

Table effects_table(const StudyResults& results) {
  Table table{"effects",
              "Over all cases: what one choice, or two together, explain of the spread of one measure. Choices of two "
              "levels have differences (answers.csv) and no share; a measure whose spread round-off explains has none.",
              {{"measure", "", "The measure, a column of cases.csv."},
               {"factor", "", "The axis that was varied; two joined by × for what only their combination explains."},
               {"share", "1", "Share of the variance of the measure over the finished cases that the factor explains."},
               {"low", "1", "Lower end of the 95 % interval of the share."},
               {"high", "1", "Upper end of the 95 % interval of the share."},
               {"log", "", "Whether the logarithm of the measure was analysed, because it spans orders of magnitude."}},
              {}};
  std::vector<std::vector<std::string>> cells;
  std::vector<std::string> measures;
  for (const CaseRecord& record : results.cases) {
    std::vector<std::string> row;
    for (const Cell& value : axes_of(record, results.columns)) row.push_back(value.text());
    cells.push_back(std::move(row));
    for (const auto& [name, value] : record.measures)
      if (of_the_motion(name) && std::find(measures.begin(), measures.end(), name) == measures.end())
        measures.push_back(name);
  }
  std::vector<Factor> factors = factors_of(results.columns, cells).factors;
  std::erase_if(factors, [](const Factor& factor) { return factor.levels.size() < 2; });
  const auto told = [](const Factor& factor) { return factor.levels.size() > 2; };
  if (factors.size() < 2 || std::none_of(factors.begin(), factors.end(), told)) return table;
  for (const std::string& name : measures) {
    std::vector<std::optional<double>> values;
    for (const CaseRecord& record : results.cases)
      values.push_back(record.status == "done" ? measure(record, name) : std::nullopt);
    if (absent_by_level(results, factors, values) || !beyond_round_off(results, name)) continue;
    const Effects effects = effects_of(factors, values);
    for (const EffectShare& share : effects.shares)
      if (has_share(share, factors))
        table.rows.push_back({name, share.factor, share.share, share.low, share.high, effects.log});
  }
  return table;
}

}  // namespace ricochet
