#include <fmt/format.h>

#include <algorithm>
#include <ricochet/measure/statistics/choices.hpp>
#include <set>

#include "runners/answers/set_names.hpp"
#include "runners/study/axis_meaning.hpp"

// The searches behind a name: unions of rules, whole levels, the nearest rule, counts.
namespace ricochet::answers {
namespace {

constexpr std::size_t most_named = 500;

bool names_a_method(const std::string& column) {
  return is_method_role(column);
}

}  // namespace

bool SetNames::has(const Rule& rule, std::size_t method) const {
  for (std::size_t k = 0; k < rule.attributes.size(); ++k)
    if (attributes_[rule.attributes[k]].levels[method] != rule.levels[k]) return false;
  return true;
}

std::vector<SetNames::Rule> SetNames::rules_within(const Picked& chosen) const {
  std::vector<Rule> rules;
  const auto consider = [&](Rule part) {
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      if (!has(part, m)) continue;
      if (!chosen[m]) return;
      part.members.push_back(m);
    }
    if (!part.members.empty()) rules.push_back(std::move(part));
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
  return rules;
}

namespace {

/// Rules whose union is the set, each the one that adds most; none where that takes too many.
template <class Rule>
std::optional<std::vector<const Rule*>> union_of(const std::vector<Rule>& rules, std::vector<char> left,
                                                 std::size_t remaining) {
  std::vector<const Rule*> taken;
  constexpr std::size_t most_rules = 24;
  while (remaining > 0) {
    const Rule* best = nullptr;
    std::size_t gain = 0;
    for (const Rule& part : rules) {
      const auto new_ones = static_cast<std::size_t>(
          std::count_if(part.members.begin(), part.members.end(), [&](std::size_t m) { return left[m] != 0; }));
      if (new_ones > gain || (new_ones == gain && best && gain > 0 && part.attributes.size() < best->attributes.size()))
        best = &part, gain = new_ones;
    }
    if (!best || gain == 0 || taken.size() == most_rules) return std::nullopt;
    taken.push_back(best);
    for (const std::size_t m : best->members) {
      remaining -= left[m] != 0 ? 1 : 0;
      left[m] = 0;
    }
  }
  return taken;
}

struct Merged {
  std::vector<std::size_t> attributes;
  std::vector<std::vector<std::string>> levels;  // of each; of two attributes one has a single level
};

/// Rules that differ in one level alone are said together.
template <class Rule>
std::vector<Merged> merged_rules(const std::vector<const Rule*>& rules) {
  std::vector<Merged> merged;
  for (const Rule* part : rules) {
    bool joined = false;
    for (Merged& one : merged) {
      if (one.attributes != part->attributes) continue;
      const std::size_t sides = part->attributes.size();
      for (std::size_t open = 0; open < sides && !joined; ++open) {
        if (sides == 2 && one.levels[1 - open] != std::vector{part->levels[1 - open]}) continue;
        one.levels[open].push_back(part->levels[open]);
        joined = true;
      }
      if (joined) break;
    }
    if (joined) continue;
    Merged& one = merged.emplace_back(Merged{part->attributes, {}});
    for (const std::string& level : part->levels) one.levels.push_back({level});
  }
  return merged;
}

}  // namespace

std::optional<std::string> SetNames::cover(const Picked& chosen, std::size_t count, std::size_t most_rules) const {
  const std::vector<Rule> rules = rules_within(chosen);
  const auto taken = union_of(rules, chosen, count);
  if (!taken) return std::nullopt;
  const std::vector<Merged> merged = merged_rules(*taken);
  if (merged.size() > most_rules) return std::nullopt;
  std::vector<std::string> said;
  for (const Merged& one : merged) {
    constexpr std::size_t most_levels = 5;
    std::string text;
    for (std::size_t k = 0; k < one.attributes.size(); ++k) {
      const Attribute& attribute = attributes_[one.attributes[k]];
      if (one.levels[k].size() > most_levels && !end_of_number(attribute, one.levels[k])) return std::nullopt;
      const auto level = words(attribute, one.levels[k]);
      if (!level) return std::nullopt;
      text += (k == 0 ? "" : " with ") + *level;
    }
    said.push_back(std::move(text));
  }
  return and_names(said);
}

const SetNames::Attribute* SetNames::widest(std::size_t levels, const std::string& but) const {
  const Attribute* out = nullptr;
  for (const Attribute& attribute : attributes_)
    if (names_a_method(attribute.column) && attribute.column != but && (!out || attribute.all.size() > out->all.size()))
      out = &attribute;
  return out && out->all.size() >= levels ? out : nullptr;
}

std::optional<std::string> SetNames::whole_levels(const Picked& chosen, std::size_t count) const {
  constexpr std::size_t many = 6, listed = 7;
  const Attribute* widest = this->widest(many);
  if (!widest) return std::nullopt;
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

namespace {

constexpr double pure = 0.8;  // share of what a rule picks that is of the set

}  // namespace

std::optional<std::string> SetNames::nearest(const Picked& chosen, std::size_t count, double least_worth) const {
  std::optional<std::pair<double, std::string>> best;
  constexpr double enough_hit = 0.6, per_part = 0.01;
  const auto consider = [&](const Rule& rule) {
    std::size_t got = 0, hit = 0;
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      if (!has(rule, m)) continue;
      ++got;
      hit += chosen[m] != 0 ? 1 : 0;
    }
    const double h = static_cast<double>(hit), c = static_cast<double>(count), g = static_cast<double>(got);
    if (h < enough_hit * c || h < pure * g) return;
    const double worth = 2 * h / (g + c) - per_part * static_cast<double>(rule.levels.size());
    if (worth < least_worth || (best && worth <= best->first)) return;
    std::string text;
    for (std::size_t k = 0; k < rule.levels.size(); ++k) {
      const auto said = words(attributes_[rule.attributes[k]], {rule.levels[k]});
      if (!said) return;
      text += (k == 0 ? "" : " with ") + *said;
    }
    constexpr std::size_t named = 2;
    if (hit == got && count - hit <= named) {
      std::vector<std::string> others = {text};
      for (std::size_t m = 0; m < methods_.size(); ++m)
        if (chosen[m] && !has(rule, m)) others.push_back(label(m));
      best = {worth, and_names(others)};
      return;
    }
    text += fmt::format(" ({} of {}", hit, got);
    if (count > hit) text += fmt::format(", and {} other{}", count - hit, count - hit == 1 ? "" : "s");
    best = {worth, "mostly " + text + ")"};
  };
  for (std::size_t a = 0; a < attributes_.size(); ++a)
    for (const std::string& level : attributes_[a].all) {
      if (level.empty()) continue;
      consider({{a}, {level}, {}});
      for (std::size_t b = a + 1; b < attributes_.size(); ++b)
        for (const std::string& other : attributes_[b].all)
          if (!other.empty()) consider({{a, b}, {level, other}, {}});
    }
  if (!best && least_worth == 0) return all_levels(chosen, count);
  return best ? std::optional(best->second) : std::nullopt;
}

std::optional<std::string> SetNames::all_levels(const Picked& chosen, std::size_t count) const {
  const auto inside = [&](const Attribute& attribute) {
    std::vector<std::string> met;
    for (const std::string& level : attribute.all)
      for (std::size_t m = 0; m < methods_.size(); ++m)
        if (chosen[m] && attribute.levels[m] == level) {
          met.push_back(level);
          break;
        }
    return met;
  };
  constexpr std::size_t most_levels = 7;
  std::size_t fewest = methods_.size();
  std::optional<std::string> best;
  for (const Attribute& a : attributes_)
    for (const Attribute& b : attributes_) {
      if (axis_role(a.column) == axis_role(b.column)) continue;
      const std::vector<std::string> in_a = inside(a), in_b = inside(b);
      if (in_a.size() == a.all.size() || in_b.size() == b.all.size() || in_a.size() + in_b.size() > most_levels)
        continue;
      std::size_t got = 0;
      for (std::size_t m = 0; m < methods_.size(); ++m)
        got += std::count(in_a.begin(), in_a.end(), a.levels[m]) > 0 &&
                       std::count(in_b.begin(), in_b.end(), b.levels[m]) > 0
                   ? 1
                   : 0;
      const auto first = words(a, in_a), second = words(b, in_b);
      if (got >= fewest || !first || !second || static_cast<double>(count) < pure * static_cast<double>(got)) continue;
      fewest = got;
      best = fmt::format("mostly {} with {} ({} of {})", *first, *second, count, got);
    }
  return best;
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
  std::stable_sort(counts.begin(), counts.end(),
                   [](const auto& a, const auto& b) { return a.second.first > b.second.first; });
  constexpr std::size_t many = 6, listed = 4;
  constexpr double most_of_them = 0.75;
  const Attribute* names = methods_.size() <= most_named ? widest(many, axis_role(best->column)) : nullptr;
  std::vector<std::string> out;
  for (const auto& [level, count] : counts) {
    const auto said = words(*best, {level});
    if (!said) return std::nullopt;
    const auto& [in, all] = count;
    if (in == all) {
      out.push_back(fmt::format("all {} with {}", all, *said));
    } else if (!names || static_cast<double>(in) >= most_of_them * static_cast<double>(all)) {
      out.push_back(fmt::format("{} of {} with {}", in, all, *said));
    } else {
      std::vector<std::string> own;
      for (std::size_t m = 0; m < methods_.size(); ++m)
        if (chosen[m] && best->levels[m] == level)
          own.push_back(names->whole ? names->levels[m] : study_.value_words(names->column, names->levels[m]));
      const std::size_t more = own.size() > listed ? own.size() - listed : 0;
      own.resize(std::min(own.size(), listed));
      out.push_back(fmt::format(
          "{} with {}", more > 0 ? fmt::format("{} and {} more", fmt::join(own, ", "), more) : and_list(own), *said));
    }
  }
  return fmt::format("{}", fmt::join(out, "; "));
}

std::string SetNames::common(const Picked& chosen, std::size_t count) const {
  const auto levels_met = [&](const Attribute& attribute) {
    std::set<std::string> met;
    for (std::size_t m = 0; m < methods_.size(); ++m)
      if (chosen[m]) met.insert(attribute.levels[m]);
    return met;
  };
  // A parameter that all methods of those names have alike tells nothing.
  const auto implied = [&](const Attribute& parameter, const std::string& level) {
    const std::string role = axis_role(parameter.column);
    if (role == parameter.column) return false;
    const auto names = std::find_if(attributes_.begin(), attributes_.end(),
                                    [&](const Attribute& one) { return !one.whole && one.column == role; });
    if (names == attributes_.end()) return false;
    const std::set<std::string> met = levels_met(*names);
    for (std::size_t m = 0; m < methods_.size(); ++m)
      if (met.count(names->levels[m]) > 0 && parameter.levels[m] != level) return false;
    return true;
  };
  std::vector<std::string> shared;
  std::string told;                         // a choice whose level says its parameters
  constexpr std::size_t two = 2, many = 4;  // two levels of many tell as well
  for (const Attribute& attribute : attributes_) {
    const std::set<std::string> met = levels_met(attribute);
    const bool some = met.size() == two && attribute.all.size() >= many && names_a_method(attribute.column);
    if ((met.size() != 1 && !some) || met.count("") > 0 || axis_role(attribute.column) == told) continue;
    if (met.size() == 1 && implied(attribute, *met.begin())) continue;
    if (attribute.whole || some) told = axis_role(attribute.column);
    const auto text = words(attribute, {met.begin(), met.end()});
    if (!text) continue;
    if (!attribute.owner.empty()) std::erase(shared, attribute.owner);
    shared.push_back(*text);
  }
  const std::string text = fmt::format("{} of {} methods", count, methods_.size());
  return shared.empty() ? text : fmt::format("{}, all of them with {}", text, and_list(shared));
}

}  // namespace ricochet::answers
