#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <ricochet/measure/attractors/diagram.hpp>
#include <string>

namespace ricochet {
namespace {

bool refines(const std::string& axis) {
  return axis == "steps_per_period" || axis == "elements";
}

double size_of(const std::string& level) {
  double size = 0;
  const auto [end, error] = std::from_chars(level.data(), level.data() + level.size(), size);
  return error == std::errc() ? size : 0;
}

/// Whether the finest case of each group of like cases lacks what a coarser one shows.
bool vanishes(const Presence& presence, const std::vector<ChoiceAxis>& axes) {
  struct Finest {
    std::vector<double> size;
    int present = 0;
    bool varied = false, coarser = false;
  };
  std::map<std::vector<std::string>, Finest> groups;
  for (std::size_t k = 0; k < presence.cases.size(); ++k) {
    std::vector<std::string> others;
    std::vector<double> size;
    for (const ChoiceAxis& axis : axes) {
      const std::string& level = axis.levels[presence.cases[k]];
      if (refines(axis.name))
        size.push_back(size_of(level));
      else
        others.push_back(level);
    }
    const auto [found, fresh] = groups.try_emplace(others, Finest{size, presence.present[k], false, false});
    if (fresh) continue;
    Finest& finest = found->second;
    finest.varied = true;
    // Finest: not coarser in any way; of two that are each finer in one, the one with more steps.
    if (size > finest.size) {
      finest.coarser = finest.coarser || finest.present;
      finest.size = size;
      finest.present = presence.present[k];
    } else {
      finest.coarser = finest.coarser || presence.present[k];
    }
  }
  bool coarser = false;
  for (const auto& [others, finest] : groups) {
    if (finest.present || !finest.varied) return false;
    coarser = coarser || finest.coarser;
  }
  return coarser;
}

}  // namespace

PresenceVerdict judge_presence(const Presence& presence, const std::vector<ChoiceAxis>& axes) {
  PresenceVerdict out;
  const std::size_t told = presence.cases.size();
  out.shown = static_cast<std::size_t>(std::count(presence.present.begin(), presence.present.end(), 1));
  if (told < 2) return out;
  if (out.shown == told) {
    out.kind = PresenceKind::common;
    return out;
  }
  std::vector<ChoiceAxis> here;
  for (const ChoiceAxis& axis : axes) {
    ChoiceAxis one{axis.name, {}};
    for (const std::size_t c : presence.cases) one.levels.push_back(axis.levels[c]);
    here.push_back(std::move(one));
  }
  out.choice = deciding_choice(presence.present, here);
  if (vanishes(presence, axes))
    out.kind = PresenceKind::vanishes;
  else
    out.kind = out.choice.share < kNamedShare ? PresenceKind::several_choices : PresenceKind::one_choice;
  return out;
}

namespace {

constexpr double no_viscosity = 1e-12;

Opinion opinion_at(const Diagram& diagram, int value) {
  Opinion out;
  out.value = value;
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    if (!diagram.cases[c].any_decided()) continue;
    std::set<int> attractors;
    const DiagramRun* open = nullptr;
    bool any = false;
    for (int s = 0; s < diagram.start_count(); ++s) {
      const DiagramRun* run = diagram.run(c, value, s);
      if (!run) continue;
      any = true;
      if (run->decided())
        attractors.insert(run->attractor);
      else
        open = run;
    }
    if (!any) continue;
    if (open)
      out.open[c] = open;
    else
      out.decided[c] = std::move(attractors);
  }
  return out;
}

// The axes at some cases.
template <class Cases>
std::vector<ChoiceAxis> axes_at(const std::vector<ChoiceAxis>& axes, const Cases& cases) {
  std::vector<ChoiceAxis> here;
  for (const ChoiceAxis& axis : axes) {
    here.push_back({axis.name, {}});
    for (const std::size_t c : cases) here.back().levels.push_back(axis.levels[c]);
  }
  return here;
}

void judge(Opinion& opinion, const std::vector<ChoiceAxis>& axes, const std::map<int, MotionClass>& classes) {
  std::map<std::set<int>, int> known;
  std::vector<int> labels;
  std::vector<std::size_t> cases;
  for (const auto& [c, attractors] : opinion.decided) {
    cases.push_back(c);
    labels.push_back(known.emplace(attractors, static_cast<int>(known.size())).first->second);
  }
  if (known.size() < 2) {
    opinion.verdict = opinion.open.empty() ? Robustness::robust : Robustness::undecided;
    return;
  }
  std::set<std::vector<std::string>> words;
  for (const auto& [attractors, label] : known) {
    std::vector<std::string> set;
    for (const int attractor : attractors) set.push_back(text(classes.at(attractor)));
    std::sort(set.begin(), set.end());
    words.insert(std::move(set));
  }
  opinion.same_classes = words.size() == 1;
  opinion.verdict = Robustness::depends;
  opinion.choice = deciding_choice(labels, axes_at(axes, cases));
}

// Whether two neighbours belong to one stretch.
bool alike(const Opinion& a, const Opinion& b) {
  return a.verdict == b.verdict && a.one_choice() == b.one_choice() &&
         (!a.one_choice() || a.choice.name == b.choice.name);
}

}  // namespace

bool Opinion::one_choice() const {
  return verdict == Robustness::depends && !(choice.share < kNamedShare);
}

std::map<int, MotionClass> attractor_classes(const Diagram& diagram) {
  std::map<int, MotionClass> out;
  for (const DiagramCase& owner : diagram.cases)
    for (const DiagramRun& run : owner.runs)
      if (run.attractor > 0) out.emplace(run.attractor, run.motion);
  return out;
}

std::vector<Stretch> stretches_of(const Diagram& diagram, const std::vector<ChoiceAxis>& axes) {
  const std::map<int, MotionClass> classes = attractor_classes(diagram);
  std::vector<Opinion> opinions;
  std::size_t most = 0;
  for (int value = 0; value < diagram.value_count(); ++value) {
    opinions.push_back(opinion_at(diagram, value));
    most = std::max(most, opinions.back().decided.size() + opinions.back().open.size());
  }
  std::vector<Stretch> out;
  for (Opinion& opinion : opinions) {
    const std::size_t voices = opinion.decided.size() + opinion.open.size();
    if (voices < 2 || 2 * voices < most) continue;
    judge(opinion, axes, classes);
    if (out.empty() || !alike(out.back().front(), opinion)) out.emplace_back();
    out.back().push_back(std::move(opinion));
  }
  return out;
}

std::vector<std::set<int>> attractor_sets(const Stretch& stretch, const std::set<std::size_t>& cases) {
  std::vector<std::pair<std::set<int>, int>> found;
  for (const Opinion& opinion : stretch)
    for (const auto& [c, attractors] : opinion.decided) {
      if (!cases.count(c)) continue;
      const auto& wanted = attractors;
      auto at = std::find_if(found.begin(), found.end(), [&](const auto& one) { return one.first == wanted; });
      if (at == found.end()) at = found.insert(found.end(), {attractors, 0});
      ++at->second;
    }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::set<int>> out;
  for (auto& [set, count] : found) out.push_back(std::move(set));
  return out;
}

ThickCases thick_cases(
    const Diagram& diagram, const Stretch& stretch, const std::vector<ChoiceAxis>& axes,
    const std::function<std::optional<double>(std::size_t case_index, const DiagramRun&)>& viscosity) {
  ThickCases out;
  for (const Opinion& opinion : stretch)
    for (std::size_t c = 0; c < diagram.cases.size(); ++c)
      for (int s = 0; s < diagram.start_count(); ++s) {
        const DiagramRun* run = diagram.run(c, opinion.value, s);
        if (!run || !run->viscosity) continue;
        out.told.insert(c);
        const double numerical = std::abs(*run->viscosity), physical = viscosity(c, *run).value_or(0);
        if (!(physical > 0 ? numerical > small_viscosity * physical : numerical > no_viscosity)) continue;
        out.thick.insert(c);
        if (numerical < out.largest) continue;
        out.largest = numerical;
        out.physical = physical;
      }
  if (out.thick.empty()) return out;
  std::vector<int> labels;
  for (const std::size_t c : out.told) labels.push_back(static_cast<int>(out.thick.count(c)));
  out.choice = deciding_choice(labels, axes_at(axes, out.told));
  return out;
}

}  // namespace ricochet
