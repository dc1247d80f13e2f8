#include "runners/run/answers_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <ricochet/measure/statistics/choices.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "runners/kinds/kind.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/effects.hpp"
#include "runners/report/html.hpp"
#include "runners/run/choice_effects.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

constexpr double nearly_all = 0.9, tells = 0.8;

/// What groups of one choice and one measure say together: all of them, or those that share a verdict.
struct Said {
  const ChoiceEffects* effects = nullptr;
  std::vector<const GroupEffect*> groups;
  std::string verdict, depends_on;
  double median = 0, largest = 0;       ///< effects, over the scale
  std::optional<double> step, mesh;     ///< median of what they leave open
  std::optional<double> sampling;       ///< median of half the intervals
  const GroupEffect* widest = nullptr;  ///< the group with the largest effect
  std::string clause;                   ///< of a sentence about the choice
};

constexpr double negligible = 1e-9;

std::string percent(double share) {
  constexpr double many = 10, whole = 0.995;
  if (share > 0 && share < negligible) return "less than 1e-7 %";
  if (share >= many) return report::number_text(share, 2) + " times";
  if (share >= whole) return fmt::format("{:.0f} %", 100 * share);
  return report::number_text(100 * share, 2) + " %";
}

std::string of_scale(const ChoiceEffects& effects, double share) {
  return percent(share) + (effects.scale.empty() ? "" : " " + effects.scale);
}

std::optional<double> median_open(const std::vector<const GroupEffect*>& groups,
                                  std::optional<double> ResolvedEffect::*move) {
  std::vector<double> known;
  for (const GroupEffect* group : groups)
    if (group->found.*move) known.push_back(*(group->found.*move));
  return known.empty() ? std::nullopt : std::optional(lower_median(known));
}

/// The other choice that tells the groups that decide from those that do not; "" where none does.
std::string separating_choice(const StudyResults& results, const ChoiceEffects& effects) {
  std::vector<int> labels;
  for (const GroupEffect& group : effects.groups) labels.push_back(static_cast<int>(group.found.verdict));
  std::vector<ChoiceAxis> axes;
  for (const std::string& column : results.columns) {
    if (refines(column) || axis_role(column) == effects.choice) continue;
    ChoiceAxis axis_levels{column, {}};
    for (const GroupEffect& group : effects.groups)
      axis_levels.levels.push_back(axis(*group.levels.front(), column).text());
    axes.push_back(std::move(axis_levels));
  }
  const DecidingChoice found = deciding_choice(labels, axes);
  return found.share >= tells ? found.name : "";
}

/// "against 0.6 % from the step and 0.1 % from the mesh".
std::string against(const Said& said) {
  std::string out;
  if (said.step) out = percent(*said.step) + " from the step";
  if (said.mesh) out += (out.empty() ? "" : " and ") + percent(*said.mesh) + " from the mesh";
  if (said.sampling) out += (out.empty() ? "" : " and ") + percent(*said.sampling) + " from the length of the window";
  return out.empty() ? "" : "against " + out;
}

/// Down to 1, 2 or 5 times a power of ten.
double rounded_down(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  const double digit = value / decade;
  return decade * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

/// Up to two digits that count.
std::string two_digits(double value) {
  const double unit = std::max(1.0, std::pow(10, std::floor(std::log10(value)) - 1));
  return fmt::format("{:.0f}", unit * std::ceil(value / unit));
}

/// "; refine h to 2e-6 s": where what is open, if it falls with h (or with the element), is a third of the effect.
std::string next_sizes(const std::vector<const Said*>& same) {
  double step = 0, elements = 0, open_step = 0, open_mesh = 0, open_window = 0;
  for (const Said* said : same)
    for (const GroupEffect* group : said->groups) {
      if (group->found.verdict != EffectVerdict::unresolved) continue;
      const double wanted = std::max(answer_threshold, group->found.effect) / 3;
      if (group->step > 0 && (step == 0 || group->step < step)) step = group->step;
      elements = std::max(elements, group->elements);
      open_step = std::max(open_step, group->found.step.value_or(0) / wanted);
      open_mesh = std::max(open_mesh, group->found.mesh.value_or(0) / wanted);
      open_window = std::max(open_window, group->found.sampling.value_or(0) / wanted);
    }
  // What is open so far beyond what is wanted is not refined away.
  constexpr double hopeless = 100;
  std::string out, beyond;
  if (open_step > hopeless)
    beyond = "the step";
  else if (open_step > 1 && step > 0)
    out = fmt::format("refine h to {} s", report::number_text(rounded_down(step / open_step), 3));
  if (open_mesh > hopeless)
    beyond += beyond.empty() ? "the mesh" : " and the mesh";
  else if (open_mesh > 1 && elements > 0)
    out += fmt::format("{} the mesh to {} elements", out.empty() ? "refine" : " and", two_digits(elements * open_mesh));
  if (!out.empty()) out = "; " + out + " (if what is open falls with them)";
  if (!beyond.empty())
    out += fmt::format("; in some combinations {} leave{} more open than refining would settle", beyond,
                       beyond.ends_with("and the mesh") ? "" : "s");
  // The interval of a mean falls with the root of its length.
  if (open_window > 1) out += fmt::format("; a window {} times as long", two_digits(open_window * open_window));
  return out;
}

/// What the groups come to: the word of a verdict, or "depends".
std::string verdict_of(const ChoiceEffects& effects) {
  const std::size_t observed = effects.groups.size() - effects.count(EffectVerdict::not_observed);
  if (observed == 0) return effect_word(EffectVerdict::not_observed);
  const auto share = [&](EffectVerdict verdict) {
    return static_cast<double>(effects.count(verdict)) / static_cast<double>(observed);
  };
  if (share(EffectVerdict::untold) > 0.5) return effect_word(EffectVerdict::untold);
  for (const EffectVerdict verdict : {EffectVerdict::decides, EffectVerdict::no_matter})
    if (share(verdict) >= nearly_all) return effect_word(verdict);
  if (share(EffectVerdict::decides) == 0 || share(EffectVerdict::unresolved) + share(EffectVerdict::untold) > 0.5)
    return effect_word(EffectVerdict::unresolved);
  return "depends";
}

Said said_of_groups(const ChoiceEffects& effects, std::vector<const GroupEffect*> groups, std::string verdict) {
  Said out;
  out.effects = &effects;
  out.groups = std::move(groups);
  out.verdict = std::move(verdict);
  std::vector<double> sizes;
  for (const GroupEffect* group : out.groups) {
    sizes.push_back(group->found.effect);
    if (!out.widest || group->found.effect > out.widest->found.effect) out.widest = group;
  }
  out.median = lower_median(sizes);
  out.largest = out.widest->found.effect;
  out.step = median_open(out.groups, &ResolvedEffect::step);
  out.mesh = median_open(out.groups, &ResolvedEffect::mesh);
  out.sampling = median_open(out.groups, &ResolvedEffect::sampling);
  return out;
}

/// One thing to say of a choice and a measure; two where in most combinations, of several, the choice does not matter
/// and in the others that is not resolved: a median over both would be neither.
std::vector<Said> said_of(const StudyResults& results, const ChoiceEffects& effects) {
  const std::string verdict = verdict_of(effects);
  std::vector<const GroupEffect*> all, open, settled;
  for (const GroupEffect& group : effects.groups) {
    all.push_back(&group);
    if (group.found.verdict == EffectVerdict::unresolved) open.push_back(&group);
    if (group.found.verdict == EffectVerdict::no_matter) settled.push_back(&group);
  }
  constexpr std::size_t several = 4;
  if (verdict == "not resolved" && all.size() >= several && !open.empty() && settled.size() >= open.size() &&
      effects.count(EffectVerdict::decides) == 0 && effects.count(EffectVerdict::untold) == 0)
    return {said_of_groups(effects, open, verdict),
            said_of_groups(effects, settled, effect_word(EffectVerdict::no_matter))};
  Said out = said_of_groups(effects, all, verdict);
  if (verdict == "depends") out.depends_on = separating_choice(results, effects);
  return {out};
}

/// "by 0.4 % of the larger", with the number of combinations where there are several, and of how many where not of all.
std::string range_of(const Said& said, const std::string& by) {
  const ChoiceEffects& effects = *said.effects;
  const bool part = said.groups.size() < effects.groups.size();
  const std::string where =
      part ? fmt::format("in {} of {} combinations ", said.groups.size(), effects.groups.size()) : "";
  const std::string size = where + by + of_scale(effects, said.largest < negligible ? said.largest : said.median);
  if (said.groups.size() < 2 || said.largest <= 1.05 * said.median || said.largest < negligible) return size;
  if (part) return fmt::format("{} (median; up to {})", size, percent(said.largest));
  return fmt::format("{} (median of {} combinations; up to {})", size, effects.groups.size(), percent(said.largest));
}

/// "least with consistent, most with singular", where the choice moves the measure most.
std::string extremes(const report::CaseView& view, const Said& said) {
  std::vector<std::string> own;
  for (const std::string& column : view.varying())
    if (axis_role(column) == said.effects->choice) own.push_back(column);
  const GroupEffect& group = *said.widest;
  const std::string least = view.label(*group.levels[group.found.least], own),
                    most = view.label(*group.levels[group.found.most], own);
  return fmt::format("least with {}, most with {}", least, most);
}

std::string as_sentence(std::string text) {
  // The first letter of a choice is one of ASCII.
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text + ".";
}

std::string clause(const report::CaseView& view, const Said& said) {
  const ChoiceEffects& effects = *said.effects;
  const std::string name = report::in_words(effects.measure);
  const std::string by = said.verdict == "does not matter" ? "" : "by ";
  if (said.verdict == "not observed") return name;
  if (said.verdict == "not told") return fmt::format("{} {}", name, range_of(said, by));
  if (said.verdict == "does not matter") return fmt::format("{} {} {}", name, range_of(said, by), against(said));
  if (said.verdict == "decides")
    return fmt::format("{} {} {} ({})", name, range_of(said, by), against(said), extremes(view, said));
  if (said.verdict == "not resolved") return fmt::format("{} {} {}", name, range_of(said, by), against(said));
  return fmt::format("{} in {} of {} combinations by up to {}", name, effects.count(EffectVerdict::decides),
                     effects.groups.size(), of_scale(effects, said.largest));
}

/// Whether some effect is larger than all that step, mesh and window leave open: it is seen, and small.
bool beyond_refinement(const std::vector<const Said*>& same) {
  return std::any_of(same.begin(), same.end(), [](const Said* said) {
    return said->median > said->step.value_or(0) + said->mesh.value_or(0) + said->sampling.value_or(0);
  });
}

/// A sentence on what has the same choice and verdict.
std::string sentence_of(const std::vector<const Said*>& same) {
  const Said& first = *same.front();
  const std::string name = spoken_choice(first.effects->choice);
  std::string clauses;
  for (const Said* said : same) clauses += (clauses.empty() ? "" : "; ") + said->clause;
  std::string out;
  if (first.verdict == "decides")
    out = fmt::format("{} decides: {}", name, clauses);
  else if (first.verdict == "does not matter")
    out = fmt::format("{} {} here: {}", name,
                      beyond_refinement(same) ? "changes less than " + percent(answer_threshold) : "does not matter",
                      clauses);
  else if (first.verdict == "not resolved")
    out = fmt::format("what {} changes is not resolved: {}{}", name, clauses, next_sizes(same));
  else if (first.verdict == "not told")
    out = fmt::format("{} changes {}; with one step and one mesh nothing tells whether these would: give two of each",
                      name, clauses);
  else if (first.verdict == "depends")
    out = fmt::format("{} decides in part{}: {}", name,
                      first.depends_on.empty() ? "" : ", as " + spoken_choice(first.depends_on) + " tells", clauses);
  else
    out = fmt::format("{} changes nothing that is observed: {} 0 or round-off throughout", name, clauses);
  return as_sentence(out);
}

/// Whether the finished cases spread in a measure by more than an answer overlooks.
bool spreads(const StudyResults& results, const std::string& name) {
  const MeasureSpread spread = spread_of(results, name);
  return spread.scale > 0 && spread.width / spread.scale > answer_threshold;
}

/// What each choice explains of the spread of what is observed, where that is one and effects.csv tells most of it.
void say_shares(const report::CaseView& view, const std::vector<std::string>& observed, Table& table) {
  const Table* effects = find_table(view.results().derived, "effects");
  if (!effects) return;
  constexpr double most = 0.5;
  std::map<std::string, double> told;
  const TableReader parts(*effects);
  for (std::size_t row = 0; row < parts.size(); ++row)
    told[parts.text(row, "measure")] += parts.number(row, "share").value_or(0);
  const Table shares = report::effects_said(view);
  const TableReader rows(shares);
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (const std::string name = rows.text(row, "measure");
        told[name] >= most && spreads(view.results(), name) &&
        std::find(observed.begin(), observed.end(), name) != observed.end())
      table.rows.push_back(
          AnswerRow{.measure = name, .verdict = "shares", .sentence = rows.text(row, "sentence")}.row());
}

/// " Why: the step is beyond … (12 cases); and 3 other reasons." of what most of these cases say; "" where each says
/// its own.
std::string why(const Table& reasons, const std::string& status, std::size_t cases) {
  constexpr std::size_t most = 3;
  constexpr std::size_t one_by_one = 3;  // cases
  constexpr double few = 0.1;
  std::vector<std::pair<double, std::string>> found;
  const TableReader rows(reasons);
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (rows.text(row, "status") == status && !rows.text(row, "reason").empty())
      found.emplace_back(rows.number(row, "cases").value_or(0), rows.text(row, "reason"));
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string out;
  std::size_t said = 0;
  const double least = cases <= one_by_one ? 1 : std::max(2.0, few * static_cast<double>(cases));
  for (; said < std::min(most, found.size()) && found[said].first >= least; ++said)
    out += fmt::format("{} {} ({:.0f})", said == 0 ? " Why:" : ";", found[said].second, found[said].first);
  if (said == 0) return "";
  if (said < found.size()) out += "; " + report::count_text(found.size() - said, "other reason", "other reasons");
  return out + ".";
}

/// Of cases that gave no result: how many, what sets them apart, and why.
void say_ends(const report::CaseView& view, Table& table) {
  const Table reasons = reasons_table(view.results());
  for (const char* status : {"diverged", "failed", "refused"}) {
    const Cases ended = view.with_status(status);
    if (ended.empty()) continue;
    const std::string who = ended.size() == 1 ? view.name(*ended.front()) : view.describe(ended);
    table.rows.push_back(AnswerRow{.verdict = status,
                                   .combinations = ended.size(),
                                   .sentence = fmt::format("{}{}: {}.{}", static_cast<char>(std::toupper(*status)),
                                                           status + 1, who, why(reasons, status, ended.size()))}
                             .row());
  }
}

Table choices_said(const StudyResults& results) {
  Table table = answers_head();
  const std::vector<std::string> observed = observed_measures(results);
  const std::vector<ChoiceEffects> all = choice_effects(results, observed);
  const report::CaseView view(results);
  say_shares(view, observed, table);
  std::vector<Said> said;
  for (const ChoiceEffects& effects : all)
    for (Said& one : said_of(results, effects)) {
      one.clause = clause(view, one);
      said.push_back(std::move(one));
    }
  // What decides first, by size; then what is open; then what does not matter.
  const auto rank = [](const Said& one) {
    static const std::vector<std::string> order = {"decides",         "depends",  "not resolved",
                                                   "does not matter", "not told", "not observed"};
    return std::find(order.begin(), order.end(), one.verdict) - order.begin();
  };
  std::stable_sort(said.begin(), said.end(), [&](const Said& a, const Said& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.verdict == "decides" && a.median > b.median;
  });
  std::vector<bool> told(said.size(), false);
  for (std::size_t k = 0; k < said.size(); ++k) {
    const Said& one = said[k];
    std::vector<const Said*> same;
    for (std::size_t other = k; other < said.size() && !told[k]; ++other)
      if (said[other].effects->choice == one.effects->choice && said[other].verdict == one.verdict &&
          said[other].depends_on == one.depends_on)
        same.push_back(&said[other]);
    for (const Said* said_here : same) told[static_cast<std::size_t>(said_here - said.data())] = true;
    const Cell line = same.empty() ? Cell() : Cell(sentence_of(same));
    table.rows.push_back(AnswerRow{.choice = one.effects->choice,
                                   .measure = one.effects->measure,
                                   .verdict = one.verdict,
                                   .effect = one.median,
                                   .largest = one.largest,
                                   .scale = one.effects->scale,
                                   .step_open = one.step,
                                   .mesh_open = one.mesh,
                                   .window_open = one.sampling,
                                   .combinations = one.groups.size(),
                                   .depends_on = one.depends_on,
                                   .sentence = line}
                             .row());
  }
  return table;
}

}  // namespace

std::vector<std::string> observed_measures(const StudyResults& results) {
  std::vector<std::string> names;
  if (const auto asked = results.study.find("observe"); asked != results.study.end() && asked->is_array())
    for (const auto& name : *asked) names.push_back(name.get<std::string>());
  const Kind* kind = find_kind(results.kind);
  if (names.empty() && kind && kind->observed) names = kind->observed(results);
  std::erase_if(names, [&](const std::string& name) {
    return std::none_of(results.cases.begin(), results.cases.end(),
                        [&](const CaseRecord& one) { return one.status == "done" && measure(one, name); });
  });
  return names;
}

Table answers_table(const StudyResults& results) {
  const Kind* kind = find_kind(results.kind);
  Table table = kind && kind->answers ? kind->answers(results) : choices_said(results);
  say_ends(report::CaseView(results), table);
  return table;
}

}  // namespace ricochet
