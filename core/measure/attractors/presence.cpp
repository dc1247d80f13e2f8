#include <algorithm>
#include <map>
#include <ricochet/measure/attractors/presence.hpp>
#include <stdexcept>
#include <string>

namespace ricochet {
namespace {

bool refines(const std::string& axis) {
  return axis == "steps_per_period" || axis == "elements";
}

double size_of(const std::string& level) {
  try {
    return std::stod(level);
  } catch (const std::exception&) {
    return 0;
  }
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

}  // namespace ricochet
