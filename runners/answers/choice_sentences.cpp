#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "runners/answers/measure_answer.hpp"
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
             : fmt::format(", most with {}, least with {}", level_phrase(effect.choice, effect.most),
                           level_phrase(effect.choice, effect.least));
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

}  // namespace

std::vector<Sentence> say_choices(const Compared& study, const MeasureLimits& limits,
                                  std::vector<ChoiceEffect> effects) {
  std::vector<Sentence> out;
  const MeasureWords& words = limits.words;
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
                         by_percent(asked->largest) == by_percent(0) ? by_percent(0)
                         : asked->largest <= tolerance               ? "at most " + percent(asked->largest)
                                                                     : effect_size(*asked),
                         asked->typical_uncertainty && by_percent(*asked->typical_uncertainty) != by_percent(0)
                             ? ", known to " + percent(*asked->typical_uncertainty)
                             : ""),
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
    if (verdict(*asked) == Verdict::main || verdict(*asked) == Verdict::part)
      if (auto values = say_level_values(study, limits)) out.push_back(std::move(*values));
    if (auto steady = say_steady_end(study, limits)) out.push_back(std::move(*steady));
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
    if (!first) return fmt::format("then {}, {}{}", spoken(one.choice), effect_size(one), effect_ends(one));
    const std::string moves = fmt::format("What moves {} most is {}: ", words.words, spoken(one.choice));
    // Levels that are apart whatever else is chosen say it by their values.
    const std::optional<Sentence> values = apart_levels(study, limits, one.choice);
    return moves + (values ? values->text : "by " + effect_size(one) + effect_ends(one));
  });
  if (!main.clauses.empty())
    if (const auto values = apart_levels(study, limits, main.clauses.front().choice))
      main.clauses.insert(main.clauses.end(), values->clauses.begin(), values->clauses.end());
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
  if (one_size && !out.empty()) {
    out.front().text.pop_back();
    out.front().text += "; at one step and one mesh, what refinement leaves of this is not known.";
    out.front().clauses.push_back(Clause{.form = "status", .measure = words.measure, .status = "one"});
  }
  return out;
}

}  // namespace ricochet::answers
