#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ricochet/measure/attractors/diagram.hpp>
#include <set>

#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/text.hpp"

namespace ricochet::dynamics {
namespace {

constexpr double kSpread = 0.8;
constexpr const char* kSeveral = "several choices";
constexpr std::size_t kMostSets = 3, kLevelsNamed = 6;

/// Half way between two values, without the digits of round-off.
double rounded(double value) {
  return to_digits(value, 12);
}

const char* word(Robustness verdict) {
  return verdict == Robustness::robust ? "robust" : verdict == Robustness::depends ? "depends" : "undecided";
}

class Verdicts {
 public:
  explicit Verdicts(const StudyDiagram& study)
      : study_(study), diagram_(study.diagram), classes_(attractor_classes(study.diagram)) {}

  Table table() const {
    std::vector<VerdictRow> rows;
    const std::vector<Stretch> stretches = stretches_of(diagram_, study_.axes);
    for (std::size_t k = 0; k < stretches.size(); ++k) {
      const double first = value(stretches[k].front()), last = value(stretches[k].back());
      const double from = k == 0 ? first : (value(stretches[k - 1].back()) + first) / 2;
      const double to = k + 1 == stretches.size() ? last : (last + value(stretches[k + 1].front())) / 2;
      const Opinion& opinion = stretches[k].front();
      rows.push_back({rounded(from), rounded(to), word(opinion.verdict), choice_name(opinion),
                      sentence(stretches[k]) + (k == 0 ? left_out() : "")});
    }
    return verdicts_type(study_.swept).with(rows);
  }

 private:
  double value(const Opinion& opinion) const { return diagram_.values[static_cast<std::size_t>(opinion.value)]; }

  static std::string choice_name(const Opinion& opinion) {
    return opinion.verdict != Robustness::depends ? "" : opinion.one_choice() ? opinion.choice.name : kSeveral;
  }

  /// "periodic 1 (attractor 3) and chaotic (attractor 5)".
  std::string set_name(const std::set<int>& attractors) const {
    std::vector<std::string> words;
    for (const int attractor : attractors)
      words.push_back(fmt::format("{} (attractor {})", text(classes_.at(attractor)), attractor));
    std::sort(words.begin(), words.end());
    std::string out;
    for (std::size_t k = 0; k < words.size(); ++k)
      out += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
    return out;
  }

  std::string place(const Stretch& stretch) const {
    const double first = value(stretch.front()), last = value(stretch.back());
    if (stretch.size() == 1) return fmt::format("At {} {}", parameter(), six_digits(first));
    return fmt::format("For {} {} to {} ({})", parameter(), six_digits(first), six_digits(last),
                       count_of(stretch.size(), "value"));
  }
  std::string parameter() const { return study_.parameter.empty() ? "the parameter" : study_.parameter; }

  /// The sets of attractors of the given cases, most frequent first.
  std::string sets(const Stretch& stretch, const std::set<std::size_t>& cases) const {
    const std::vector<std::set<int>> found = attractor_sets(stretch, cases);
    std::string out;
    for (std::size_t k = 0; k < std::min(found.size(), kMostSets); ++k)
      out += (k == 0 ? "" : " or ") + set_name(found[k]);
    if (found.size() > kMostSets) out += fmt::format(" or {} more", found.size() - kMostSets);
    return out;
  }

  /// What cases that agree show: one set of attractors, or the classes with how many values have them.
  std::string motions(const Stretch& stretch, const std::set<std::size_t>& cases) const {
    if (attractor_sets(stretch, cases).size() < 2) return sets(stretch, cases);
    std::vector<std::pair<std::string, std::size_t>> found;
    for (const Opinion& opinion : stretch) {
      if (opinion.decided.empty()) continue;
      std::set<std::string> words;
      for (const int attractor : opinion.decided.begin()->second) words.insert(text(classes_.at(attractor)));
      std::string name;
      for (const std::string& word : words) name += (name.empty() ? "" : " and ") + word;
      ++in_order_met(found, name);
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    std::string out;
    for (const auto& [name, count] : found)
      out += fmt::format("{}{} at {}", out.empty() ? "" : ", ", name,
                         out.empty() ? count_of(count, "value") : std::to_string(count));
    return out;
  }

  std::set<std::size_t> decided(const Stretch& stretch) const {
    std::set<std::size_t> out;
    for (const Opinion& opinion : stretch)
      for (const auto& [c, attractors] : opinion.decided) out.insert(c);
    return out;
  }

  /// "; 2 cases are open: 3 undecided, 1 diverged".
  std::string open(const Stretch& stretch) const {
    std::map<std::string, int> causes;
    std::set<std::size_t> cases;
    for (const Opinion& opinion : stretch)
      for (const auto& [c, run] : opinion.open) {
        ++causes[run->settled ? text(run->motion) : run->status];
        cases.insert(c);
      }
    if (cases.empty()) return "";
    std::string out;
    for (const auto& [cause, count] : causes) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, cause);
    return fmt::format(" {} left open ({}).", count_of(cases.size(), "case"), out);
  }

  /// The cases whose numerical viscosity is not small against α, and which choice they share.
  std::string viscosity(const Stretch& stretch) const {
    const ThickCases found = thick_cases(diagram_, stretch, study_.axes, [&](std::size_t c, const DiagramRun& run) {
      return viscosity_of(*study_.results, study_.record(c), run.parameter);
    });
    if (found.thick.empty()) return "";
    const DecidingChoice& choice = found.choice;
    std::string who = fmt::format("{} of {}", found.thick.size(), count_of(found.told.size(), "case"));
    if (!choice.name.empty() && choice.share > kSpread) {
      std::set<std::string> levels;
      for (const std::size_t c : found.thick) levels.insert(level_name(study_.axes, choice.axes, c));
      std::string list;
      for (const std::string& name : levels) list += (list.empty() ? "" : ", ") + name;
      if (levels.size() <= kLevelsNamed) who += fmt::format(", {} {}", choice.name, list);
    }
    if (found.physical > 0)
      return fmt::format(" Numerical viscosity is not small against alpha in {}: up to {:.2g} s, {} of alpha.", who,
                         found.largest, percent(found.largest / found.physical));
    return fmt::format(" Numerical viscosity stands alone (alpha is 0) in {}: up to {:.2g} s.", who, found.largest);
  }

  std::string sentence(const Stretch& stretch) const {
    const std::set<std::size_t> cases = decided(stretch);
    const std::string where = place(stretch);
    if (stretch.front().verdict == Robustness::robust)
      return fmt::format("{} all {} agree: {}.{}", where, count_of(cases.size(), "case"), motions(stretch, cases),
                         viscosity(stretch));
    if (stretch.front().verdict == Robustness::undecided) {
      const std::string agree = cases.empty() ? ""
                                              : fmt::format(" The {} that decide agree: {}.",
                                                            count_of(cases.size(), "case"), motions(stretch, cases));
      return fmt::format("{} the comparison stays open.{}{}{}", where, open(stretch), agree, viscosity(stretch));
    }
    double share = 0, second = 0;
    bool same_classes = true;
    for (const Opinion& opinion : stretch) {
      share += opinion.choice.share / static_cast<double>(stretch.size());
      second += opinion.choice.second / static_cast<double>(stretch.size());
      same_classes = same_classes && opinion.same_classes;
    }
    std::string out;
    if (!stretch.front().one_choice()) {
      out = fmt::format("{} {} differ, and no one choice tells half of it: {}.", where, count_of(cases.size(), "case"),
                        sets(stretch, cases));
    } else {
      std::vector<std::pair<std::string, std::set<std::size_t>>> levels;
      for (const std::size_t c : cases)
        in_order_met(levels, level_name(study_.axes, stretch.front().choice.axes, c)).insert(c);
      std::string list;
      for (std::size_t k = 0; k < std::min(levels.size(), kLevelsNamed); ++k)
        list += fmt::format("{}{} gives {}", k ? "; " : "", levels[k].first, sets(stretch, levels[k].second));
      if (levels.size() > kLevelsNamed) list += fmt::format("; {} more levels", levels.size() - kLevelsNamed);
      out = fmt::format("{} {} decides, with {} of the differences between {}: {}.", where,
                        spoken_choice(choice_name(stretch.front())), percent(share), count_of(cases.size(), "case"),
                        list);
      if (second > kSpread * share)
        out += fmt::format(" Another choice tells {} of them: the two cannot be held apart here.", percent(second));
    }
    if (same_classes) out += " The classes agree; the orbits differ.";
    return out + open(stretch) + viscosity(stretch);
  }

  std::string left_out() const {
    const auto count = static_cast<std::size_t>(std::count_if(
        diagram_.cases.begin(), diagram_.cases.end(), [](const DiagramCase& owner) { return !owner.any_decided(); }));
    return count == 0
               ? ""
               : fmt::format(" Not counted, here and below: {} without any decided value.", count_of(count, "case"));
  }

  const StudyDiagram& study_;
  const Diagram& diagram_;
  std::map<int, MotionClass> classes_;
};

}  // namespace

Table verdicts_table(const StudyDiagram& study) {
  return Verdicts(study).table();
}

namespace {

constexpr std::size_t kMostLevels = 8;

/// Levels of the chosen axes in the order met: how many cases, how many of them show it.
std::vector<std::pair<std::string, std::pair<int, int>>> counts(const Presence& presence,
                                                                const std::vector<ChoiceAxis>& axes,
                                                                const std::vector<std::size_t>& chosen) {
  std::vector<std::pair<std::string, std::pair<int, int>>> out;
  for (std::size_t k = 0; k < presence.cases.size(); ++k) {
    auto& [cases, shown] = in_order_met(out, level_name(axes, chosen, presence.cases[k]));
    ++cases;
    shown += presence.present[k];
  }
  return out;
}

}  // namespace

std::string level_name(const std::vector<ChoiceAxis>& axes, const std::vector<std::size_t>& chosen, std::size_t c) {
  std::string out;
  for (const std::size_t a : chosen) {
    const std::string& level = axes[a].levels[c];
    out += (out.empty() ? "" : " with ") + (level.empty() ? "none" : level);
  }
  return out;
}

std::string six_digits(double value) {
  return fmt::format("{:.6g}", value);
}

std::string percent(double share) {
  return share > 0 && share < 0.095 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

std::string count_of(std::size_t count, const std::string& one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

PresenceLabel label_presence(const Presence& presence, const std::vector<ChoiceAxis>& axes) {
  const PresenceVerdict verdict = judge_presence(presence, axes);
  const DecidingChoice& choice = verdict.choice;
  const std::size_t told = presence.cases.size();
  const std::string all = fmt::format("{} of {}", verdict.shown, count_of(told, "case"));
  if (verdict.kind == PresenceKind::not_compared)
    return {"not compared", all, "is seen by the only case that decides there: nothing to compare."};
  if (verdict.kind == PresenceKind::common)
    return {"common to all", all, fmt::format("is common to all {} cases.", told)};
  std::string levels;
  const auto by_level = counts(presence, axes, choice.axes);
  for (std::size_t k = 0; k < std::min(by_level.size(), kMostLevels); ++k)
    levels += fmt::format("{}{}: {} of {}", k ? ", " : "", by_level[k].first, by_level[k].second.second,
                          by_level[k].second.first);
  if (by_level.size() > kMostLevels) levels += ", …";
  const std::string text = choice.name.empty() ? all : choice.name + " " + levels;
  if (verdict.kind == PresenceKind::vanishes)
    return {"vanishes under refinement", text,
            fmt::format("vanishes under refinement: {} show it, none of them the finest of its kind ({}).", all, text)};
  if (verdict.kind == PresenceKind::several_choices)
    return {"depends on several choices", text,
            fmt::format("shows in {}, and no one choice tells which (the best of them: {}).", all, text)};
  return {"depends on " + choice.name, text,
          fmt::format("depends on {}, which tells {} of its presence in {}: {}.", choice.name, percent(choice.share),
                      all, levels)};
}

}  // namespace ricochet::dynamics
