#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "runners/asks/bounds.hpp"
#include "runners/asks/lines.hpp"
#include "runners/asks/verbs.hpp"
#include "runners/json/json_text.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/text.hpp"

namespace ricochet::asks {
namespace {

/// What is asked of the measure.
struct Condition {
  std::optional<double> is, below, above;
  bool passes = false;  // asked where it is a value that it passes: what is no count is that on no level
  bool holds(double value) const {
    return passes ? value > *is : is ? value == *is : below ? value < *below : value > *above;
  }
  Bounds bounds() const { return {below, passes ? is : above}; }
  /// "is always below 3 N".
  std::string text(const Lines& lines, const std::string& adverb = "") const {
    return (is_plural(lines.words.words) ? "are " : "is ") + adverb +
           (passes && adverb.empty() ? lines.given(*is)
            : passes                 ? "above " + lines.given(*is)
            : is                     ? lines.given(*is)
            : below                  ? "below " + lines.given(*below)
                                     : "above " + lines.given(*above));
  }
};

/// Whether all its values are the one that is asked for.
bool equals(const Line& line, const Condition& condition) {
  if (!condition.is || !line.known()) return false;
  for (const auto& [size, by_seed] : line.point.values)
    for (const auto& [seed, value] : by_seed)
      if (value != *condition.is) return false;
  return true;
}

/// Yes or no where every case on every step and mesh says so; of what is no count as limits tell it.
Verdict state(const Line& line, const Condition& condition, bool counts) {
  if (!line.known()) return Verdict::open;
  std::size_t holds = 0, all = 0;
  for (const auto& [size, by_seed] : line.point.values)
    for (const auto& [seed, value] : by_seed) {
      holds += condition.holds(value) ? 1 : 0;
      ++all;
    }
  const Estimate& one = line.estimate();
  if (!one.unknown().empty() || one.grows) return Verdict::open;
  if (one.beyond && condition.is && !condition.passes) return one.value > *condition.is ? Verdict::no : Verdict::open;
  // What equals a value does not pass it, however wide its interval is.
  if (condition.passes && equals(line, condition)) return Verdict::no;
  if (counts || (condition.is && !condition.passes))
    return holds == all ? Verdict::yes : holds == 0 ? Verdict::no : Verdict::open;
  return kept(line, condition.bounds()).verdict;
}

/// One series along the axis: all else the same.
struct Series {
  std::string level, stop;
  std::vector<std::pair<double, const Line*>> points;  // ascending
  std::vector<Verdict> states;
  /// Where it changes: between which values, in their order.
  std::vector<std::pair<double, double>> between = {};
  bool becomes = true;    // from no to yes as the axis grows, at the first of these
  std::string what = {};  // of one without a threshold: "always", "never", "not told"; "always below" of a value
  std::optional<bool> holds = {};  // what is asked, where no level says otherwise
  std::size_t open = 0;            // of a threshold: levels outside of where it changes that are open

  bool known() const {
    return std::any_of(points.begin(), points.end(), [](const auto& one) { return one.second->known(); });
  }
};

std::string in_all(std::size_t series) {
  return ", in " + all_text(series);
}

void find_change(Series& series, const Condition& condition) {
  std::vector<std::size_t> firm;
  for (std::size_t k = 0; k < series.states.size(); ++k)
    if (series.states[k] != Verdict::open) firm.push_back(k);
  if (firm.empty()) {
    series.what = "not told";
    return;
  }
  for (std::size_t k = 1; k < firm.size(); ++k)
    if (series.states[firm[k]] != series.states[firm[k - 1]])
      series.between.emplace_back(series.points[firm[k - 1]].first, series.points[firm[k]].first);
  series.becomes = series.states[firm.front()] == Verdict::no;
  for (std::size_t k = 0; k < series.states.size() && !series.between.empty(); ++k) {
    const auto inside = [&](const auto& one) {
      return one.first < series.points[k].first && series.points[k].first < one.second;
    };
    if (series.states[k] == Verdict::open && series.points[k].second->applies() &&
        std::none_of(series.between.begin(), series.between.end(), inside))
      ++series.open;
  }
  if (!series.between.empty()) return;
  const bool all = firm.size() == series.states.size();
  if (!all) {
    series.what = "not told";
    return;
  }
  series.holds = series.states[firm.front()] == Verdict::yes;
  if (!condition.passes) {
    series.what = *series.holds ? "always" : "never";
    return;
  }
  std::size_t equal = 0;
  for (const auto& [x, line] : series.points) equal += equals(*line, condition) ? 1 : 0;
  series.what = *series.holds                   ? "always above"
                : equal == 0                    ? "always below"
                : equal == series.points.size() ? "always equal to"
                                                : "never above";
}

class Threshold {
 public:
  Threshold(const Ask& ask, const Evidence& evidence) : study_(evidence.study()), along_(ask.text("along")) {
    condition_ = {ask.real("is"), ask.real("below"), ask.real("above")};
    const Cases cases = evidence.cases(ask);
    std::vector<std::string> columns = evidence.choices(cases, ask.subject(), {along_}), others = columns;
    columns.push_back(along_);
    lines_ = lines_of(ask, evidence, ask.subject(), columns, true);
    unit_ = evidence.study().unit_of(along_);
    axis_words_ = evidence.study().spoken(along_);
    bool counts = true;
    for (const Line& line : lines_.all)
      for (const auto& [size, by_seed] : line.point.values)
        for (const auto& [seed, value] : by_seed) counts = counts && std::floor(value) == value;
    condition_.passes = condition_.is && !counts;
    InOrderMet<std::string, Series> all;
    for (const Line& line : lines_.all) {
      Series& series = all[evidence.key(line.point.first(), others) + '\n' + line.stop];
      series.level = evidence.level(line.point.first(), others);
      series.stop = line.stop;
      if (const auto x = number_in(evidence.study().text(line.point.first(), along_)))
        series.points.emplace_back(*x, &line);
    }
    for (auto& [key, series] : std::move(all).list()) {
      std::stable_sort(series.points.begin(), series.points.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
      for (const auto& [x, line] : series.points) series.states.push_back(state(*line, condition_, counts));
      find_change(series, condition_);
      series_.push_back(std::move(series));
    }
  }

  Answered answer() const {
    Answered out = begin_answer(lines_);
    out.figure = figure();
    if (auto open = without_values(lines_, out)) return *open;
    for (const Series& series : series_) add_rows(out, series);
    // Of a series without any value what is left out says all.
    std::vector<const Series*> with, not_monotone, without;
    for (const Series& series : series_)
      if (series.known())
        (series.between.empty() ? without : series.between.size() == 1 ? with : not_monotone).push_back(&series);
    const std::size_t judged = with.size() + not_monotone.size() + without.size();
    const std::string what = condition_.text(lines_);
    const auto place = [&](const Series& one) {
      return (one.level.empty() || judged == 1 ? "" : " with " + one.level) +
             (one.stop.empty() ? "" : " at " + one.stop);
    };
    if (!not_monotone.empty()) {
      out.passes = Verdict::no;
      out.verdict = "not monotone";
      const Series& first = *not_monotone.front();
      const std::string where =
          place(first) + (not_monotone.size() < judged ? fmt::format(" ({} of {})", not_monotone.size(), judged) : "");
      out.sentence = in_thirty_words(fmt::format("Not monotone: {} {}", lines_.words.words, ranges(first, what)),
                                     {{where, fmt::format(" ({} of {})", not_monotone.size(), judged)}});
      return out;
    }
    if (with.empty()) return say_unchanged(out, without, what, place);
    double low = with.front()->between.front().first, high = with.front()->between.front().second;
    // Thresholds differ where one bracket ends before another begins, or one turns the other way.
    double first_end = high, last_begin = low;
    bool differ = false;
    for (const Series* one : with) {
      differ = differ || one->becomes != with.front()->becomes;
      const auto& [begin, end] = one->between.front();
      low = std::min(low, begin);
      high = std::max(high, end);
      last_begin = std::max(last_begin, begin);
      first_end = std::min(first_end, end);
    }
    differ = differ || first_end <= last_begin;
    std::size_t open = 0, levels = 0;
    for (const Series* one : with) {
      open += one->open;
      levels += one->points.size();
    }
    out.passes = without.empty() && open == 0 ? Verdict::yes : Verdict::open;
    out.verdict = without.empty() && open == 0 ? "told" : "in part";
    if (open > 0) out.reason = fmt::format("open at {} of {} levels", open, levels);
    const Series& first = *with.front();
    std::vector<std::vector<std::string>> rest;
    if (open > 0) rest.push_back({"; " + out.reason});
    if (!without.empty()) rest.push_back({unchanged(without, judged, place), unchanged(without, judged, nullptr)});
    if (!differ && with.size() > 1 && without.empty()) rest.push_back({in_all(with.size())});
    if (differ)
      rest.push_back({fmt::format("; levels differ: {} and {}{}", x_text(first.between.front().first),
                                  x_text(first.between.front().second), place(first)),
                      "; levels differ"});
    const std::string there =
        condition_.passes ? passing(with, condition_) : std::string(first.becomes ? "from" : "up to") + " there";
    out.sentence = in_thirty_words(
        fmt::format("Between {} and {}: {} {} {}", x_text(low), x_text(high), lines_.words.words, what, there), rest);
    return out;
  }

 private:
  /// "is above 2 m in one range of the pulsation, from 0.8–0.85 to 1.1–1.15 rad/s": each end lies between two values.
  std::string ranges(const Series& of, const std::string& what) const {
    constexpr std::size_t both_ends = 2;
    if (of.between.size() > both_ends) return what + " in several ranges of " + axis_words();
    const auto& [first, begin] = of.between.front();
    const auto& [end, last] = of.between.back();
    return fmt::format("{} in one range of {}, from {}–{} to {}–{}",
                       of.becomes ? what : condition_.text(lines_, "not "), axis_words(), number_text(first),
                       number_text(begin), number_text(end), x_text(last));
  }

  /// "; always with penalty; not told with 3 of 6": what those without a threshold are.
  static std::string unchanged(const std::vector<const Series*>& without, std::size_t judged,
                               const std::function<std::string(const Series&)>& place) {
    std::string text;
    InOrderMet<std::string, bool> kinds;
    for (const Series* one : without) kinds[one->what] = true;
    for (const auto& [what, yes] : kinds.list()) {
      const Series* first = nullptr;
      std::size_t count = 0;
      for (const Series* one : without)
        if (one->what == what) first = count++ == 0 ? one : first;
      if (count == 0) continue;
      const std::string where = count == 1 && place ? place(*first) : "";
      text += fmt::format("; {}{}", what, where.empty() ? fmt::format(" with {} of {}", count, judged) : where);
    }
    return text;
  }

  /// What it is on both sides of a value that it passes: "there, and larger beyond"; of one that it keeps on a side,
  /// "from there, and larger before".
  static std::string passing(const std::vector<const Series*>& with, const Condition& condition) {
    const bool grows = with.front()->becomes;
    const bool kept = std::all_of(with.begin(), with.end(), [&](const Series* one) {
      for (std::size_t k = 0; k < one->points.size(); ++k)
        if (one->states[k] == Verdict::no && !equals(*one->points[k].second, condition)) return false;
      return true;
    });
    if (kept) return grows ? "up to there, and larger beyond" : "from there, and larger before";
    return grows ? "there, and larger beyond" : "there, and smaller beyond";
  }

  /// Why a level is open.
  std::string why_not(const Line& line) const {
    if (!line.known()) return line.point.none;
    if (condition_.is && !condition_.passes)
      return line.estimate().unknown().empty() ? "steps and meshes disagree" : line.estimate().unknown();
    return why_open(line, condition_.bounds());
  }

  /// Of series that see no change.
  Answered say_unchanged(Answered out, const std::vector<const Series*>& without, const std::string& what,
                         const std::function<std::string(const Series&)>& place) const {
    std::vector<const Series*> always, never, open;
    for (const Series* one : without) (one->holds ? (*one->holds ? always : never) : open).push_back(one);
    if (always.empty() && never.empty()) {
      out.verdict = word(Verdict::open);
      for (std::size_t k = 0; k < open.front()->points.size(); ++k)
        if (const Line& line = *open.front()->points[k].second;
            out.reason.empty() && open.front()->states[k] == Verdict::open)
          out.reason = why_not(line);
      out.sentence = fmt::format("Open: where along {} {} {} is not told: {}.", axis_words(), lines_.words.words, what,
                                 out.reason);
      return out;
    }
    const auto some = [&](const std::vector<const Series*>& list, const std::string& than) {
      const std::string side = common(list) + than;
      return list.size() == 1 ? fmt::format("{}{}", side, place(*list.front()))
                              : fmt::format("{} with {} of {}", side, list.size(), without.size());
    };
    if (!always.empty() && !never.empty()) {
      out.verdict = word(Verdict::open);
      out.reason = "levels differ, none changes along the axis";
      // Of a value that it might pass: "is always above 200 N with 9e4 N/m, always below it with 1e4 N/m".
      const std::string told = condition_.passes
                                   ? fmt::format("{} {}, {}", is_plural(lines_.words.words) ? "are" : "is",
                                                 some(always, " " + lines_.given(*condition_.is)), some(never, " it"))
                                   : fmt::format("{} {}, {}", what, some(always, ""), some(never, ""));
      out.sentence = in_thirty_words(fmt::format("No change along {}: {} {}", axis_words(), lines_.words.words, told),
                                     {{open.empty() ? "" : fmt::format("; open with {}", open.size())}});
      return out;
    }
    const std::string which = common(always.empty() ? never : always);
    const Series& first = *without.front();
    out.verdict = open.empty() ? (condition_.passes ? "never" : which) : "in part";
    const std::size_t all = without.size() - open.size();
    out.sentence =
        in_thirty_words(fmt::format("{} {}, from {} to {}", answers::capitalised(lines_.words.words), which_text(which),
                                    x_text(first.points.front().first), x_text(first.points.back().first)),
                        {{open.empty() && all > 1 ? in_all(all)
                          : open.empty()          ? ""
                                         : fmt::format(", with {} of {}; open with the others", all, without.size())}});
    return out;
  }

  /// What these are in common: of a value that they might pass "never above" where some equal it and some do not.
  static std::string common(const std::vector<const Series*>& list) {
    const bool alike =
        std::all_of(list.begin(), list.end(), [&](const Series* one) { return one->what == list.front()->what; });
    return alike ? list.front()->what : "never above";
  }

  /// "is never below 3 N"; of a value that it might pass the side on which it stays, "is always above 3 N".
  std::string which_text(const std::string& which) const {
    if (!condition_.passes) return condition_.text(lines_, which + " ");
    return fmt::format("{} {} {}", is_plural(lines_.words.words) ? "are" : "is", which, lines_.given(*condition_.is));
  }

  std::string number_text(double x) const { return study_.number_words(along_, x); }
  std::string x_text(double x) const {
    const std::string number = number_text(x);
    if (!unit_.empty()) return number + " " + unit_;
    return is_refinement(along_) ? number + " " + along_ : number;
  }
  const std::string& axis_words() const { return axis_words_; }

  void add_rows(Answered& out, const Series& series) const {
    for (std::size_t k = 0; k < series.points.size(); ++k) {
      VerdictRow row = lines_.row(*series.points[k].second);
      const Line& line = *series.points[k].second;
      row.verdict = !condition_.passes || series.states[k] == Verdict::open ? word(series.states[k])
                    : series.states[k] == Verdict::yes                      ? "above"
                    : equals(line, condition_)                              ? "equal"
                                                                            : "below";
      if (series.states[k] == Verdict::open && row.reason.empty()) row.reason = why_not(line);
      if (series.states[k] == Verdict::no && row.reason.empty() && !condition_.is)
        row.reason = beyond_text(kept(line, condition_.bounds()));
      out.rows.push_back(std::move(row));
    }
    VerdictRow row;
    row.measure = along_;
    row.level = series.level;
    row.stop = series.stop;
    row.unit = unit_;
    row.verdict = series.between.empty() ? series.what : series.between.size() == 1 ? "threshold" : "not monotone";
    if (series.between.empty()) out.rows.push_back(row);
    for (const auto& [low, high] : series.between) {
      row.low = low;
      row.high = high;
      out.rows.push_back(row);
    }
  }

  Json figure() const {
    Json rows = Json::array();
    for (const Series& series : series_)
      for (const auto& [x, line] : series.points) {
        const VerdictRow row = lines_.row(*line);
        Json point = {{"series", series.level + (series.stop.empty() ? "" : " " + series.stop)}, {"x", x}};
        if (row.value) point["value"] = *row.value;
        if (row.low) point["low"] = *row.low, point["high"] = *row.high;
        rows.push_back(std::move(point));
      }
    std::vector<double> at;
    for (const auto& bound : {condition_.is, condition_.below, condition_.above})
      if (bound) at.push_back(*bound * lines_.words.factor);
    Json between = Json::array();
    for (const Series& series : series_)
      for (const auto& [low, high] : series.between) between.push_back({low, high});
    return {{"form", "along"},
            {"measure", lines_.words.words},
            {"unit", lines_.words.unit},
            {"along", axis_words()},
            {"along_unit", unit_},
            {"rows", rows},
            {"at", at},
            {"between", between}};
  }

  const Choices& study_;
  std::string along_, unit_, axis_words_;
  Condition condition_;
  Lines lines_;
  std::vector<Series> series_;
};

void check_threshold(const Ask& ask, const Study& study) {
  check_subject(ask, study);
  const std::string along = ask.text("along");
  check_choice(ask, study, "along", along);
  refuse_seeds(ask, "along", "have no order", ask.subject());
  for (const StudyCase& one : study.cases)
    for (const auto& [axis, value] : one.axes)
      if (axis == along && !value.is_number())
        throw InputError(ask.pointer("along"), quote(along) + " has words as levels; a threshold lies between numbers");
  const int given = (ask.has("is") ? 1 : 0) + (ask.has("below") ? 1 : 0) + (ask.has("above") ? 1 : 0);
  if (given != 1)
    throw InputError(ask.pointer(), fmt::format("a threshold needs one of \"is\", \"below\" and \"above\"{}",
                                                given > 1 ? ", not several" : ""));
}

}  // namespace

const Verb& threshold_verb() {
  static const Verb verb{
      "threshold",
      "From which value of an axis on a measure is, is below or is above a value.",
      {keys::of_form(Field::Form::text, "threshold", std::nullopt, "The measure."),
       keys::of_form(Field::Form::text, "along", std::nullopt, "The axis, whose levels are numbers."),
       keys::quiet(keys::optional(keys::real("is", "", keys::any, std::nullopt, "It is this value."))),
       keys::quiet(keys::optional(keys::real("below", "", keys::any, std::nullopt, "It is below this value."))),
       keys::quiet(keys::optional(keys::real("above", "", keys::any, std::nullopt, "It is above this value.")))},
      "",
      check_threshold,
      doubt_of_values,
      [](const Ask& ask, const Evidence& evidence) { return Threshold(ask, evidence).answer(); }};
  return verb;
}

}  // namespace ricochet::asks
