#include <fmt/format.h>

#include <algorithm>
#include <ricochet/measure/statistics/choices.hpp>
#include <set>

#include "runners/answers/set_names.hpp"
#include "runners/study/axis_meaning.hpp"

// The searches behind a name: unions of rules, whole levels, the nearest rule, counts.
namespace ricochet::answers {
namespace {

bool names_a_method(const std::string& column) {
  return column == "mass" || column == "contact" || column == "time";
}

}  // namespace

std::optional<std::string> SetNames::cover(const Picked& chosen, std::size_t count) const {
  struct Part {
    std::vector<std::size_t> attributes;
    std::vector<std::string> levels;
    Members members;
  };
  std::vector<Part> parts;
  const auto consider = [&](Part part) {
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      bool in = true;
      for (std::size_t k = 0; k < part.attributes.size(); ++k)
        in = in && attributes_[part.attributes[k]].levels[m] == part.levels[k];
      if (!in) continue;
      if (!chosen[m]) return;
      part.members.push_back(m);
    }
    if (!part.members.empty()) parts.push_back(std::move(part));
  };
  for (std::size_t a = 0; a < attributes_.size(); ++a)
    for (const std::string& level : attributes_[a].all) {
      if (level.empty()) continue;
      consider({{a}, {level}, {}});
      for (std::size_t b = a + 1; b < attributes_.size(); ++b) {
        if (axis_role(attributes_[a].column) == axis_role(attributes_[b].column)) continue;
        for (const std::string& other : attributes_[b].all)
          if (!other.empty()) consider({{a, b}, {level, other}, {}});
      }
    }
  Picked left = chosen;
  std::size_t remaining = count;
  std::vector<const Part*> taken;
  constexpr std::size_t most_parts = 24, most_rules = 3;
  while (remaining > 0) {
    const Part* best = nullptr;
    std::size_t gain = 0;
    for (const Part& part : parts) {
      const auto new_ones = static_cast<std::size_t>(
          std::count_if(part.members.begin(), part.members.end(), [&](std::size_t m) { return left[m] != 0; }));
      if (new_ones > gain || (new_ones == gain && best && gain > 0 && part.attributes.size() < best->attributes.size()))
        best = &part, gain = new_ones;
    }
    if (!best || gain == 0 || taken.size() == most_parts) return std::nullopt;
    taken.push_back(best);
    for (const std::size_t m : best->members) {
      remaining -= left[m] != 0 ? 1 : 0;
      left[m] = 0;
    }
  }
  // Rules that differ in one level alone are said together.
  struct Merged {
    std::vector<std::size_t> attributes;
    std::size_t open;   // the attribute whose levels are listed
    std::string fixed;  // the level of the other
    std::vector<std::string> levels;
  };
  std::vector<Merged> merged;
  for (const Part* part : taken) {
    bool joined = false;
    for (Merged& one : merged) {
      if (one.attributes != part->attributes) continue;
      const std::size_t fixed = 1 - one.open;
      if (part->attributes.size() == 2 && part->levels[fixed] != one.fixed) continue;
      one.levels.push_back(part->levels[part->attributes.size() == 1 ? 0 : one.open]);
      joined = true;
      break;
    }
    if (joined) continue;
    if (part->attributes.size() == 1)
      merged.push_back({part->attributes, 0, "", {part->levels[0]}});
    else
      merged.push_back({part->attributes, 0, part->levels[1], {part->levels[0]}});
  }
  if (merged.size() > most_rules) return std::nullopt;
  std::vector<std::string> said;
  for (const Merged& one : merged) {
    constexpr std::size_t most_levels = 5;
    if (one.levels.size() > most_levels && !end_of_number(attributes_[one.attributes[one.open]], one.levels))
      return std::nullopt;
    const auto open = words(attributes_[one.attributes[one.open]], one.levels);
    if (!open) return std::nullopt;
    std::string text = *open;
    if (one.attributes.size() == 2) {
      const auto fixed = words(attributes_[one.attributes[1]], {one.fixed});
      if (!fixed) return std::nullopt;
      text += " with " + *fixed;
    }
    said.push_back(std::move(text));
  }
  return and_names(said);
}

std::optional<std::string> SetNames::whole_levels(const Picked& chosen, std::size_t count) const {
  const Attribute* widest = nullptr;
  for (const Attribute& attribute : attributes_)
    if (names_a_method(attribute.column) && (!widest || attribute.all.size() > widest->all.size())) widest = &attribute;
  constexpr std::size_t many = 6, listed = 7;
  if (!widest || widest->all.size() < many) return std::nullopt;
  std::vector<std::string> full;
  std::size_t inside = 0;
  for (const std::string& level : widest->all) {
    std::size_t members = 0, in = 0;
    for (std::size_t m = 0; m < methods_.size(); ++m)
      if (widest->levels[m] == level) ++members, in += chosen[m] != 0 ? 1 : 0;
    if (in == members) full.push_back(widest->whole ? level : study_.value_words(widest->column, level)), inside += in;
  }
  constexpr double most_of_them = 0.6;
  if (full.empty() || static_cast<double>(inside) < most_of_them * static_cast<double>(count)) return std::nullopt;
  const std::size_t more = full.size() > listed ? full.size() - listed : 0;
  full.resize(std::min(full.size(), listed));
  std::string text = more > 0 ? fmt::format("{} and {} more", fmt::join(full, ", "), more) : and_list(full);
  if (count > inside)
    text += fmt::format("; besides {} other combination{}", count - inside, count - inside == 1 ? "" : "s");
  return text;
}

std::optional<std::string> SetNames::nearest(const Picked& chosen, std::size_t count, double least_worth) const {
  std::optional<std::pair<double, std::string>> best;
  constexpr double enough_hit = 0.6, pure = 0.8, per_part = 0.01;
  const auto consider = [&](const std::vector<std::size_t>& parts, const std::vector<std::string>& levels) {
    std::size_t got = 0, hit = 0;
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      bool in = true;
      for (std::size_t k = 0; k < parts.size(); ++k) in = in && attributes_[parts[k]].levels[m] == levels[k];
      if (!in) continue;
      ++got;
      hit += chosen[m] != 0 ? 1 : 0;
    }
    const double h = static_cast<double>(hit), c = static_cast<double>(count), g = static_cast<double>(got);
    if (h < enough_hit * c || h < pure * g) return;
    const double worth = 2 * h / (g + c) - per_part * static_cast<double>(parts.size());
    if (worth < least_worth || (best && worth <= best->first)) return;
    std::string text;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const auto said = words(attributes_[parts[k]], {levels[k]});
      if (!said) return;
      text += (k == 0 ? "" : " with ") + *said;
    }
    text += fmt::format(" ({} of {}", hit, got);
    if (count > hit) text += fmt::format(", and {} others", count - hit);
    best = {worth, text + ")"};
  };
  for (std::size_t a = 0; a < attributes_.size(); ++a)
    for (const std::string& level : attributes_[a].all) {
      if (level.empty()) continue;
      consider({a}, {level});
      for (std::size_t b = a + 1; b < attributes_.size(); ++b)
        for (const std::string& other : attributes_[b].all)
          if (!other.empty()) consider({a, b}, {level, other});
    }
  return best ? std::optional("mostly " + best->second) : std::nullopt;
}

std::optional<std::string> SetNames::by_levels(const Picked& chosen) const {
  const Attribute* best = nullptr;
  double most = 0;
  const std::vector<int> labels(chosen.begin(), chosen.end());
  constexpr std::size_t few_levels = 4;
  std::vector<std::pair<std::string, std::pair<std::size_t, std::size_t>>> counts;
  for (const Attribute& attribute : attributes_) {
    const double share = explained_share(labels, attribute.levels);
    std::vector<std::pair<std::string, std::pair<std::size_t, std::size_t>>> own;
    for (const std::string& level : attribute.all) {
      std::size_t in = 0, all = 0;
      for (std::size_t m = 0; m < methods_.size(); ++m)
        if (attribute.levels[m] == level) ++all, in += chosen[m] != 0 ? 1 : 0;
      if (in > 0) own.push_back({level, {in, all}});
    }
    if (share <= most || own.size() > few_levels || own.size() < 2 || !words(attribute, {own.front().first})) continue;
    best = &attribute;
    most = share;
    counts = std::move(own);
  }
  if (!best) return std::nullopt;
  std::string out;
  for (const auto& [level, count] : counts) {
    const auto said = words(*best, {level});
    if (!said) return std::nullopt;
    out += fmt::format("{}{} of {} with {}", out.empty() ? "" : ", ", count.first, count.second, *said);
  }
  return out;
}

std::string SetNames::common(const Picked& chosen, std::size_t count) const {
  std::vector<std::string> shared;
  std::string told;  // a choice whose level says its parameters
  for (const Attribute& attribute : attributes_) {
    std::set<std::string> met;
    for (std::size_t m = 0; m < methods_.size(); ++m)
      if (chosen[m]) met.insert(attribute.levels[m]);
    if (met.size() != 1 || met.begin()->empty() || axis_role(attribute.column) == told) continue;
    if (attribute.whole) told = attribute.column;
    if (const auto text = words(attribute, {*met.begin()})) shared.push_back(*text);
  }
  const std::string text = fmt::format("{} of {} methods", count, methods_.size());
  return shared.empty() ? text : fmt::format("{}, all with {}", text, and_list(shared));
}

}  // namespace ricochet::answers
