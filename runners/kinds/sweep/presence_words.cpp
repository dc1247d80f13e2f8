#include <fmt/format.h>

#include <algorithm>

#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::dynamics {
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
