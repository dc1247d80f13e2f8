#include "runners/run/choice_effects.hpp"

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"
#include "runners/run/measure_scale.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet {
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

}  // namespace ricochet
