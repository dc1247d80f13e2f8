// The verb `motions` of a sweep: which motions there are along the parameter, where they change, what is undecided.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/asks/kind_verbs.hpp"
#include "runners/json/json_text.hpp"
#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/kinds/sweep/motion_asks.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/quantity.hpp"

namespace ricochet {
namespace {

constexpr double much_open = 0.25;  // share of the range that is told first

/// Motions and how many attractors each has.
using AttractorCounts = std::map<std::string, std::size_t>;

/// "two of period 1 and no contact"; "" of none.
std::string attractors_text(const AttractorCounts& counts) {
  std::vector<std::string> words;
  for (const auto& [motion, count] : counts) {
    static const char* const spoken[] = {"", "", "two of ", "three of ", "four of "};
    words.push_back((count < std::size(spoken) ? spoken[count] : std::to_string(count) + " of ") + motion);
  }
  return answers::and_list(words);
}

/// Whether all of these motions are among those.
bool holds(const AttractorCounts& those, const AttractorCounts& these) {
  return std::all_of(these.begin(), these.end(), [&](const auto& one) {
    const auto found = those.find(one.first);
    return found != those.end() && found->second >= one.second;
  });
}

/// What one case shows at one value: the motions of its starts.
struct ValueMotions {
  std::set<std::pair<std::string, int>> motions = {};  ///< each attractor once
  std::size_t decided = 0, open = 0;                   ///< starts
  std::size_t ended = 0;                               ///< of the open: refused, diverged or failed
  std::string word = {};                               ///< one of the motions as orbits.csv has it

  double open_share() const { return static_cast<double>(open) / static_cast<double>(open + decided); }
  AttractorCounts counts() const {
    AttractorCounts out;
    for (const auto& [motion, attractor] : motions) ++out[motion];
    return out;
  }
};

/// Neighbouring values whose motions may be one set: where starts are undecided, what they hide is not known. Values at
/// which none is decided stand apart.
struct MotionStretch {
  double from = 0, to = 0;
  AttractorCounts counts = {};        ///< of all of its values
  std::size_t decided = 0, open = 0;  ///< orbits
  std::size_t ended = 0;              ///< of the open: refused, diverged or failed
  bool whole = false;                 ///< every start of one of its values is decided
  std::string word = {};              ///< one of the motions as orbits.csv has it

  std::string motion() const { return attractors_text(counts); }
  /// Whether every start was refused, diverged or failed.
  bool none() const { return counts.empty() && ended == open; }
  bool takes(const ValueMotions& next) const {
    const AttractorCounts shown = next.counts();
    return shown.empty() == counts.empty() && (holds(counts, shown) || (!whole && holds(shown, counts))) &&
           (next.open > 0 || holds(shown, counts));
  }
  void add(double value, const ValueMotions& next) {
    to = value;
    for (const auto& [one, count] : next.counts()) counts[one] = std::max(counts[one], count);
    decided += next.decided;
    open += next.open;
    ended += next.ended;
    if (!next.word.empty()) word = next.word;
    whole = whole || next.open == 0;
  }
  /// The group of motions by which it is drawn.
  report::RegimeGroup group() const {
    if (none()) return {"no orbit", report::regime_groups[report::failed_group].colour};
    if (counts.empty()) return report::regime_groups[report::undecided_group];
    if (counts.size() > 1 || counts.begin()->second > 1) return {"several motions", "#7FBF3F"};
    return report::regime_groups[report::regime_group(word, std::nullopt)];
  }
};

/// Between the last value of one set of motions and the first of the next.
struct MotionChange {
  double low = 0, high = 0;
  std::string from, to;
  bool open_between = false;  ///< undecided values lie there
};

struct CaseMotions {
  const CaseRecord* record = nullptr;
  std::string level;
  std::map<double, ValueMotions> at = {};
  std::vector<asks::WordAtPlace> orbits = {};
  std::vector<MotionStretch> stretches = {};
  std::vector<MotionChange> changes = {};
  double undecided = 0;  ///< share of the range
};

/// Of each value the part of the range that is nearest to it.
std::map<double, double> widths_of(const std::set<double>& values) {
  std::map<double, double> out;
  if (values.empty()) return out;
  const double range = *values.rbegin() - *values.begin();
  for (auto one = values.begin(); one != values.end(); ++one) {
    const double before = one == values.begin() ? *one : *std::prev(one),
                 after = std::next(one) == values.end() ? *one : *std::next(one);
    out[*one] = range > 0 ? 0.5 * (after - before) / range : 1;
  }
  return out;
}

class MotionsAlong {
 public:
  MotionsAlong(const asks::Ask& ask, const asks::Evidence& evidence, const SweptMotions& swept)
      : evidence_(evidence),
        study_(evidence.study()),
        cases_(evidence.cases(ask)),
        columns_(evidence.varying(cases_)),
        parameter_(report::swept_parameter(evidence.results())) {
    parameter_.unit = report::shown_unit(parameter_.unit);
    for (std::size_t c = 0; c < swept.records.size(); ++c)
      if (std::find(cases_.begin(), cases_.end(), swept.records[c]) != cases_.end())
        read(*swept.records[c], swept.diagram.cases[c], swept.diagram.starts);
    find_heads();
    judge();
  }

  asks::Answered answer() const {
    asks::Answered out;
    out.cases = told_.size();
    asks::leave_out(out, cases_, told_);
    Json drawn = Json::array();
    add_row(out, "", "undecided", "of the range, over the finest cases", asks::per_cent * undecided_, {}, {}, "%");
    for (const CaseMotions& one : told_) {
      add_row(out, one.level, "undecided", "of the range", asks::per_cent * one.undecided, {}, {}, "%");
      for (const MotionStretch& part : one.stretches) {
        const bool decided = !part.counts.empty();
        const std::string motion = decided ? part.motion() : part.none() ? "no orbit" : "undecided";
        std::string open =
            decided && part.open > part.ended
                ? fmt::format("{} of {} orbits are undecided", part.open - part.ended, part.open + part.decided)
                : "";
        if (part.ended > 0)
          open += fmt::format("{}{} refused or not followed to the end", open.empty() ? "" : ", ", part.ended);
        add_row(out, one.level, motion, open, {}, part.from, part.to, parameter_.unit);
        drawn.push_back({{"name", one.level},
                         {"motion", motion},
                         {"group", part.group().name},
                         {"colour", part.group().colour},
                         {"from", part.from},
                         {"to", part.to}});
      }
      for (const MotionChange& change : one.changes)
        add_row(out, one.level, change.from + " to " + change.to,
                std::string("changes between these") + (change.open_between ? "; undecided values between" : ""), {},
                change.low, change.high, parameter_.unit);
    }
    for (const CaseMotions* one : heads_) out.words.insert(out.words.end(), one->orbits.begin(), one->orbits.end());
    say(out);
    out.figure = {{"form", "ranges"}, {"x", spoken(parameter_.name)}, {"x_unit", parameter_.unit}, {"rows", drawn}};
    return out;
  }

 private:
  static void add_run(ValueMotions& at, const DiagramRun& run) {
    run.decided() ? ++at.decided : ++at.open;
    at.ended += !run.settled && !run.status.empty();
    if (!run.decided()) return;
    at.motions.emplace(motion_words(run.motion), run.attractor);
    at.word = ricochet::text(run.motion);
  }

  void read(const CaseRecord& record, const DiagramCase& of, const std::vector<DiagramStart>& starts) {
    CaseMotions& out = told_.emplace_back();
    out.record = &record;
    out.level = evidence_.level(record, columns_);
    std::map<int, std::map<double, const DiagramRun*>> by_start;
    for (const DiagramRun& run : of.runs) {
      if (!std::isfinite(run.parameter)) continue;
      by_start[run.start][run.parameter] = &run;
      add_run(out.at[run.parameter], run);
      out.orbits.push_back(
          {record.id, out.level,
           fmt::format("{:.10g}{}, start {}", run.parameter, parameter_.unit.empty() ? "" : " " + parameter_.unit,
                       starts[static_cast<std::size_t>(run.start)].name),
           run.decided()                         ? motion_words(run.motion)
           : !run.settled && !run.status.empty() ? run.status
                                                 : "undecided",
           run.decided()});
    }
    // Where the study refined, only starts whose motion changed were marched: others are as on both sides.
    for (auto& [value, at] : out.at)
      for (const auto& [start, runs] : by_start) {
        const auto above = runs.lower_bound(value);
        if (above == runs.end() || above == runs.begin() || above->first == value) continue;
        const DiagramRun &low = *std::prev(above)->second, &high = *above->second;
        if (low.decided() && high.decided() && motion_words(low.motion) == motion_words(high.motion))
          add_run(at, low);
        else
          ++at.open;
      }
    std::set<double> values;
    for (const auto& [value, at] : out.at) values.insert(value);
    for (const auto& [value, width] : widths_of(values)) {
      const ValueMotions& at = out.at[value];
      out.undecided += width * at.open_share();
      if (out.stretches.empty() || !out.stretches.back().takes(at)) out.stretches.push_back({value, value});
      out.stretches.back().add(value, at);
    }
    const MotionStretch* known = nullptr;
    bool open = false;
    for (const MotionStretch& part : out.stretches) {
      if (part.motion().empty()) {
        open = true;
        continue;
      }
      if (known && known->motion() != part.motion())
        out.changes.push_back({known->to, part.from, known->motion(), part.motion(), open});
      known = &part;
      open = false;
    }
  }

  /// The share of the range of which the finest cases leave open what it does, that of the case with most undecided
  /// starts. Those without any orbit tell nothing of the motion.
  void judge() {
    std::vector<const CaseMotions*> followed;
    for (const CaseMotions* one : heads_)
      if (!std::all_of(one->stretches.begin(), one->stretches.end(), [](const auto& part) { return part.none(); }))
        followed.push_back(one);
    lost_ = heads_.size() - followed.size();
    // Where no method has any orbit, that is what is told.
    if (followed.empty()) followed = heads_;
    std::map<double, std::size_t> speak;
    for (const CaseMotions* one : followed)
      for (const auto& [value, at] : one->at) ++speak[value];
    std::size_t most = 0;
    for (const auto& [value, count] : speak) most = std::max(most, count);
    std::set<double> values;
    // A value that one case refined is no place to compare.
    for (const auto& [value, count] : speak)
      if (2 * count >= most) values.insert(value);
    for (const auto& [value, width] : widths_of(values)) {
      double open = 0;
      for (const CaseMotions* one : followed)
        if (const auto at = one->at.find(value); at != one->at.end()) open = std::max(open, at->second.open_share());
      undecided_ += width * open;
    }
  }

  /// The finest case of each method.
  void find_heads() {
    std::vector<std::string> methods = columns_;
    std::erase_if(methods, [](const std::string& one) { return is_refinement(one); });
    std::map<std::string, std::size_t> place;
    for (const CaseMotions& one : told_) {
      const auto [at, fresh] = place.emplace(study_.key(*one.record, methods), heads_.size());
      if (fresh)
        heads_.push_back(&one);
      else if (study_.finer(*one.record, *heads_[at->second]->record))
        heads_[at->second] = &one;
    }
  }

  void add_row(asks::Answered& out, const std::string& level, const std::string& verdict, const std::string& reason,
               std::optional<double> value, std::optional<double> low, std::optional<double> high,
               const std::string& unit) const {
    asks::VerdictRow row;
    row.measure = parameter_.name;
    row.level = level;
    row.value = value;
    row.low = low;
    row.high = high;
    row.unit = unit;
    row.verdict = verdict;
    row.reason = reason;
    row.cases = level.empty() ? told_.size() : 1;
    row.left_out = level.empty() ? cases_.size() - told_.size() : 0;
    out.rows.push_back(std::move(row));
  }

  /// Whether two changes may be one: of the same motions, at values that overlap. Where the intervals only touch, one
  /// method has changed where the other has not yet.
  static bool same_change(const MotionChange& a, const MotionChange& b) {
    const bool at_one = a.low == b.low && a.high == b.high;
    return a.from == b.from && a.to == b.to && (at_one || (a.low < b.high && b.low < a.high));
  }
  static bool has(const CaseMotions& one, const MotionChange& change) {
    return std::any_of(one.changes.begin(), one.changes.end(),
                       [&](const MotionChange& other) { return same_change(other, change); });
  }

  static std::string change_text(const MotionChange& change, const std::string& unit) {
    const std::string period = "period ", low = short_number(change.low, 5), high = short_number(change.high, 5);
    const bool both = change.from.starts_with(period) && change.to.starts_with(period);
    return fmt::format("{} to {} ({}–{}{})", change.from, both ? change.to.substr(period.size()) : change.to, low, high,
                       unit);
  }

  bool any_decided() const {
    return std::any_of(told_.begin(), told_.end(), [](const CaseMotions& one) {
      return std::any_of(one.stretches.begin(), one.stretches.end(),
                         [](const auto& part) { return !part.motion().empty(); });
    });
  }

  /// How many changes of any method are none of these.
  std::size_t beside(const std::vector<MotionChange>& shared) const {
    std::size_t others = 0;
    for (const CaseMotions* one : heads_)
      others += static_cast<std::size_t>(
          std::count_if(one->changes.begin(), one->changes.end(), [&](const MotionChange& change) {
            return std::none_of(shared.begin(), shared.end(),
                                [&](const MotionChange& of_all) { return same_change(of_all, change); });
          }));
    return others;
  }

  void say(asks::Answered& out) const {
    const std::string unit = parameter_.unit.empty() ? "" : " " + parameter_.unit;
    const bool open = undecided_ > much_open;
    out.passes = open || told_.empty() ? asks::Verdict::open : asks::Verdict::yes;
    out.verdict = open ? "undecided" : "decided";
    std::size_t ended = 0;
    for (const CaseMotions& one : told_)
      for (const MotionStretch& part : one.stretches) ended += part.ended;
    const std::string share =
        answers::percent(undecided_) + " of the range is undecided" + (ended > 0 ? " or has no orbit" : "");
    if (lost_ > 0 && heads_.size() > lost_)
      out.aside.push_back(fmt::format("{} of {} methods have no orbit; the share that is undecided is of the others.",
                                      lost_, heads_.size()));
    if (ended > 0)
      out.aside.push_back(
          ended == 1 ? "One orbit is refused or not followed to its end: values.csv says why."
                     : fmt::format("{} orbits are refused or not followed to their ends: values.csv says why.", ended));
    if (open) out.reason = share;
    if (undecided_ > 0) asks::warn_too_short(out, evidence_.results().study);
    if (!any_decided()) {
      out.passes = asks::Verdict::open;
      out.verdict = "undecided";
      out.reason = told_.empty() ? "no case has a diagram" : "no orbit is decided";
      out.sentence = "Open: " + out.reason + ".";
      return;
    }
    // Of changes those that every method has, at its finest step; where none is, those of the first.
    const CaseMotions& first = *heads_.front();
    std::vector<MotionChange> shared, own = first.changes;
    for (const MotionChange& change : own)
      if (std::all_of(heads_.begin(), heads_.end(), [&](const CaseMotions* one) { return has(*one, change); }))
        shared.push_back(change);
    const std::size_t others = beside(shared);
    const bool several = heads_.size() > 1, none_shared = shared.empty();
    const std::vector<MotionChange>& said = none_shared ? own : shared;
    const std::string whose = !several      ? ""
                              : none_shared ? " with " + study_.name(*first.record)
                                            : " with every method";
    const std::string before = open ? share + "; " : "";
    const std::string after = open || undecided_ == 0 ? "" : "; " + share;
    std::vector<std::string> texts;
    if (said.empty()) {
      std::set<std::string> motions;
      for (const CaseMotions* one : heads_)
        for (const MotionStretch& part : one->stretches)
          if (!part.motion().empty()) motions.insert(part.motion());
      texts.push_back(motions.size() == 1 ? fmt::format("{}{} {}: no change{}.", before, *motions.begin(),
                                                        undecided_ > 0 ? "where it is decided" : "throughout", after)
                                          : fmt::format("{}methods share no change between {}{}.", before,
                                                        answers::and_list({motions.begin(), motions.end()}), after));
    }
    for (std::size_t count = said.size(); count-- > 0;) {
      std::vector<std::string> parts;
      for (std::size_t k = 0; k <= count; ++k) parts.push_back(change_text(said[k], k == count ? unit : ""));
      const std::string more = count + 1 < said.size() ? fmt::format(", {} more", said.size() - count - 1) : "";
      texts.push_back(
          fmt::format("{}the motion changes{} from {}{}{}.", before, whose, fmt::join(parts, ", "), more, after));
    }
    for (std::string& one : texts) one = answers::capitalised(one);
    out.sentence = asks::fitting(texts);
    if (several && others > 0 && !none_shared)
      out.aside.push_back(others == 1
                              ? "One change of the motion is that of some methods alone."
                              : fmt::format("{} changes of the motion are those of some methods alone.", others));
    if (several && none_shared && others > 0) out.aside.emplace_back("No change is that of every method.");
  }

  const asks::Evidence& evidence_;
  const Choices& study_;
  Cases cases_;
  std::vector<std::string> columns_;
  report::Quantity parameter_;
  std::vector<CaseMotions> told_;
  std::vector<const CaseMotions*> heads_;
  double undecided_ = 0;
  std::size_t lost_ = 0;  // of the heads: without any orbit
};

/// "/scene/support/pulsation": "scene.support.pulsation", "support.pulsation", "pulsation", and itself.
std::vector<std::string> names_of(const std::string& pointer) {
  std::vector<std::string> out;
  std::string rest = pointer.starts_with("/") ? pointer.substr(1) : pointer;
  std::replace(rest.begin(), rest.end(), '/', '.');
  for (;;) {
    out.push_back(rest);
    const std::size_t dot = rest.find('.');
    if (dot == std::string::npos) break;
    rest.erase(0, dot + 1);
  }
  out.push_back(pointer);
  return out;
}

}  // namespace

asks::Answered motions_of_sweep(const asks::Ask& ask, const asks::Evidence& evidence, const SweptMotions& swept) {
  return MotionsAlong(ask, evidence, swept).answer();
}

asks::Answered effect_on_sweep(const asks::Ask& ask, const asks::Evidence& evidence, const SweptMotions& swept) {
  std::vector<std::vector<GridCell>> places;
  for (const DiagramCase& one : swept.diagram.cases) {
    std::vector<GridCell>& cells = places.emplace_back();
    for (int value = 0; value < swept.diagram.value_count(); ++value)
      for (int start = 0; start < swept.diagram.start_count(); ++start) {
        const int at = one.at[static_cast<std::size_t>(value * swept.diagram.start_count() + start)];
        GridCell& cell = cells.emplace_back();
        if (at < 0) continue;
        const DiagramRun& run = one.runs[static_cast<std::size_t>(at)];
        cell.present = true;
        cell.motion = run.motion;
        cell.attractor = run.attractor - 1;
      }
  }
  const MotionsOf motions = [&](const CaseRecord& record) -> const std::vector<GridCell>* {
    const auto found = std::find(swept.records.begin(), swept.records.end(), &record);
    return found == swept.records.end() ? nullptr : &places[static_cast<std::size_t>(found - swept.records.begin())];
  };
  return effect_on_motions(ask, evidence, motions, swept.diagram.start_count() > 1 ? "orbits" : "values");
}

Json default_sweep_asks(const Json& resolved) {
  if (!resolved.contains("parameter")) return Json::array();
  return default_motion_asks(resolved, names_of(resolved.at("parameter").at("pointer").get<std::string>()).front());
}

void check_sweep_ask(const Study& study, const Json& keys, const std::string& pointer) {
  const asks::Ask ask = asks::ask_at(keys, pointer);
  asks::refuse_stops(ask);
  const std::vector<std::string> names = names_of(study.resolved.at("parameter").at("pointer").get<std::string>());
  if (ask.has("effect") && ask.subject() == "start")
    throw InputError(pointer, "starts are no choice: every case marches all of them; ask {\"motions\": " +
                                  quote(names.front()) + "}, which tells where they end in several motions");
  if (ask.has("effect")) return check_effect_on_motions(study, keys, pointer);
  if (std::find(names.begin(), names.end(), ask.subject()) == names.end())
    throw InputError(pointer, "this study goes through " + quote(names.front()) + " and not through " +
                                  quote(ask.subject()) + did_you_mean(ask.subject(), names));
}

}  // namespace ricochet
