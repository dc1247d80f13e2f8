#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "runners/kinds/sweep/derive_dynamics_parts.hpp"

namespace ricochet::dynamics {
namespace {

constexpr std::size_t kMostLevels = 8;

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

std::string level_name(const std::vector<ChoiceAxis>& axes, const std::vector<std::size_t>& chosen, std::size_t c) {
  std::string out;
  for (const std::size_t a : chosen) {
    const std::string& level = axes[a].levels[c];
    out += (out.empty() ? "" : " with ") + (level.empty() ? "none" : level);
  }
  return out;
}

/// Levels of the chosen axes in the order met: how many cases, how many of them show it.
std::vector<std::pair<std::string, std::pair<int, int>>> counts(const Presence& presence,
                                                                const std::vector<ChoiceAxis>& axes,
                                                                const std::vector<std::size_t>& chosen) {
  std::vector<std::pair<std::string, std::pair<int, int>>> out;
  for (std::size_t k = 0; k < presence.cases.size(); ++k) {
    const std::string name = level_name(axes, chosen, presence.cases[k]);
    auto found = std::find_if(out.begin(), out.end(), [&](const auto& one) { return one.first == name; });
    if (found == out.end()) found = out.insert(out.end(), {name, {0, 0}});
    ++found->second.first;
    found->second.second += presence.present[k];
  }
  return out;
}

}  // namespace

std::string short_number(double value) {
  return fmt::format("{:.6g}", value);
}

std::string percent(double share) {
  return share > 0 && share < 0.095 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

std::string count_of(std::size_t count, const std::string& one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

PresenceLabel label_presence(const Presence& presence, const std::vector<ChoiceAxis>& axes) {
  const std::size_t told = presence.cases.size();
  const auto shown = static_cast<std::size_t>(std::count(presence.present.begin(), presence.present.end(), 1));
  const std::string all = fmt::format("{} of {}", shown, count_of(told, "case"));
  if (told < 2) return {"not compared", all, "is seen by the only case that decides there: nothing to compare."};
  if (shown == told) return {"common to all", all, fmt::format("is common to all {} cases.", told)};
  std::vector<ChoiceAxis> here;
  for (const ChoiceAxis& axis : axes) {
    ChoiceAxis one{axis.name, {}};
    for (const std::size_t c : presence.cases) one.levels.push_back(axis.levels[c]);
    here.push_back(std::move(one));
  }
  const DecidingChoice choice = deciding_choice(presence.present, here);
  std::string levels;
  const auto by_level = counts(presence, axes, choice.axes);
  for (std::size_t k = 0; k < std::min(by_level.size(), kMostLevels); ++k)
    levels += fmt::format("{}{}: {} of {}", k ? ", " : "", by_level[k].first, by_level[k].second.second,
                          by_level[k].second.first);
  if (by_level.size() > kMostLevels) levels += ", …";
  const std::string text = choice.name.empty() ? all : choice.name + " " + levels;
  if (vanishes(presence, axes))
    return {"vanishes under refinement", text,
            fmt::format("vanishes under refinement: {} show it, none of them the finest of its kind ({}).", all, text)};
  if (choice.share < kNamed)
    return {"depends on several choices", text,
            fmt::format("shows in {}, and no one choice tells which (the best of them: {}).", all, text)};
  return {"depends on " + choice.name, text,
          fmt::format("depends on {}, which tells {} of its presence in {}: {}.", choice.name, percent(choice.share),
                      all, levels)};
}

}  // namespace ricochet::dynamics
