#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/kinds/sweep/derive_dynamics_parts.hpp"

namespace ricochet::dynamics {
namespace {

constexpr double kSmallViscosity = 0.01, kSpread = 0.8;
constexpr const char* kSeveral = "several choices";
constexpr std::size_t kMostSets = 3, kLevelsNamed = 6;

/// What the cases say at one value.
struct Opinion {
  int value = 0;
  std::string verdict, choice;
  double share = 0, second = 0;
  std::vector<std::size_t> axes;                 ///< of the choice
  std::map<std::size_t, std::set<int>> decided;  ///< case → attractors
  std::map<std::size_t, std::string> open;       ///< case → "undecided", "diverged", …
  bool same_classes = true;
};

/// Neighbouring values of one verdict.
struct Stretch {
  std::vector<Opinion> opinions;
  const Opinion& front() const { return opinions.front(); }
};

/// Half way between two values, without the digits of round-off.
double rounded(double value) {
  return std::stod(fmt::format("{:.12g}", value));
}

/// A case that failed at every value says nothing of any of them.
bool counts(const CaseRuns& owner) {
  return owner.any_decided;
}

Opinion opinion_at(const Diagram& diagram, int value) {
  Opinion out;
  out.value = value;
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    if (!counts(diagram.cases[c])) continue;
    std::set<int> attractors;
    std::string open;
    bool any = false;
    for (int s = 0; s < static_cast<int>(diagram.starts.size()); ++s) {
      const Run* run = diagram.run(c, value, s);
      if (!run) continue;
      any = true;
      if (run->decided())
        attractors.insert(run->attractor);
      else
        open = run->status == "done" ? text(run->motion) : run->status;
    }
    if (!any) continue;
    if (open.empty())
      out.decided[c] = std::move(attractors);
    else
      out.open[c] = open;
  }
  return out;
}

std::map<int, std::string> names_of(const Diagram& diagram) {
  std::map<int, std::string> out;
  for (const CaseRuns& owner : diagram.cases)
    for (const Run& run : owner.runs)
      if (run.attractor > 0) out.emplace(run.attractor, text(run.motion));
  return out;
}

class Verdicts {
 public:
  explicit Verdicts(const Diagram& diagram) : diagram_(diagram), names_(names_of(diagram)) {}

  DerivedTable table() const {
    DerivedTable out{"verdicts", {"from", "to", "verdict", "choice", "sentence"}, {}};
    const std::vector<Stretch> stretches = merged();
    for (std::size_t k = 0; k < stretches.size(); ++k) {
      const double first = value(stretches[k].opinions.front()), last = value(stretches[k].opinions.back());
      const double from = k == 0 ? first : (value(stretches[k - 1].opinions.back()) + first) / 2;
      const double to = k + 1 == stretches.size() ? last : (last + value(stretches[k + 1].opinions.front())) / 2;
      out.rows.push_back({rounded(from), rounded(to), stretches[k].front().verdict, stretches[k].front().choice,
                          sentence(stretches[k]) + (k == 0 ? left_out() : "")});
    }
    return out;
  }

 private:
  double value(const Opinion& opinion) const { return diagram_.values[static_cast<std::size_t>(opinion.value)]; }

  /// Values that two cases or more speak of, and half of those that any value has: a change that one case refined is no
  /// place to compare.
  std::vector<Stretch> merged() const {
    std::vector<Stretch> out;
    std::vector<Opinion> opinions;
    std::size_t most = 0;
    for (int value = 0; value < static_cast<int>(diagram_.values.size()); ++value) {
      opinions.push_back(opinion_at(diagram_, value));
      most = std::max(most, opinions.back().decided.size() + opinions.back().open.size());
    }
    for (Opinion& opinion : opinions) {
      const std::size_t voices = opinion.decided.size() + opinion.open.size();
      if (voices < 2 || 2 * voices < most) continue;
      judge(opinion);
      if (out.empty() || out.back().front().verdict != opinion.verdict || out.back().front().choice != opinion.choice)
        out.emplace_back();
      out.back().opinions.push_back(std::move(opinion));
    }
    return out;
  }

  void judge(Opinion& opinion) const {
    std::map<std::set<int>, int> known;
    std::vector<int> labels;
    std::vector<ChoiceAxis> axes;
    for (const auto& [c, attractors] : opinion.decided)
      labels.push_back(known.emplace(attractors, static_cast<int>(known.size())).first->second);
    if (known.size() < 2) {
      opinion.verdict = opinion.open.empty() ? "robust" : "undecided";
      return;
    }
    std::set<std::string> classes;
    for (const auto& [attractors, label] : known) classes.insert(set_name(attractors, false));
    opinion.same_classes = classes.size() == 1;
    for (const ChoiceAxis& axis : diagram_.axes) {
      axes.push_back({axis.name, {}});
      for (const auto& [c, attractors] : opinion.decided) axes.back().levels.push_back(axis.levels[c]);
    }
    const DecidingChoice choice = deciding_choice(labels, axes);
    opinion.verdict = "depends";
    opinion.choice = choice.share < kNamed ? kSeveral : choice.name;
    opinion.share = choice.share;
    opinion.second = choice.second;
    if (choice.share >= kNamed) opinion.axes = choice.axes;
  }

  /// "periodic 1 (attractor 3) and chaotic (attractor 5)".
  std::string set_name(const std::set<int>& attractors, bool numbered = true) const {
    std::vector<std::string> words;
    for (const int attractor : attractors)
      words.push_back(names_.at(attractor) + (numbered ? fmt::format(" (attractor {})", attractor) : ""));
    std::sort(words.begin(), words.end());
    std::string out;
    for (std::size_t k = 0; k < words.size(); ++k)
      out += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
    return out;
  }

  std::string place(const Stretch& stretch) const {
    const double first = value(stretch.opinions.front()), last = value(stretch.opinions.back());
    if (stretch.opinions.size() == 1) return fmt::format("At {} {}", parameter(), short_number(first));
    return fmt::format("For {} {} to {} ({})", parameter(), short_number(first), short_number(last),
                       count_of(stretch.opinions.size(), "value"));
  }
  std::string parameter() const { return diagram_.parameter.empty() ? "the parameter" : diagram_.parameter; }

  /// The sets of attractors of the given cases, most frequent first.
  std::string sets(const Stretch& stretch, const std::set<std::size_t>& cases) const {
    std::vector<std::pair<std::set<int>, int>> found;
    for (const Opinion& opinion : stretch.opinions)
      for (const auto& [c, attractors] : opinion.decided) {
        if (!cases.count(c)) continue;
        const auto& wanted = attractors;
        auto at = std::find_if(found.begin(), found.end(), [&](const auto& one) { return one.first == wanted; });
        if (at == found.end()) at = found.insert(found.end(), {attractors, 0});
        ++at->second;
      }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    std::string out;
    for (std::size_t k = 0; k < std::min(found.size(), kMostSets); ++k)
      out += (k == 0 ? "" : " or ") + set_name(found[k].first);
    if (found.size() > kMostSets) out += fmt::format(" or {} more", found.size() - kMostSets);
    return out;
  }

  std::set<std::size_t> decided(const Stretch& stretch) const {
    std::set<std::size_t> out;
    for (const Opinion& opinion : stretch.opinions)
      for (const auto& [c, attractors] : opinion.decided) out.insert(c);
    return out;
  }

  std::string level(std::size_t c, const std::vector<std::size_t>& axes) const {
    std::string out;
    for (const std::size_t a : axes) {
      const std::string& name = diagram_.axes[a].levels[c];
      out += (out.empty() ? "" : " with ") + (name.empty() ? "none" : name);
    }
    return out;
  }

  /// "; 2 cases are open: 3 undecided, 1 diverged".
  std::string open(const Stretch& stretch) const {
    std::map<std::string, int> causes;
    std::set<std::size_t> cases;
    for (const Opinion& opinion : stretch.opinions)
      for (const auto& [c, cause] : opinion.open) {
        ++causes[cause];
        cases.insert(c);
      }
    if (cases.empty()) return "";
    std::string out;
    for (const auto& [cause, count] : causes) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, cause);
    return fmt::format(" {} left open ({}).", count_of(cases.size(), "case"), out);
  }

  /// The cases whose numerical viscosity is not small against α, and which choice they share.
  std::string viscosity(const Stretch& stretch) const {
    double largest = 0, share = 0, physical = 0;
    std::set<std::size_t> told, thick;
    for (const Opinion& opinion : stretch.opinions)
      for (std::size_t c = 0; c < diagram_.cases.size(); ++c)
        for (int s = 0; s < static_cast<int>(diagram_.starts.size()); ++s) {
          const Run* run = diagram_.run(c, opinion.value, s);
          if (!run || !run->viscosity) continue;
          told.insert(c);
          const double numerical = std::abs(*run->viscosity);
          const double alpha = viscosity_of(diagram_, diagram_.cases[c], *run).value_or(0);
          // Without a viscosity of its own the beam takes any: 1e-12 s is what round-off leaves of none.
          if (!(alpha > 0 ? numerical > kSmallViscosity * alpha : numerical > 1e-12)) continue;
          thick.insert(c);
          if (numerical < largest) continue;
          largest = numerical;
          physical = alpha;
          share = alpha > 0 ? numerical / alpha : 0;
        }
    if (thick.empty()) return "";
    std::vector<int> labels;
    std::vector<ChoiceAxis> axes;
    for (const std::size_t c : told) labels.push_back(static_cast<int>(thick.count(c)));
    for (const ChoiceAxis& axis : diagram_.axes) {
      axes.push_back({axis.name, {}});
      for (const std::size_t c : told) axes.back().levels.push_back(axis.levels[c]);
    }
    const DecidingChoice choice = deciding_choice(labels, axes);
    std::string who = fmt::format("{} of {}", thick.size(), count_of(told.size(), "case"));
    if (!choice.name.empty() && choice.share > kSpread) {
      std::set<std::string> levels;
      for (const std::size_t c : thick) levels.insert(level(c, choice.axes));
      std::string list;
      for (const std::string& name : levels) list += (list.empty() ? "" : ", ") + name;
      if (levels.size() <= kLevelsNamed) who += fmt::format(", {} {}", choice.name, list);
    }
    if (physical > 0)
      return fmt::format(" Numerical viscosity is not small against alpha in {}: up to {:.2g} s, {} of alpha.", who,
                         largest, percent(share));
    return fmt::format(" Numerical viscosity stands alone (alpha is 0) in {}: up to {:.2g} s.", who, largest);
  }

  std::string sentence(const Stretch& stretch) const {
    const std::set<std::size_t> cases = decided(stretch);
    const std::string where = place(stretch);
    if (stretch.front().verdict == "robust")
      return fmt::format("{} all {} agree: {}.{}", where, count_of(cases.size(), "case"), sets(stretch, cases),
                         viscosity(stretch));
    if (stretch.front().verdict == "undecided") {
      const std::string agree = cases.empty() ? ""
                                              : fmt::format(" The {} that decide agree: {}.",
                                                            count_of(cases.size(), "case"), sets(stretch, cases));
      return fmt::format("{} the comparison stays open.{}{}{}", where, open(stretch), agree, viscosity(stretch));
    }
    double share = 0, second = 0;
    bool same_classes = true;
    for (const Opinion& opinion : stretch.opinions) {
      share += opinion.share / static_cast<double>(stretch.opinions.size());
      second += opinion.second / static_cast<double>(stretch.opinions.size());
      same_classes = same_classes && opinion.same_classes;
    }
    std::string out;
    if (stretch.front().axes.empty()) {
      out = fmt::format("{} {} differ, and no one choice tells half of it: {}.", where, count_of(cases.size(), "case"),
                        sets(stretch, cases));
    } else {
      std::vector<std::pair<std::string, std::set<std::size_t>>> levels;
      for (const std::size_t c : cases) {
        const std::string name = level(c, stretch.front().axes);
        auto found = std::find_if(levels.begin(), levels.end(), [&](const auto& one) { return one.first == name; });
        if (found == levels.end()) found = levels.insert(levels.end(), {name, {}});
        found->second.insert(c);
      }
      std::string list;
      for (std::size_t k = 0; k < std::min(levels.size(), kLevelsNamed); ++k)
        list += fmt::format("{}{} gives {}", k ? "; " : "", levels[k].first, sets(stretch, levels[k].second));
      if (levels.size() > kLevelsNamed) list += fmt::format("; {} more levels", levels.size() - kLevelsNamed);
      out = fmt::format("{} {} decides, with {} of the differences between {}: {}.", where, stretch.front().choice,
                        percent(share), count_of(cases.size(), "case"), list);
      if (second > kSpread * share)
        out += fmt::format(" Another choice tells {} of them: the two cannot be held apart here.", percent(second));
    }
    if (same_classes) out += " The classes agree; the orbits differ.";
    return out + open(stretch) + viscosity(stretch);
  }

  std::string left_out() const {
    const auto count = static_cast<std::size_t>(std::count_if(diagram_.cases.begin(), diagram_.cases.end(),
                                                              [](const CaseRuns& owner) { return !counts(owner); }));
    return count == 0
               ? ""
               : fmt::format(" Not counted, here and below: {} without any decided value.", count_of(count, "case"));
  }

  const Diagram& diagram_;
  std::map<int, std::string> names_;
};

}  // namespace

DerivedTable verdicts_table(const Diagram& diagram) {
  return Verdicts(diagram).table();
}

}  // namespace ricochet::dynamics
