// The verb `motions` of a grid: which share of the starts ends in which motion.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/asks/kind_verbs.hpp"
#include "runners/json/json_text.hpp"
#include "runners/kinds/basins/basin_analysis.hpp"
#include "runners/kinds/sweep/motion_asks.hpp"

namespace ricochet {
namespace {

constexpr double quarter = 0.25;

bool strikes(const MotionClass& motion) {
  return motion.repeats() || motion.regime == Regime::quasi_periodic || motion.regime == Regime::chaotic;
}

/// A share of all starts of one case; the interval holds what the grid and the undecided ones leave open.
struct ShareOfStarts {
  double value = 0, low = 0, high = 0;
};

struct CaseShares {
  const CaseRecord* record = nullptr;
  std::string level;
  std::size_t decided = 0, undecided = 0, failed = 0;
  std::map<std::string, std::size_t> counts;  ///< by motion in words
  double undecided_share() const {
    return decided + undecided > 0 ? static_cast<double>(undecided) / static_cast<double>(decided + undecided) : 0;
  }
  ShareOfStarts share(std::size_t count) const {
    if (decided == 0) return {};
    const double all = static_cast<double>(decided + undecided), n = static_cast<double>(count);
    return {n / all, wilson_interval(n / all, all).low,
            wilson_interval((n + static_cast<double>(undecided)) / all, all).high};
  }
  ShareOfStarts share(const std::string& motion) const {
    const auto found = counts.find(motion);
    return share(found == counts.end() ? 0 : found->second);
  }
};

class MotionShares {
 public:
  MotionShares(const asks::Ask& ask, const asks::Evidence& evidence, const BasinAnalysis& basins)
      : evidence_(evidence), basins_(basins), cases_(evidence.cases(ask)), columns_(evidence.varying(cases_)) {
    for (const CaseRecord* one : cases_) {
      const auto found = std::find(basins.records.begin(), basins.records.end(), one);
      if (found != basins.records.end())
        read(*one, basins.grids[static_cast<std::size_t>(found - basins.records.begin())]);
    }
    std::map<std::string, double> largest;
    for (const CaseShares& one : told_)
      for (const auto& [motion, count] : one.counts)
        largest[motion] = std::max(largest[motion], one.share(motion).value);
    for (const auto& [motion, share] : largest) motions_.push_back(motion);
    std::stable_sort(motions_.begin(), motions_.end(),
                     [&](const std::string& a, const std::string& b) { return largest[a] > largest[b]; });
  }

  asks::Answered answer() const {
    asks::Answered out;
    out.cases = told_.size();
    asks::leave_out(out, cases_, told_);
    Json rows = Json::array();
    for (const CaseShares& one : told_) add_rows(out, one, rows);
    out.figure = {{"form", "bars"},
                  {"measure", "share of the " + places()},
                  {"unit", "%"},
                  {"rows", rows},
                  {"at", Json::array()}};
    tell_aside(out);
    say(out);
    if (!evidence_.study().varies("steps_per_period") && !told_.empty())
      out.aside.emplace_back("One number of steps per period: intervals hold what the grid leaves open, not the step.");
    return out;
  }

 private:
  std::string places() const { return basins_.of_states ? "starts" : "cells"; }

  void read(const CaseRecord& record, const BasinGrid& grid) {
    CaseShares& out = told_.emplace_back();
    out.record = &record;
    out.level = evidence_.level(record, columns_);
    for (const GridCell& cell : grid.cells) {
      if (!cell.present) continue;
      if (cell.motion.regime == Regime::failed)
        ++out.failed;
      else if (!cell.motion.decided())
        ++out.undecided;
      else {
        ++out.decided;
        ++out.counts[motion_words(cell.motion)];
        if (strikes(cell.motion)) striking_[motion_words(cell.motion)] = true;
      }
    }
    if (const auto starts = basins_.starts.find(record.id); starts != basins_.starts.end())
      out.failed -= std::min(out.failed, starts->second.no_starts);
  }

  asks::VerdictRow row(const CaseShares& one, const std::string& motion, const ShareOfStarts& share) const {
    asks::VerdictRow out;
    out.measure = motion;
    out.level = one.level;
    out.value = asks::per_cent * share.value;
    out.low = asks::per_cent * std::min(share.low, share.value);
    out.high = asks::per_cent * std::max(share.high, share.value);
    out.unit = "%";
    out.verdict = motion;
    out.cases = 1;
    out.left_out = 0;
    return out;
  }

  void add_rows(asks::Answered& out, const CaseShares& one, Json& bars) const {
    const auto add = [&](const std::string& motion, const ShareOfStarts& share, std::size_t count, bool drawn) {
      asks::VerdictRow added = row(one, motion, share);
      added.reason = fmt::format("{} of {} {}", count, one.decided + one.undecided, places());
      if (drawn)
        bars.push_back({{"name", motion},
                        {"group", one.level},
                        {"value", *added.value},
                        {"low", *added.low},
                        {"high", *added.high}});
      out.rows.push_back(std::move(added));
    };
    if (one.decided > 0)
      for (const std::string& motion : motions_) {
        const auto found = one.counts.find(motion);
        add(motion, one.share(motion), found == one.counts.end() ? 0 : found->second, true);
      }
    if (one.decided > 0 && several_strike()) add("with impacts", one.share(striking(one)), striking(one), false);
    asks::VerdictRow open =
        row(one, "undecided", {one.undecided_share(), one.undecided_share(), one.undecided_share()});
    open.reason = fmt::format("{} of {} {}", one.undecided, one.decided + one.undecided, places());
    out.rows.push_back(std::move(open));
  }

  /// Whether a row on all motions with impacts says more than the others.
  bool several_strike() const { return striking_.size() > 1 && striking_.size() < motions_.size(); }
  std::size_t striking(const CaseShares& one) const {
    std::size_t out = 0;
    for (const auto& [motion, count] : one.counts) out += striking_.contains(motion) ? count : 0;
    return out;
  }

  void tell_aside(asks::Answered& out) const {
    for (const UncertaintyRow& row : basins_.uncertainty)
      for (const CaseShares& one : told_)
        if (row.id == one.record->id && row.exponent && row.low && row.high && *row.high < 1)
          out.aside.push_back(fmt::format("The border is fractal{}: exponent {:.2f}, {:.2f} to {:.2f}.",
                                          one.level.empty() ? "" : " with " + one.level, *row.exponent, *row.low,
                                          *row.high));
    std::size_t failed = 0, beyond = 0, cells = 0;
    for (const CaseShares& one : told_) {
      failed += one.failed;
      if (const auto starts = basins_.starts.find(one.record->id); starts != basins_.starts.end())
        beyond = std::max(beyond, starts->second.no_starts), cells = std::max(cells, starts->second.cells);
    }
    if (std::any_of(told_.begin(), told_.end(), [](const CaseShares& one) { return one.undecided_share() > 0; }))
      asks::warn_too_short(out, evidence_.results().study);
    if (failed > 0) out.aside.push_back(fmt::format("Left out: {} {} failed.", failed, places()));
    if (beyond > 0)
      out.aside.push_back(fmt::format(
          "{} of {} cells begin beyond a stop: they are no starts, and no share counts them.", beyond, cells));
  }

  std::string undecided() const {
    double low = 1, high = 0;
    for (const CaseShares& one : told_) {
      low = std::min(low, one.undecided_share());
      high = std::max(high, one.undecided_share());
    }
    if (high <= quarter) return "";
    const std::string a = answers::percent(low), b = answers::percent(high);
    return fmt::format("{} of the {} {} undecided", a == b ? a : a + " to " + b, places(), "are");
  }

  /// With as many digits as the best known of all cases has: what is equal reads equal.
  std::string number(const std::string& motion, double share) const {
    answers::MeasureWords words;
    words.unit = "%";
    words.factor = asks::per_cent;
    std::optional<double> half;
    for (const CaseShares& one : told_)
      if (const ShareOfStarts own = one.share(motion); one.decided > 0)
        half = std::min(half.value_or(INFINITY), 0.5 * (own.high - own.low));
    return answers::value_text(words, share, half, false);
  }

  /// "94.6, 97.4 and 98.2", or the range.
  std::string numbers(const std::string& motion, bool each) const {
    std::vector<std::string> list;
    const CaseShares *least = nullptr, *most = nullptr;
    for (const CaseShares& one : told_) {
      if (one.decided == 0) continue;
      list.push_back(number(motion, one.share(motion).value));
      if (!least || one.share(motion).value < least->share(motion).value) least = &one;
      if (!most || one.share(motion).value > most->share(motion).value) most = &one;
    }
    const bool same = std::all_of(list.begin(), list.end(), [&](const auto& one) { return one == list.front(); });
    if (same) return list.front() + " %";
    if (each) return answers::and_list(list) + " %";
    return fmt::format("{} to {} %", number(motion, least->share(motion).value),
                       number(motion, most->share(motion).value));
  }

  static std::string in(const std::string& motion) {
    return motion == "no contact" ? "without contact" : "in " + motion + (motion == "quasi-periodic" ? " motion" : "");
  }

  void say(asks::Answered& out) const {
    const std::string open = undecided();
    out.passes = open.empty() ? asks::Verdict::yes : asks::Verdict::open;
    out.verdict = open.empty() ? "decided" : "undecided";
    if (!open.empty()) out.reason = open;
    if (motions_.empty()) {
      out.passes = asks::Verdict::open;
      out.verdict = "undecided";
      out.reason = "none of the " + places() + " is decided";
      out.sentence = "Open: " + out.reason + ".";
      return;
    }
    const std::string before = open.empty() ? "" : open + "; ";
    std::vector<std::string> levels;
    for (const CaseShares& one : told_)
      if (one.decided > 0) levels.push_back(one.level);
    std::vector<std::string> texts;
    for (const bool each : {true, false}) {
      if (each && levels.size() > 4) continue;
      for (const std::size_t most : {std::size_t{4}, std::size_t{2}, std::size_t{1}})
        for (const bool named : {true, false}) {
          if (!each && named) continue;
          std::string text;
          for (std::size_t k = 0; k < std::min(most, motions_.size()); ++k)
            text += k == 0 ? fmt::format("{} of the {} end {}", numbers(motions_[k], each), places(), in(motions_[k]))
                           : fmt::format(", {} {}", numbers(motions_[k], each), in(motions_[k]));
          if (motions_.size() > most) text += fmt::format(", the others in {} more motions", motions_.size() - most);
          if (levels.size() > 1)
            text += named ? " (" + fmt::format("{}", fmt::join(levels, "; ")) + ")"
                          : fmt::format(", over {} cases", levels.size());
          texts.push_back(answers::capitalised(before + text) + ".");
        }
    }
    out.sentence = asks::fitting(texts);
  }

  const asks::Evidence& evidence_;
  const BasinAnalysis& basins_;
  Cases cases_;
  std::vector<std::string> columns_, motions_;
  std::vector<CaseShares> told_;
  std::map<std::string, bool> striking_;
};

}  // namespace

asks::Answered motions_of_basins(const asks::Ask& ask, const asks::Evidence& evidence, const BasinAnalysis& basins) {
  return MotionShares(ask, evidence, basins).answer();
}

asks::Answered effect_on_basins(const asks::Ask& ask, const asks::Evidence& evidence, const BasinAnalysis& basins) {
  const MotionsOf motions = [&](const CaseRecord& record) -> const std::vector<GridCell>* {
    const auto found = std::find(basins.records.begin(), basins.records.end(), &record);
    return found == basins.records.end()
               ? nullptr
               : &basins.grids[static_cast<std::size_t>(found - basins.records.begin())].cells;
  };
  return effect_on_motions(ask, evidence, motions, basins.of_states ? "starts" : "cells");
}

void check_basin_ask(const Study& study, const Json& keys, const std::string& pointer) {
  const asks::Ask ask = asks::ask_at(keys, pointer);
  asks::refuse_stops(ask);
  if (ask.has("effect")) return check_effect_on_motions(study, keys, pointer);
  if (ask.subject() != "share")
    throw InputError(
        pointer, "of basins the share of the starts is asked, not " + quote(ask.subject()) + "; expected \"share\"");
}

}  // namespace ricochet
