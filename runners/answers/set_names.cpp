#include "runners/answers/set_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/text.hpp"

namespace ricochet::answers {
namespace {

constexpr std::size_t most_searched = 500, most_ruled = 10000, few = 3;
constexpr double short_rule = 6.6, long_rule = 9, nearly_exact = 0.9;

bool is_role(const std::string& column) {
  return is_method_role(column);
}

bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

}  // namespace

std::string without_count(const std::string& name) {
  const std::size_t at = name.find(" methods");
  if (at == std::string::npos || name.find_first_not_of("0123456789 of", 0) < at) return name;
  return at + 8 >= name.size() ? "" : name.substr(at + 10);
}

std::string and_list(const std::vector<std::string>& items) {
  std::string out;
  for (std::size_t k = 0; k < items.size(); ++k)
    out += (k == 0 ? "" : k + 1 == items.size() ? " and " : ", ") + items[k];
  return out;
}

std::string and_names(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t k = 0; k < names.size(); ++k)
    out += (k == 0 ? "" : k + 1 == names.size() ? ", and " : ", ") + names[k];
  return out;
}

namespace {

/// "1e3, 1e4 and 1e5": where one number has an exponent, whole thousands get one too.
std::vector<std::string> one_notation(std::vector<std::string> values) {
  const bool exponents = std::any_of(values.begin(), values.end(), [](const std::string& one) {
    return one.find('e') != std::string::npos && number_in(one) && *number_in(one) >= 1;
  });
  if (!exponents) return values;
  for (std::string& one : values) {
    constexpr double thousand = 1000;
    const auto number = number_in(one);
    if (!number || one.find('e') != std::string::npos || std::fmod(*number, thousand) != 0 || *number == 0) continue;
    const double power = std::floor(std::log10(*number));
    one = fmt::format("{:g}e{:.0f}", *number / std::pow(10, power), power);
  }
  return values;
}

}  // namespace

SetNames::SetNames(const Choices& study, Cases methods, std::vector<std::string> columns)
    : study_(study), methods_(std::move(methods)), columns_(std::move(columns)) {
  std::vector<std::string> done;
  for (const std::string& column : columns_) {
    const std::string choice = axis_role(column);
    if (contains(done, choice)) continue;
    done.push_back(choice);
    std::vector<std::string> own;
    for (const std::string& one : columns_)
      if (axis_role(one) == choice) own.push_back(one);
    const bool whole = own.size() > 1;
    std::vector<std::string> levels;
    for (const CaseRecord* one : methods_)
      levels.push_back(whole ? study_.level(*one, choice) : study_.text(*one, own.front()));
    add(whole ? choice : own.front(), whole, levels);
    if (!whole) continue;
    for (const std::string& one : own) {
      levels.clear();
      for (const CaseRecord* method : methods_) levels.push_back(study_.text(*method, one));
      // A parameter with one value wherever there is one only says who has it.
      std::set<std::string> values(levels.begin(), levels.end());
      values.erase("");
      if (values.size() > 1) add(one, false, levels);
    }
  }
}

void SetNames::add(std::string column, bool whole, std::vector<std::string> levels) {
  Attribute attribute{std::move(column), whole, std::move(levels), {}, {}};
  for (const std::string& level : attribute.levels)
    if (!contains(attribute.all, level)) attribute.all.push_back(level);
  // "Hunt–Crossley damping 2 s/m": a parameter that one method alone has is told with it.
  const std::string role = axis_role(attribute.column);
  if (role != attribute.column && role != "mass") {
    std::set<std::string> names, owners;
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      names.insert(study_.text(*methods_[m], role));
      if (!attribute.levels[m].empty()) owners.insert(study_.text(*methods_[m], role));
    }
    if (names.size() > 1 && owners.size() == 1) attribute.owner = study_.method_words(role, *owners.begin());
  }
  if (attribute.all.size() > 1) attributes_.push_back(std::move(attribute));
}

std::string SetNames::label(std::size_t method) const {
  std::vector<std::string> choices;
  for (const std::string& column : columns_)
    if (const std::string choice = axis_role(column); !contains(choices, choice)) choices.push_back(choice);
  return study_.name(*methods_[method], choices);
}

std::optional<std::string> SetNames::end_of_number(const Attribute& attribute,
                                                   const std::vector<std::string>& levels) const {
  if (attribute.whole || levels.size() < few || levels.size() == attribute.all.size()) return std::nullopt;
  std::vector<std::pair<double, std::string>> all, chosen;
  for (const std::string& level : attribute.all)
    if (const auto number = number_in(level)) all.emplace_back(*number, level);
  for (const std::string& level : levels) {
    const auto number = number_in(level);
    if (!number) return std::nullopt;
    chosen.emplace_back(*number, level);
  }
  std::sort(all.begin(), all.end());
  std::sort(chosen.begin(), chosen.end());
  const auto fits = [&](auto begin) { return std::equal(chosen.begin(), chosen.end(), begin); };
  if (fits(all.end() - static_cast<std::ptrdiff_t>(chosen.size())))
    return study_.value_words(attribute.column, chosen.front().second) + " and more";
  if (fits(all.begin())) return study_.value_words(attribute.column, chosen.back().second) + " and less";
  return std::nullopt;
}

std::optional<std::string> SetNames::words(const Attribute& attribute, const std::vector<std::string>& levels) const {
  if (levels.empty()) return std::nullopt;
  if (!attribute.owner.empty()) {
    Attribute alone = attribute;
    alone.owner.clear();
    const auto text = words(alone, levels);
    return text ? std::optional(attribute.owner + " " + *text) : std::nullopt;
  }
  if (auto end = end_of_number(attribute, levels)) return end;
  const bool role = is_role(attribute.column);
  if (contains(levels, "") && !role) return std::nullopt;
  std::vector<std::string> said;
  for (const std::string& level : levels)
    said.push_back(attribute.whole ? level : study_.value_words(attribute.column, level));
  if (attribute.column == "mass") {
    for (std::string& one : said) one = "the " + one;
    return and_list(said) + " mass";
  }
  if (said.size() > 1) {
    // "β = 0, ¼ and ½": what stands before and behind each value is said once.
    std::string before = said.front(), behind = said.front();
    for (const std::string& one : said) {
      std::size_t same = 0;
      while (same < before.size() && same < one.size() && before[same] == one[same]) ++same;
      before.resize(same);
      same = 0;
      while (same < behind.size() && same < one.size() &&
             behind[behind.size() - 1 - same] == one[one.size() - 1 - same])
        ++same;
      behind = behind.substr(behind.size() - same);
    }
    before.resize(before.rfind(' ') == std::string::npos ? 0 : before.rfind(' ') + 1);
    const std::size_t space = behind.find(' ');
    behind = space == std::string::npos ? "" : behind.substr(space);
    std::vector<std::string> values;
    for (const std::string& one : said)
      if (one.size() > before.size() + behind.size())
        values.push_back(one.substr(before.size(), one.size() - before.size() - behind.size()));
    if (values.size() == said.size()) return before + and_list(one_notation(values)) + behind;
  }
  return and_list(said);
}

std::optional<std::pair<double, std::string>> SetNames::rule(const Picked& chosen) const {
  std::optional<std::pair<double, std::string>> best;
  const std::size_t attributes = attributes_.size();
  // Levels that the chosen have, of each attribute; an attribute of which they have all tells nothing.
  std::vector<std::vector<std::string>> inside(attributes);
  std::vector<Picked> picks(attributes);
  std::vector<std::size_t> useful;
  for (std::size_t a = 0; a < attributes; ++a) {
    std::set<std::string> met;
    for (std::size_t m = 0; m < methods_.size(); ++m)
      if (chosen[m]) met.insert(attributes_[a].levels[m]);
    if (met.size() == attributes_[a].all.size()) continue;
    for (const std::string& level : attributes_[a].all)
      if (met.count(level)) inside[a].push_back(level);
    for (std::size_t m = 0; m < methods_.size(); ++m) picks[a].push_back(met.count(attributes_[a].levels[m]) ? 1 : 0);
    useful.push_back(a);
  }
  const auto attempt = [&](const std::vector<std::size_t>& parts) {
    // What names its method needs no other rule that does.
    for (const std::size_t a : parts)
      for (const std::size_t b : parts)
        if (!attributes_[a].owner.empty() && attributes_[b].owner.empty() &&
            axis_role(attributes_[a].column) == axis_role(attributes_[b].column))
          return;
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      bool in = true;
      for (const std::size_t a : parts) in = in && picks[a][m];
      if (in != static_cast<bool>(chosen[m])) return;
    }
    double cost = 0.5 * static_cast<double>(parts.size());
    std::vector<std::string> texts;
    for (const std::size_t a : parts) {
      cost += static_cast<double>(inside[a].size());
      const auto text = words(attributes_[a], inside[a]);
      if (!text) return;
      texts.push_back(*text);
    }
    if (best && cost >= best->first) return;
    std::string text = texts.front();
    if (texts.size() > 1) text += " with " + texts[1];
    if (texts.size() > 2) text += " and " + texts[2];
    best = {cost, text};
  };
  for (const std::size_t a : useful) attempt({a});
  if (!best)
    for (std::size_t i = 0; i < useful.size(); ++i)
      for (std::size_t j = i + 1; j < useful.size(); ++j) attempt({useful[i], useful[j]});
  if (!best)
    for (std::size_t i = 0; i < useful.size(); ++i)
      for (std::size_t j = i + 1; j < useful.size(); ++j)
        for (std::size_t k = j + 1; k < useful.size(); ++k) attempt({useful[i], useful[j], useful[k]});
  return best;
}

std::string SetNames::shared(const Members& members) const {
  Picked chosen(methods_.size(), 0);
  for (const std::size_t m : members) chosen[m] = 1;
  return common(chosen, members.size());
}

SetNames::Name SetNames::found(const Members& members, bool may_turn) const {
  const std::size_t count = members.size();
  Picked chosen(methods_.size(), 0);
  for (const std::size_t m : members) chosen[m] = 1;
  if (count == 1 && methods_.size() == 1) return {label(members.front()), false, true};
  if (count == methods_.size()) return {"every method", false, true};
  const bool large = methods_.size() > most_searched;
  const auto best = methods_.size() > most_ruled ? std::nullopt : rule(chosen);
  const bool several = count > 1 && best && best->second.find(" and ") != std::string::npos;
  if (best && best->first <= short_rule) return {best->second, several, true};
  // Among very many no union is searched.
  if (large) {
    const std::string shared = common(chosen, count);
    if (!without_count(shared).empty()) return {shared, count > 1, false};
    return {by_levels(chosen).value_or(shared), count > 1, false};
  }
  if (count > few)
    if (auto text = cover(chosen, count, few)) return {*text, true, true};
  const auto labels = [&](const Members& of) {
    std::vector<std::string> out;
    for (const std::size_t m : of) out.push_back(label(m));
    return out;
  };
  if (count <= few && count + 1 < methods_.size()) return {and_names(labels(members)), count > 1, true};
  Members rest;
  for (std::size_t m = 0; m < methods_.size(); ++m)
    if (!chosen[m]) rest.push_back(m);
  if (rest.size() <= few && count > 1) return {"all but " + and_list(labels(rest)), true, true};
  if (count <= few) return {and_names(labels(members)), count > 1, true};
  if (best && best->first <= long_rule) return {best->second, several, true};
  constexpr std::size_t longest = 90;
  if (may_turn) {
    const Name other = found(rest, false);
    // Of a rest that has several rules it is not plain where the exception ends.
    if (other.exact && other.text.size() < longest && other.text.find(", and ") == std::string::npos)
      return {"all but " + other.text, true, true};
  }
  if (auto text = cover(chosen, count, few + 1)) return {*text, true, true};
  if (auto text = nearest(chosen, count, nearly_exact)) return {*text, true, !text->starts_with("mostly ")};
  if (auto text = whole_levels(chosen, count)) return {*text, true, false};
  const std::string shared = common(chosen, count);
  if (!without_count(shared).empty()) return {shared, true, false};
  if (auto text = nearest(chosen, count, 0)) return {*text, true, !text->starts_with("mostly ")};
  if (auto text = by_levels(chosen)) return {*text, true, false};
  return {shared, true, false};
}

}  // namespace ricochet::answers
