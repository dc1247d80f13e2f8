#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

using namespace answers;

namespace {

std::string time_words(double seconds) {
  constexpr double thousand = 1e3, micro = 1e6;
  if (seconds >= 1) return short_number(seconds, 2) + " s";
  return seconds >= 1 / thousand ? short_number(thousand * seconds, 2) + " ms"
                                 : short_number(micro * seconds, 2) + " µs";
}

/// The accuracies that a question names, as shares: "a millionth", "0.01 %".
std::vector<double> accuracies_in(const std::string& question) {
  constexpr std::pair<const char*, double> words[] = {{"hundredth", 1e-2},         {"ten-thousandth", 1e-4},
                                                      {"thousandth", 1e-3},        {"millionth", 1e-6},
                                                      {"hundred-millionth", 1e-8}, {"billionth", 1e-9}};
  std::vector<double> out;
  for (const auto& [word, share] : words)
    for (std::size_t at = question.find(word); at != std::string::npos; at = question.find(word, at + 1))
      if (at > 0 && question[at - 1] == ' ') out.push_back(share);
  for (std::size_t at = question.find('%'); at != std::string::npos; at = question.find('%', at + 1)) {
    std::size_t from = at;
    while (from > 0 && std::string("0123456789.e- ").find(question[from - 1]) != std::string::npos) --from;
    std::string number = question.substr(from, at - from);
    std::erase(number, ' ');
    if (const auto value = number_in(number); value && *value > 0) out.push_back(*value / 100);
  }
  return out;
}

/// The cheapest case of one method for an accuracy.
struct Entry {
  const CaseRecord* record = nullptr;
  double seconds = 0, low = 0, high = 0;
};

struct Accuracy {
  double share = 0;
  std::vector<Entry> entries;  ///< the cheapest first
  Members tied;                ///< of `methods`: those not told apart from the cheapest
};

/// A compared choice, or the way of marching where that varies; "" where there is neither.
std::string compared_choice(const Compared& study) {
  const std::string choice = !study.asked().empty() && study.asked() != "all" ? study.asked()
                             : study.varies("march")                          ? "march"
                                                                              : "";
  return choice.empty() || !study.varies(choice) ? "" : choice;
}

class PrecisionSpeaker {
 public:
  PrecisionSpeaker(const Compared& study, std::string error) : study_(study), error_(std::move(error)) {
    InOrderMet<std::string, Cases> methods;
    for (const CaseRecord& record : study.results().cases)
      if (share(record)) methods[study.key(record)].push_back(&record);
    for (const auto& [key, cases] : methods.list()) methods_.push_back(cases);
  }
  void say(Answer& answer) const;

 private:
  /// The error over what a motion at rest would err by, its floor at least.
  std::optional<double> share(const CaseRecord& record) const {
    const auto value = measure(record, "error." + error_), size = measure(record, "size." + error_);
    if (record.status != "done" || !value || !size || !(*size > 0)) return std::nullopt;
    return std::max(*value, measure(record, "floor." + error_).value_or(0)) / *size;
  }
  std::optional<Accuracy> cheapest(double accuracy) const;
  Sentence sentence(const std::vector<Accuracy>& same) const;
  /// "; with every step 25 ms at least": the cheapest of each other level of a compared choice.
  void say_levels(const Accuracy& accuracy, Sentence& out) const;
  void say_never(Answer& answer) const;
  /// An accuracy that the question names and nobody reaches.
  void say_unreached(Answer& answer) const;

  const Compared& study_;
  std::string error_;
  std::vector<Cases> methods_;
};

std::optional<Accuracy> PrecisionSpeaker::cheapest(double accuracy) const {
  Accuracy out{accuracy, {}, {}};
  std::vector<std::pair<Entry, std::size_t>> best;
  for (std::size_t k = 0; k < methods_.size(); ++k) {
    Entry entry;
    for (const CaseRecord* record : methods_[k]) {
      const auto seconds = measure(*record, "timed_seconds");
      if (*share(*record) > accuracy || !seconds || (entry.record && entry.seconds <= *seconds)) continue;
      entry = {record, *seconds, measure(*record, "timed_low").value_or(*seconds),
               measure(*record, "timed_high").value_or(*seconds)};
    }
    if (entry.record) best.emplace_back(entry, k);
  }
  if (best.empty()) return std::nullopt;
  std::stable_sort(best.begin(), best.end(),
                   [](const auto& a, const auto& b) { return a.first.seconds < b.first.seconds; });
  for (const auto& [entry, k] : best) {
    out.entries.push_back(entry);
    if (out.tied.empty() || entry.low <= best.front().first.high) out.tied.push_back(k);
  }
  return out;
}

Sentence PrecisionSpeaker::sentence(const std::vector<Accuracy>& same) const {
  const Accuracy& finest = same.back();
  const Entry& first = finest.entries.front();
  std::vector<std::string> shares;
  for (const Accuracy& one : same) shares.push_back(short_number(100 * one.share, 2));
  std::string for_what =
      (shares.size() > 2 ? shares.front() + " to " + shares.back() : and_list(shares)) + " % of the motion";
  std::string at = study_.varies("step") && study_.step(*first.record)
                       ? " at " + study_.step_words(*study_.step(*first.record))
                       : "";
  std::string text =
      fmt::format("For {}: {}{}, {}", for_what, study_.name(*first.record), at, time_words(first.seconds));
  constexpr std::size_t few = 3;
  if (finest.tied.size() > 1) {
    Members others(finest.tied.begin() + 1, finest.tied.end());
    Cases firsts;
    for (const Cases& cases : methods_) firsts.push_back(cases.front());
    const SetNames names(study_, firsts);
    text += others.size() <= few ? fmt::format("; {} cost{} the same within the timing noise", names.of(others),
                                               others.size() == 1 ? "s" : "")
                                 : fmt::format("; within the timing noise of {}", names.of(others));
  } else if (finest.entries.size() > 1 &&
             (compared_choice(study_).empty() || study_.text(*finest.entries[1].record, compared_choice(study_)) ==
                                                     study_.text(*first.record, compared_choice(study_)))) {
    const Entry& next = finest.entries[1];
    text += fmt::format("; next {}, {}", study_.name(*next.record), time_words(next.seconds));
  }
  Clause clause{
      .form = "cheapest", .measure = "error." + error_, .who = study_.name(*first.record), .methods = first.record->id};
  clause.value = first.seconds;
  clause.low = first.low;
  clause.high = first.high;
  clause.uncertainty = finest.share;
  clause.unit = "s";
  clause.status = finest.tied.size() > 1 ? "tie" : "alone";
  clause.at_step = study_.step(*first.record);
  clause.at_mesh = study_.elements(*first.record);
  Sentence out{text, {clause}};
  say_levels(finest, out);
  out.text += ".";
  return out;
}

void PrecisionSpeaker::say_levels(const Accuracy& accuracy, Sentence& out) const {
  const std::string choice = compared_choice(study_);
  if (choice.empty()) return;
  const std::string own = study_.text(*accuracy.entries.front().record, choice);
  InOrderMet<std::string, const Entry*> levels;
  for (const Entry& entry : accuracy.entries)
    if (const std::string level = study_.text(*entry.record, choice); level != own && !levels.holds(level))
      levels[level] = &entry;
  constexpr std::size_t few = 2;
  if (levels.list().size() > few) return;
  for (const auto& [level, entry] : levels.list()) {
    const std::string who = study_.value_words(choice, level);
    out.text += fmt::format("; with {} {} at least", who, time_words(entry->seconds));
    Clause clause{.form = "cheapest", .measure = "error." + error_, .choice = choice, .who = who};
    clause.methods = entry->record->id;
    clause.value = entry->seconds;
    clause.low = entry->low;
    clause.high = entry->high;
    clause.uncertainty = accuracy.share;
    clause.unit = "s";
    clause.status = "level";
    out.clauses.push_back(std::move(clause));
  }
}

void PrecisionSpeaker::say_unreached(Answer& answer) const {
  const CaseRecord* best = nullptr;
  for (const Cases& cases : methods_)
    for (const CaseRecord* record : cases)
      if (!best || *share(*record) < *share(*best)) best = record;
  constexpr double coarsest = 0.1;
  std::vector<double> asked = accuracies_in(study_.results().question);
  asked.push_back(coarsest);
  for (const double named : asked) {
    if (!best || *share(*best) <= named) continue;
    Clause clause{.form = "cheapest", .measure = "error." + error_, .who = study_.name(*best), .methods = best->id};
    clause.value = 100 * *share(*best);
    clause.unit = "%";
    clause.status = "not reached";
    clause.at_step = study_.step(*best);
    answer.say({fmt::format("For {} of the motion: none; the best is {}{}, {}.", percent(named), clause.who,
                            clause.at_step ? " at " + study_.step_words(*clause.at_step) : "", percent(*share(*best))),
                {clause}});
    return;
  }
}

void PrecisionSpeaker::say_never(Answer& answer) const {
  constexpr double wanted = 0.01;
  Cases firsts;
  Members never;
  std::optional<double> least;
  for (std::size_t k = 0; k < methods_.size(); ++k) {
    firsts.push_back(methods_[k].front());
    double best = INFINITY;
    for (const CaseRecord* record : methods_[k]) best = std::min(best, *share(*record));
    if (best > wanted) never.push_back(k), least = std::min(least.value_or(best), best);
  }
  if (never.empty() || never.size() == methods_.size()) return;
  const SetNames names(study_, firsts);
  Clause clause{.form = "cheapest", .measure = "error." + error_, .who = names.of(never)};
  clause.value = 100 * *least;
  clause.unit = "%";
  clause.status = "never";
  const std::string count = fmt::format("{} of {} methods", never.size(), methods_.size());
  const std::string who = clause.who.starts_with(count) ? clause.who.substr(count.size()) : ", " + clause.who;
  answer.say({fmt::format("Never to 1 %: {}{} (the best {}).", count, who, percent(*least)), {clause}});
}

void PrecisionSpeaker::say(Answer& answer) const {
  if (methods_.empty()) return;
  std::vector<std::vector<Accuracy>> told;
  constexpr int finest = 12;
  std::vector<double> shares = accuracies_in(study_.results().question);
  for (int k = 1; k <= finest; ++k) {
    const double share = std::pow(10, -k);
    if (std::none_of(shares.begin(), shares.end(), [&](double one) { return std::abs(one / share - 1) < 0.1; }))
      shares.push_back(share);
  }
  std::sort(shares.begin(), shares.end(), std::greater<>());
  for (const double share : shares) {
    const auto one = cheapest(share);
    if (!one) break;
    if (!told.empty() && told.back().back().entries.front().record == one->entries.front().record)
      told.back().push_back(*one);
    else
      told.push_back({*one});
  }
  // Three at most: those that the question names, the finest, then those of 1 % and 0.1 %.
  std::reverse(told.begin(), told.end());
  constexpr std::size_t most = 3;
  const auto covers = [](const std::vector<Accuracy>& group, double share) {
    return std::any_of(group.begin(), group.end(),
                       [&](const Accuracy& one) { return std::abs(one.share / share - 1) < 0.1; });
  };
  std::vector<double> wanted = accuracies_in(study_.results().question);
  if (!told.empty()) wanted.push_back(told.front().back().share);
  wanted.insert(wanted.end(), {1e-2, 1e-3});
  std::vector<std::size_t> kept;
  for (const double share : wanted)
    for (std::size_t k = 0; k < told.size(); ++k)
      if (kept.size() < most && covers(told[k], share) && std::find(kept.begin(), kept.end(), k) == kept.end())
        kept.push_back(k);
  // What the question names is told first.
  const std::vector<double> named = accuracies_in(study_.results().question);
  const auto first = [&](std::size_t k) {
    return std::any_of(named.begin(), named.end(), [&](double share) { return covers(told[k], share); });
  };
  std::stable_sort(kept.begin(), kept.end(),
                   [&](std::size_t a, std::size_t b) { return first(a) != first(b) ? first(a) : a < b; });
  say_unreached(answer);
  for (const std::size_t k : kept) answer.say(sentence(told[k]));
  say_never(answer);
}

/// "Flights cost 0.22 of the time of every step (median of 44 pairs, 0.03 to 1.7)". The factor is that of a compared
/// choice, or of the way of marching where that varies.
void say_factor(const Compared& study, Answer& answer) {
  const std::string choice = compared_choice(study);
  if (choice.empty()) return;
  std::vector<std::string> others;
  for (const std::string& column : study.columns())
    if (column != choice) others.push_back(column);
  InOrderMet<std::string, std::vector<std::pair<std::string, double>>> pairs;
  InOrderMet<std::string, bool> levels;
  for (const CaseRecord& record : study.results().cases) {
    const auto seconds = measure(record, "timed_seconds");
    levels[study.text(record, choice)] = true;
    if (record.status != "done" || !seconds || !(*seconds > 0)) continue;
    std::string key = study.key(record, others);
    for (const char* size : {"step", "elements"}) key += study.text(record, size) + '\x1f';
    pairs[key].emplace_back(study.text(record, choice), *seconds);
  }
  if (levels.list().size() != 2) return;
  // The level that is not the first, against the first; flights against every step.
  std::string one = levels.list()[1].first, base = levels.list()[0].first;
  if (base == "flights") std::swap(one, base);
  std::vector<double> factors;
  for (const auto& [key, both] : pairs.list()) {
    std::optional<double> a, b;
    for (const auto& [level, seconds] : both) (level == one ? a : b) = seconds;
    if (a && b) factors.push_back(*a / *b);
  }
  if (factors.empty()) return;
  const auto [least, most] = std::minmax_element(factors.begin(), factors.end());
  Clause clause{
      .form = "cheapest", .measure = "timed_seconds", .choice = choice, .who = study.value_words(choice, one)};
  clause.value = median(factors);
  clause.low = *least;
  clause.high = *most;
  clause.unit = "1";
  clause.status = "factor";
  answer.say({fmt::format("With {} a run takes {} of the time of {} (median of {} pairs, {} to {}).", clause.who,
                          short_number(*clause.value, 2), study.value_words(choice, base), factors.size(),
                          short_number(*least, 2), short_number(*most, 2)),
              {clause}});
}

}  // namespace

answers::Answer precision_answer(const Compared& study) {
  Answer answer;
  const std::vector<std::string> errors = errors_of(study.results());
  const bool largest = std::find(errors.begin(), errors.end(), "tip-linf") != errors.end();
  const std::string error = largest || errors.empty() ? "tip-linf" : errors.front();
  PrecisionSpeaker(study, error).say(answer);
  if (answer.sentences.empty())
    answer.say("No case has an error to speak of.", Clause{.form = "status", .status = "none"});
  say_factor(study, answer);
  // Against the same mesh and mass, exact in time: what these err by themselves does not show.
  const auto& cases = study.results().cases;
  const bool semi_discrete = std::any_of(cases.begin(), cases.end(), [](const CaseRecord& record) {
    return record.status == "done" && measure(record, "reference_of_mesh").value_or(0) > 0;
  });
  if (semi_discrete && answer.sentences.size() < sentences_at_most)
    answer.say("Errors are against the same mesh and mass: the error of the mesh is not in them.",
               Clause{.form = "status", .measure = "error." + error, .status = "same mesh"});
  answer.keep(sentences_at_most);
  for (Sentence& one : ended(study)) answer.say(std::move(one));
  return answer;
}

}  // namespace ricochet
