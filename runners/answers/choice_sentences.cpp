#include "runners/answers/choice_sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runners/answers/set_names.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::answers {
namespace {

std::string effect_size(const ChoiceEffect& effect) {
  constexpr double much_more = 1.3;
  std::string text = by_percent(effect.typical);
  if (effect.largest > much_more * effect.typical && effect.largest > tolerance)
    text += ", up to " + percent(effect.largest);
  return text;
}

std::string effect_ends(const ChoiceEffect& effect) {
  return effect.matters == 0 || effect.most.empty() || effect.least.empty()
             ? ""
             : fmt::format(", most with {}, least with {}", effect.most, effect.least);
}

std::string place_in_words(const ChoiceEffect& effect) {
  return !effect.where.empty() ? effect.where
                               : fmt::format(" in {} of {} combinations", effect.matters, effect.rows.size());
}

Clause effect_clause(const MeasureWords& words, const ChoiceEffect& effect, const char* verdict) {
  Clause out;
  out.form = std::string(verdict) == "matters in part" ? "part" : std::string(verdict) == "open" ? "open" : "matters";
  out.measure = words.measure;
  out.choice = effect.choice;
  out.who = effect.where.starts_with(" with ") ? effect.where.substr(6) : "";
  out.value = 100 * effect.typical;
  out.high = 100 * effect.largest;
  if (effect.typical_uncertainty) out.uncertainty = 100 * *effect.typical_uncertainty;
  out.unit = "%";
  out.status = verdict;
  return out;
}

/// What each level of a choice gives, over all else, the largest first: "100 % with Hertz, 71 % with Hunt–Crossley".
std::vector<Sentence> say_level_values(const Compared& study, const MeasureLimits& limits, const std::string& asked,
                                       const std::vector<std::string>& own) {
  struct Level {
    std::string name;
    double low = 0, high = 0;
  };
  InOrderMet<std::string, std::vector<const Method*>> groups;
  for (const Method* method : limits.with_limit()) groups[study.key(method->first(), own)].push_back(method);
  std::vector<Level> levels;
  for (const auto& [key, methods] : groups.list()) {
    Level one{study.level(methods.front()->first(), axis_role(asked)), methods.front()->limit->value, 0};
    one.high = one.low;
    for (const Method* method : methods) {
      one.low = std::min(one.low, method->limit->value);
      one.high = std::max(one.high, method->limit->value);
    }
    levels.push_back(std::move(one));
  }
  std::stable_sort(levels.begin(), levels.end(), [](const Level& a, const Level& b) { return a.high > b.high; });
  constexpr std::size_t most = 8;
  Sentence said;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const Level& one = levels[k];
    Clause clause{.form = "value", .measure = limits.words.measure, .choice = asked, .who = one.name};
    clause.low = one.low * limits.words.factor;
    clause.high = one.high * limits.words.factor;
    clause.unit = limits.words.unit;
    said.clauses.push_back(clause);
    if (k < most)
      said.text +=
          fmt::format("{}{} with {}", k == 0 ? "" : "; ", range_text(limits.words, one.low, one.high), one.name);
  }
  said.text = fmt::format("{}: {}{}.", capitalised(limits.words.words), said.text,
                          levels.size() > most ? fmt::format("; {} more in the table", levels.size() - most) : "");
  return {said};
}

}  // namespace

std::vector<Sentence> say_choices(const Compared& study, const MeasureWords& words, std::vector<ChoiceEffect> effects) {
  std::vector<Sentence> out;
  if (effects.empty()) return out;
  std::stable_sort(effects.begin(), effects.end(),
                   [](const ChoiceEffect& a, const ChoiceEffect& b) { return a.typical > b.typical; });
  enum class Verdict { main, none, part, open };
  constexpr double nearly_all = 0.9;
  const auto verdict = [&](const ChoiceEffect& one) {
    const auto rows = static_cast<double>(one.rows.size());
    if (static_cast<double>(one.matters) > 0.5 * rows) return Verdict::main;
    if (static_cast<double>(one.matters_not) >= nearly_all * rows) return Verdict::none;
    return one.matters > 0 ? Verdict::part : Verdict::open;
  };
  const bool one_size = std::all_of(effects.begin(), effects.end(),
                                    [](const ChoiceEffect& one) { return !one.typical_uncertainty.has_value(); });
  if (const auto asked = std::find_if(effects.begin(), effects.end(),
                                      [&](const ChoiceEffect& one) { return one.choice == study.asked(); });
      asked != effects.end()) {
    const std::string name = spoken(asked->choice);
    switch (verdict(*asked)) {
      case Verdict::none:
        out.push_back(
            {fmt::format("{} does not matter: it moves {} by {}{}.", capitalised(name), words.words,
                         asked->largest <= tolerance ? "at most " + percent(asked->largest) : effect_size(*asked),
                         asked->typical_uncertainty ? ", known to " + percent(*asked->typical_uncertainty) : ""),
             {effect_clause(words, *asked, "does not matter")}});
        break;
      case Verdict::main:
        out.push_back({fmt::format("{} matters: it moves {} by {}{}.", capitalised(name), words.words,
                                   effect_size(*asked), effect_ends(*asked)),
                       {effect_clause(words, *asked, "matters")}});
        break;
      case Verdict::part:
        out.push_back({fmt::format("{} matters{}: it moves {} by {}{}.", capitalised(name), place_in_words(*asked),
                                   words.words, effect_size(*asked), effect_ends(*asked)),
                       {effect_clause(words, *asked, "matters in part")}});
        break;
      case Verdict::open:
        out.push_back(
            {fmt::format("Whether {} matters cannot be told at these steps: it moves {} by {}, and refinement "
                         "still moves that by {}.",
                         name, words.words, effect_size(*asked), percent(asked->typical_uncertainty.value_or(0))),
             {effect_clause(words, *asked, "open")}});
        break;
    }
    effects.erase(asked);
    // A column of a method that was asked for speaks for its role.
    std::erase_if(effects, [&](const ChoiceEffect& one) {
      return axis_role(study.asked()) == one.choice && study.columns_of(one.choice).size() == 1;
    });
  }
  const auto list = [&](Verdict which, std::size_t most, const char* status, const auto& say) {
    Sentence said;
    std::size_t count = 0;
    for (const ChoiceEffect& one : effects) {
      if (verdict(one) != which || count++ >= most) continue;
      said.text += (said.text.empty() ? "" : "; ") + say(one, said.text.empty());
      said.clauses.push_back(effect_clause(words, one, status));
    }
    return said;
  };
  constexpr std::size_t three = 3, all = 100;
  Sentence main = list(Verdict::main, three, "matters", [&](const ChoiceEffect& one, bool first) {
    return first ? fmt::format("What moves {} most is {}: by {}{}", words.words, spoken(one.choice), effect_size(one),
                               effect_ends(one))
                 : fmt::format("then {}, {}{}", spoken(one.choice), effect_size(one), effect_ends(one));
  });
  Sentence part = list(Verdict::part, three, "matters in part", [&](const ChoiceEffect& one, bool) {
    return fmt::format("{} (up to {}{}{})", spoken(one.choice), percent(one.largest),
                       one.where.empty() ? fmt::format(", in {} of {}", one.matters, one.rows.size()) : one.where,
                       effect_ends(one));
  });
  Sentence none = list(Verdict::none, all, "does not matter", [&](const ChoiceEffect& one, bool) {
    return fmt::format("{} ({})", spoken(one.choice), effect_size(one));
  });
  Sentence open = list(Verdict::open, all, "open", [&](const ChoiceEffect& one, bool) {
    return fmt::format("{} ({}{})", spoken(one.choice), effect_size(one),
                       one.typical_uncertainty
                           ? "; refinement still moves the difference by " + percent(*one.typical_uncertainty)
                           : "");
  });
  const bool begun = !out.empty() || !main.text.empty();
  if (!part.text.empty())
    part.text =
        (begun ? "In some combinations only: " : "What moves " + words.words + ", in some combinations only: ") +
        part.text;
  if (!none.text.empty())
    none.text = (none.clauses.size() == 1 ? "Does not matter: " : "Do not matter: ") +
                (begun || !part.text.empty() ? "" : words.words + ": ") + none.text;
  if (!open.text.empty()) open.text = "Not told at these steps: " + open.text;
  for (Sentence* one : {&main, &part, &none, &open})
    if (!one->text.empty()) {
      one->text += ".";
      out.push_back(std::move(*one));
    }
  if (one_size && !out.empty())
    out.push_back({"All at one step and one mesh: how far refinement would move these is not known.",
                   {Clause{.form = "status", .measure = words.measure, .status = "one"}}});
  return out;
}

std::vector<Sentence> say_levels(const Compared& study, const MeasureLimits& limits) {
  const std::string& asked = study.asked();
  const std::vector<std::string> own =
      axis_role(asked) == asked ? study.columns_of(asked) : std::vector<std::string>{asked};
  std::vector<std::string> others;
  for (const std::string& column : study.columns())
    if (std::find(own.begin(), own.end(), column) == own.end()) others.push_back(column);
  InOrderMet<std::string, const Method*> levels;
  for (const Method& method : limits.methods)
    if (const std::string key = study.key(method.first(), own); !levels.holds(key)) levels[key] = &method;
  constexpr std::size_t many = 5;
  if (own.empty() || levels.list().size() < many) return {};
  const auto methods = limits.with_limit();
  std::map<std::pair<std::string, std::string>, const Method*> at;
  InOrderMet<std::string, bool> combinations;
  for (const Method* method : methods) {
    const std::string rest = study.key(method->first(), others);
    at[{study.key(method->first(), own), rest}] = method;
    combinations[rest] = true;
  }
  const std::string first = levels.list().front().first;
  Cases compared;
  Members agree, differ;
  std::vector<double> sizes;
  for (const auto& [level, example] : levels.list()) {
    if (level == first) continue;
    std::optional<double> largest;
    for (const auto& [rest, met] : combinations.list()) {
      const auto one = at.find({level, rest}), reference = at.find({first, rest});
      if (one == at.end() || reference == at.end()) continue;
      const double scale = scale_of(limits.words, {one->second, reference->second});
      if (scale > 0) largest = std::max(largest.value_or(0), paired(*one->second, *reference->second).value / scale);
    }
    if (!largest) continue;
    (*largest <= tolerance ? agree : differ).push_back(compared.size());
    compared.push_back(&example->first());
    sizes.push_back(*largest);
  }
  if (compared.empty()) return {};
  const SetNames names(study, compared, own);
  const std::string reference = study.level(levels.list().front().second->first(), axis_role(asked));
  const auto range = [&](const Members& members) {
    double low = sizes[members.front()], high = low;
    for (const std::size_t k : members) low = std::min(low, sizes[k]), high = std::max(high, sizes[k]);
    return std::pair(low, high);
  };
  const auto clause = [&](const Members& members, const char* status) {
    Clause out;
    out.form = "matters";
    out.measure = limits.words.measure;
    out.choice = asked;
    out.who = names.of(members);
    out.low = 100 * range(members).first;
    out.high = 100 * range(members).second;
    out.unit = "%";
    out.status = status;
    for (const std::size_t k : members) out.methods += (out.methods.empty() ? "" : " ") + compared[k]->id;
    return out;
  };
  std::vector<Sentence> out;
  if (!agree.empty()) {
    // What is equal to the last digit is often the same method by another name.
    const double nearest = range(agree).first;
    out.push_back({fmt::format("Within {} of {} in {}: {}{}.", percent(tolerance), reference, limits.words.words,
                               names.of(agree), nearest > 0 ? "; the nearest differs by " + percent(nearest) : ""),
                   {clause(agree, "agrees")}});
  }
  if (agree.empty()) return say_level_values(study, limits, asked, own);
  if (!differ.empty()) {
    const auto [low, high] = range(differ);
    const std::string width = percent(low) == percent(high) ? percent(low) : percent(low) + " to " + percent(high);
    out.push_back({fmt::format("{}: {}, by {}.",
                               out.empty() ? fmt::format("None is within {} of {} in {}", percent(tolerance), reference,
                                                         limits.words.words)
                                           : std::string("Farther"),
                               names.of(differ), width),
                   {clause(differ, "differs")}});
  }
  return out;
}

}  // namespace ricochet::answers
