#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ricochet/measure/statistics/tiers.hpp>

#include "runners/answers/measure_answer.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/text.hpp"

// What each level of one choice gives, over all combinations of the others.
namespace ricochet::answers {
namespace {

/// A level with the values that it has over all else.
struct Level {
  const CaseRecord* first = nullptr;
  std::vector<const Method*> methods;
  double low = 0, high = 0;
  double width() const { return high - low; }
};

std::vector<std::string> own_columns(const Compared& study, const std::string& choice) {
  return axis_role(choice) == choice ? study.columns_of(choice) : std::vector<std::string>{choice};
}

std::string level_words(const Compared& study, const CaseRecord& record, const std::string& choice) {
  return axis_role(choice) == choice ? level_phrase(choice, study.level(record, choice))
                                     : study.value_words(choice, study.text(record, choice));
}

std::vector<Level> levels_of(const Compared& study, const std::vector<const Method*>& methods,
                             const std::vector<std::string>& own) {
  InOrderMet<std::string, Level> groups;
  for (const Method* method : methods) {
    Level& one = groups[study.key(method->first(), own)];
    const Limit& limit = *method->limit;
    const bool wanders = limit.status == LimitStatus::wanders;
    const double from = wanders ? std::min(limit.low, limit.value) : limit.value;
    const double to = wanders ? std::max(limit.high, limit.value) : limit.value;
    one.low = one.first ? std::min(one.low, from) : from;
    one.high = one.first ? std::max(one.high, to) : to;
    if (!one.first) one.first = &method->first();
    one.methods.push_back(method);
  }
  std::vector<Level> out;
  for (auto& [key, level] : std::move(groups).list()) out.push_back(std::move(level));
  return out;
}

Clause value_clause(const MeasureLimits& limits, const std::string& choice, const std::string& who, double low,
                    double high) {
  Clause out{.form = "value", .measure = limits.words.measure, .choice = choice, .who = who};
  out.low = low * limits.words.factor;
  out.high = high * limits.words.factor;
  out.unit = limits.words.unit;
  return out;
}

/// The levels of a choice in tiers of their values, the largest first, and those whose value is decided by the rest.
std::vector<Sentence> say_level_tiers(const Compared& study, const MeasureLimits& limits, const std::string& asked,
                                      const std::vector<std::string>& own) {
  const std::vector<const Method*> methods = limits.without_gain();
  const std::vector<Level> levels = levels_of(study, methods, own);
  if (levels.empty()) return {};
  const double scale = scale_of(limits.words, methods);
  double least = levels.front().low, most = levels.front().high;
  for (const Level& one : levels) least = std::min(least, one.low), most = std::max(most, one.high);
  Cases firsts;
  for (const Level& one : levels) firsts.push_back(one.first);
  const SetNames names(study, firsts, own);
  constexpr double wide = 0.1, tolerances = 5;
  Members firm, loose;
  std::vector<Limit> values;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    if (levels[k].width() > std::max(tolerances * tolerance * scale, wide * (most - least))) {
      loose.push_back(k);
      continue;
    }
    firm.push_back(k);
    Limit& one = values.emplace_back();
    one.low = levels[k].low;
    one.high = levels[k].high;
    one.value = 0.5 * (one.low + one.high);
  }
  std::vector<Members> tiers = tiers_of(values, tolerance * scale).tiers;
  std::reverse(tiers.begin(), tiers.end());
  std::vector<Sentence> out;
  constexpr std::size_t told = 6;
  Sentence said;
  for (std::size_t t = 0; t < tiers.size(); ++t) {
    for (std::size_t& k : tiers[t]) k = firm[k];
    std::sort(tiers[t].begin(), tiers[t].end());
    double low = levels[tiers[t].front()].low, high = levels[tiers[t].front()].high;
    for (const std::size_t k : tiers[t]) low = std::min(low, levels[k].low), high = std::max(high, levels[k].high);
    const std::string who = names.of(tiers[t]);
    said.clauses.push_back(value_clause(limits, asked, who, low, high));
    if (t < told)
      said.text += fmt::format("{}{} with {}", t == 0 ? "" : "; ", range_text(limits.words, low, high), who);
  }
  if (!said.text.empty()) {
    said.text = fmt::format("{}: {}{}.", capitalised(limits.words.words), said.text,
                            tiers.size() > told ? fmt::format("; {} more in the table", tiers.size() - told) : "");
    out.push_back(std::move(said));
  }
  if (!loose.empty()) {
    double low = levels[loose.front()].low, high = levels[loose.front()].high;
    for (const std::size_t k : loose) low = std::min(low, levels[k].low), high = std::max(high, levels[k].high);
    std::vector<std::string> others;
    for (const std::string& choice : study.choices())
      if (choice != axis_role(asked)) others.push_back(spoken(choice));
    const std::string who = names.of(loose);
    out.push_back(
        {fmt::format("With {} {} depends on {}: {}.", who, limits.words.words,
                     others.size() == 1 ? others.front() : "the other choices", range_text(limits.words, low, high)),
         {value_clause(limits, asked, who, low, high)}});
  }
  return out;
}

}  // namespace

std::optional<Sentence> apart_levels(const Compared& study, const MeasureLimits& limits, const std::string& choice) {
  constexpr std::size_t most_levels = 6;
  if (limits.words.decades) return std::nullopt;
  const std::vector<const Method*> methods = limits.without_gain();
  std::vector<Level> levels = levels_of(study, methods, own_columns(study, choice));
  if (levels.size() < 2 || levels.size() > most_levels) return std::nullopt;
  std::stable_sort(levels.begin(), levels.end(), [](const Level& a, const Level& b) { return a.low < b.low; });
  const double scale = scale_of(limits.words, methods);
  Sentence out;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const Level& one = levels[k];
    if (k > 0) {
      const double gap = one.low - levels[k - 1].high;
      if (gap <= tolerance * scale || gap <= one.width() || gap <= levels[k - 1].width()) return std::nullopt;
    }
    const std::string who = level_words(study, *one.first, choice);
    out.clauses.push_back(value_clause(limits, choice, who, one.low, one.high));
    out.text += fmt::format("{}{} with {}", k == 0 ? "" : ", ", range_text(limits.words, one.low, one.high), who);
  }
  return out;
}

std::optional<Sentence> say_level_values(const Compared& study, const MeasureLimits& limits) {
  constexpr std::size_t most_levels = 8;
  const std::string& asked = study.asked();
  const std::vector<const Method*> methods = limits.without_gain();
  std::vector<Level> levels = levels_of(study, methods, own_columns(study, asked));
  if (levels.size() < 2 || levels.size() > most_levels) return std::nullopt;
  const bool less = limits.words.direction < 0 || limits.words.decades;
  std::stable_sort(levels.begin(), levels.end(),
                   [&](const Level& a, const Level& b) { return less ? a.high < b.high : a.low > b.low; });
  const Level &best = less ? levels.front() : levels.back(), &worst = less ? levels.back() : levels.front();
  if (best.high >= worst.low) return std::nullopt;
  Sentence out;
  for (const Level& one : levels) {
    const std::string who = level_words(study, *one.first, asked);
    out.clauses.push_back(value_clause(limits, asked, who, one.low, one.high));
    out.text +=
        fmt::format("{}{} with {}", out.text.empty() ? "" : "; ", range_text(limits.words, one.low, one.high), who);
  }
  out.text = capitalised(limits.words.words) + ": " + out.text + ".";
  return out;
}

std::optional<Sentence> say_steady_end(const Compared& study, const MeasureLimits& limits) {
  const std::string& asked = study.asked();
  const std::vector<double>& numbers = study.numbers_of(asked);
  constexpr std::size_t several = 4, two = 2;
  constexpr double steady = 0.1;  // of what matters
  if (numbers.size() < several) return std::nullopt;
  std::vector<std::string> others = study.columns();
  std::erase(others, asked);
  std::map<std::string, std::map<double, const Method*>> rows;
  for (const Method* method : limits.without_gain())
    if (const auto number = number_in(study.text(method->first(), asked)))
      rows[study.key(method->first(), others)][*number] = method;
  const double scale = scale_of(limits.words, limits.without_gain());
  if (scale <= 0) return std::nullopt;
  // How far apart two levels within are, at most.
  const auto spread = [&](double low, double high) {
    double most = 0;
    for (const auto& [rest, levels] : rows) {
      std::vector<const Method*> inside;
      for (const auto& [number, method] : levels)
        if (low <= number && number <= high) inside.push_back(method);
      if (inside.size() > 1) most = std::max(most, farthest(inside).value / scale);
    }
    return most;
  };
  const auto words = [&](double number) {
    for (const CaseRecord& record : study.results().cases)
      if (number_in(study.text(record, asked)) == number) return study.value_words(asked, study.text(record, asked));
    return short_number(number);
  };
  const double first = numbers.front(), last = numbers.back();
  if (spread(first, last) <= tolerance) return std::nullopt;
  std::size_t from = numbers.size() - 1, to = 0;
  while (from > 0 && spread(numbers[from - 1], last) <= steady * tolerance) --from;
  while (to + 1 < numbers.size() && spread(first, numbers[to + 1]) <= steady * tolerance) ++to;
  const bool upper = numbers.size() - from >= to + 1;
  if ((upper ? numbers.size() - from : to + 1) < two) return std::nullopt;
  const double size = upper ? spread(numbers[from], last) : spread(first, numbers[to]);
  const std::string who = upper ? "from " + words(numbers[from]) + " on" : "up to " + words(numbers[to]);
  Clause clause{.form = "matters", .measure = limits.words.measure, .choice = asked, .who = who};
  clause.high = 100 * size;
  clause.unit = "%";
  clause.status = "does not matter";
  return Sentence{fmt::format("{} it moves {} by {}.", capitalised(who), limits.words.words,
                              by_percent(size) == by_percent(0) ? by_percent(0) : "at most " + percent(size)),
                  {clause}};
}

std::vector<Sentence> say_levels(const Compared& study, const MeasureLimits& limits) {
  const std::string& asked = study.asked();
  // Of a number no level is the reference of the others.
  if (axis_role(asked) != asked && !study.numbers_of(asked).empty()) return {};
  const std::vector<std::string> own = own_columns(study, asked);
  const std::vector<std::string> others = without(study.columns(), own);
  InOrderMet<std::string, const Method*> levels;
  for (const Method& method : limits.methods)
    if (const std::string key = study.key(method.first(), own); !levels.holds(key)) levels[key] = &method;
  constexpr std::size_t many = 5;
  if (own.empty() || levels.list().size() < many) return {};
  std::map<std::pair<std::string, std::string>, const Method*> at;
  InOrderMet<std::string, bool> combinations;
  for (const Method* method : limits.without_gain()) {
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
  if (agree.empty()) return say_level_tiers(study, limits, asked, own);
  const SetNames names(study, compared, own);
  const std::string reference = study.level(levels.list().front().second->first(), axis_role(asked));
  const auto clause = [&](const Members& members, const char* status) {
    Clause out;
    out.form = "matters";
    out.measure = limits.words.measure;
    out.choice = asked;
    out.who = names.of(members);
    double low = sizes[members.front()], high = low;
    for (const std::size_t k : members) low = std::min(low, sizes[k]), high = std::max(high, sizes[k]);
    out.low = 100 * low;
    out.high = 100 * high;
    out.unit = "%";
    out.status = status;
    for (const std::size_t k : members) out.methods += (out.methods.empty() ? "" : " ") + compared[k]->id;
    return out;
  };
  std::vector<Sentence> out;
  Sentence said;
  said.clauses.push_back(clause(agree, "agrees"));
  said.text = fmt::format("Within {} of {} in {}: {}", percent(tolerance), reference, limits.words.words,
                          said.clauses.front().who);
  // The same at a hundredth of that, where it tells some of them apart.
  constexpr double hundredth = 0.01;
  Members closely;
  for (const std::size_t k : agree)
    if (sizes[k] <= hundredth * tolerance) closely.push_back(k);
  constexpr std::size_t longest = 90;
  if (!closely.empty() && closely.size() < agree.size())
    if (Clause one = clause(closely, "agrees closely"); one.who.size() <= longest) {
      said.text += fmt::format("; within {}: {}", percent(hundredth * tolerance), one.who);
      said.clauses.push_back(std::move(one));
    }
  said.text += ".";
  out.push_back(std::move(said));
  if (!differ.empty()) {
    const Clause far = clause(differ, "differs");
    const std::string low = percent(*far.low / 100), high = percent(*far.high / 100);
    out.push_back({fmt::format("Farther: {}, by {}.", far.who, low == high ? low : low + " to " + high), {far}});
  }
  // A variant of the choice that has a name of its own: what it alone moves.
  for (const std::string& column : own) {
    const bool numbers = !study.numbers_of(column).empty();
    if (column == axis_role(column) || numbers) continue;
    const ChoiceEffect effect = choice_effect(study, limits, column, {column});
    if (effect.rows.empty() || effect.largest > tolerance) continue;
    Clause one{.form = "matters", .measure = limits.words.measure, .choice = column};
    one.value = 100 * effect.typical;
    one.high = 100 * effect.largest;
    one.unit = "%";
    one.status = "does not matter";
    out.push_back({fmt::format("{} moves it by at most {}, all else the same.", capitalised(spoken(column)),
                               percent(effect.largest)),
                   {one}});
  }
  return out;
}

}  // namespace ricochet::answers
