#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <ricochet/measure/statistics/draws.hpp>
#include <set>

#include "runners/answers/set_names.hpp"
#include "runners/asks/lines.hpp"
#include "runners/asks/pairs.hpp"
#include "runners/asks/verbs.hpp"
#include "runners/json/json_text.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::asks {
namespace {

constexpr const char* over_stops = "stops";

/// The first and the last place that a line may have.
struct Place {
  std::size_t first = 1, last = 1;
  std::string text() const { return first == last ? std::to_string(first) : fmt::format("{} to {}", first, last); }
};

/// Between what a line is told to lie; of one without an interval nothing is.
double lowest(const Line& line) {
  return line.estimate().has_interval() ? line.estimate().least() : -INFINITY;
}
double highest(const Line& line) {
  return line.estimate().has_interval() ? line.estimate().most() : INFINITY;
}

/// Whether two lines are told apart by their difference at equal steps, meshes and draws, in which cancels what moves
/// both alike: `a` is above `b`.
bool differs(const Line& a, const Line& b) {
  if (!a.estimate().has_interval() || !b.estimate().has_interval()) return false;
  const std::optional<Pair> pair = pair_of(b.point, a.point);
  return pair && !pair->least && pair->u_most && pair->difference > *pair->u_most;
}

/// Which lines are above which, by their intervals, or by their differences where they are few. Lines by falling value.
class Apart {
 public:
  Apart() = default;
  explicit Apart(const std::vector<const Line*>& lines) {
    for (const Line* line : lines) {
      lowest_.push_back(lowest(*line));
      highest_.push_back(highest(*line));
    }
    if (lines.size() > most_paired) return;
    for (std::size_t a = 0; a < lines.size(); ++a)
      for (std::size_t b = a + 1; b < lines.size(); ++b)
        if (lowest_[a] <= highest_[b] && differs(*lines[a], *lines[b])) differ_.insert({a, b});
  }

  bool above(std::size_t a, std::size_t b) const { return lowest_[a] > highest_[b] || differ_.contains({a, b}); }
  bool told(std::size_t a, std::size_t b) const { return above(a, b) || above(b, a); }
  /// Whether their differences alone tell them.
  bool by_difference(std::size_t a, std::size_t b) const { return differ_.contains({a, b}); }

  std::vector<Place> places() const {
    const std::size_t n = lowest_.size();
    std::vector<Place> out(n, {1, n});
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = a + 1; b < n; ++b)
        if (above(a, b)) {
          ++out[b].first;
          --out[a].last;
        }
    return out;
  }

  /// Some of the lines, cut where all before are above all after: one may reach beyond its neighbours.
  std::vector<std::vector<std::size_t>> groups(const std::vector<std::size_t>& lines) const {
    std::vector<std::vector<std::size_t>> out;
    std::size_t reach = 0;  // the last line that one before is not above
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (k == 0 || reach < k) out.emplace_back();
      out.back().push_back(lines[k]);
      std::size_t last = lines.size() - 1;
      while (last > std::max(reach, k) && above(lines[k], lines[last])) --last;
      reach = std::max(reach, last);
    }
    return out;
  }

  /// Which of a group is told from none of the others, three at least, where these are told apart without it. Of two
  /// others it is a neighbour of both.
  std::optional<std::size_t> aside(const std::vector<std::size_t>& group) const {
    constexpr std::size_t fewest = 4;
    if (group.size() < fewest || group.size() > most_paired) return std::nullopt;
    for (const std::size_t one : group) {
      if (std::any_of(group.begin(), group.end(), [&](std::size_t other) { return told(one, other); })) continue;
      std::vector<std::size_t> rest = group;
      std::erase(rest, one);
      if (groups(rest).size() > 1) return one;
    }
    return std::nullopt;
  }

 private:
  static constexpr std::size_t most_paired = 64;
  std::vector<double> lowest_, highest_;
  std::set<std::pair<std::size_t, std::size_t>> differ_;
};

/// What is ranked, in one combination of all else, the largest first.
struct Order {
  std::string level;
  std::vector<const Line*> lines;
  std::vector<std::string> names;
  std::size_t without = 0;                  ///< that ran and have no value: each may be larger than all others
  std::vector<const Line*> untouched = {};  ///< of stops that nothing touches, which come last
  /// Groups of neighbours that are not told apart, as places in `lines`.
  std::vector<std::vector<std::size_t>> groups;
  std::vector<std::size_t> aside;  ///< those told from none of some that are told apart without it
  Apart apart;
  std::vector<Place> places;  ///< of each line
  bool surely_first() const { return lines.size() > 1 && places.front().last == 1; }
};

/// Tells lines by falling value apart as far as they are.
void tell_apart(Order& order) {
  order.apart = Apart(order.lines);
  const Apart& apart = order.apart;
  order.places = apart.places();
  std::vector<std::size_t> told(order.lines.size());
  std::iota(told.begin(), told.end(), 0);
  order.groups = apart.groups(told);
  for (std::size_t g = 0; g < order.groups.size();) {
    const auto one = apart.aside(order.groups[g++]);
    if (!one) continue;
    order.aside.push_back(*one);
    std::erase(told, *one);
    order.groups = apart.groups(told);
    g = 0;
  }
}

class Ranking {
 public:
  Ranking(const Ask& ask, const Evidence& evidence) : evidence_(evidence), over_(ask.text("over")) {
    const Cases cases = evidence.cases(ask);
    std::vector<std::string> columns = evidence.choices(cases, ask.subject());
    if (over_ != over_stops) own_ = evidence.columns_of(over_);
    std::erase_if(columns, [&](const auto& one) { return std::find(own_.begin(), own_.end(), one) != own_.end(); });
    others_ = columns;
    columns.insert(columns.end(), own_.begin(), own_.end());
    lines_ = lines_of(ask, evidence, ask.subject(), columns);
    InOrderMet<std::string, Order> orders;
    for (const Line& line : lines_.all) {
      Order& order = orders[evidence.key(line.point.first(), others_) + (over_ == over_stops ? "" : '\n' + line.stop)];
      order.level = level_of(line);
      if (is_idle(line))
        order.untouched.push_back(&line);
      else if (line.known())
        order.lines.push_back(&line);
      else if (std::any_of(line.point.cases.begin(), line.point.cases.end(),
                           [](const CaseRecord* one) { return one->status == Status::done; }))
        ++order.without;
    }
    orders_ = std::move(orders).list();
    for (auto& [key, order] : orders_) {
      // Where nothing at all is touched, none comes last.
      if (order.lines.empty() && order.without == 0) {
        const auto known = [](const Line* one) { return one->known(); };
        std::copy_if(order.untouched.begin(), order.untouched.end(), std::back_inserter(order.lines), known);
        std::erase_if(order.untouched, known);
      }
      std::stable_sort(order.lines.begin(), order.lines.end(),
                       [](const Line* a, const Line* b) { return a->estimate().value > b->estimate().value; });
      for (const Line* line : order.lines) order.names.push_back(name_of(*line));
      tell_apart(order);
      if (order.without == 0) continue;
      order.aside.clear();
      order.groups.assign(1, {});
      for (std::size_t k = 0; k < order.lines.size(); ++k) order.groups.front().push_back(k);
    }
    // Where the axis says nothing, as of a stiffness beside rigid stops, nothing is ranked.
    std::erase_if(orders_, [](const auto& one) {
      return one.second.lines.empty() || one.second.names == std::vector{or_none("")};
    });
    std::map<std::string, std::size_t> times;
    for (const auto& [key, order] : orders_) ++times[order.names.front()];
    for (std::size_t k = 1; k < orders_.size(); ++k)
      if (times[orders_[k].second.names.front()] > times[orders_[told_].second.names.front()]) told_ = k;
  }

  Answered answer() const {
    Answered out = begin_answer(lines_);
    out.figure = figure();
    if (auto open = without_values(lines_, out, false)) return *open;
    const bool alone = std::none_of(orders_.begin(), orders_.end(), [](const auto& one) {
      const Order& order = one.second;
      return order.lines.size() + order.without + order.untouched.size() > 1;
    });
    if (alone && lines_.all.size() > 1)
      return never_alone(std::move(out), lines_, over_ == over_stops ? "the stop" : evidence_.study().spoken(over_));
    for (const auto& [key, order] : orders_) add_rows(out, order);
    const Order& first = orders_[told_].second;
    const bool firm = is_firm(first);
    bool all_firm = true, any_told = false;
    std::size_t surely_first = 0;
    for (const auto& [key, order] : orders_) {
      all_firm = all_firm && is_firm(order);
      any_told = any_told || order.groups.size() > 1;
      surely_first += order.names.front() == first.names.front() && order.surely_first() ? 1 : 0;
    }
    const auto [turned, turned_to] = turns();
    out.passes = !turned.empty() ? Verdict::no : all_firm ? Verdict::yes : Verdict::open;
    out.verdict = !turned.empty() ? "turned round" : all_firm ? "told apart" : any_told ? "in part" : "not told apart";
    if (!firm && !first.lines.empty())
      out.reason = first.without > 0               ? without_value(first)
                   : is_idle(*first.lines.front()) ? "nothing is touched"
                                                   : first.lines.front()->estimate().unknown();
    std::vector<std::vector<std::string>> rest;
    if (std::vector<std::string> loose; !first.aside.empty()) {
      for (const std::size_t k : first.aside) loose.push_back(name_of(*first.lines[k]));
      const Estimate& one = first.lines[first.aside.front()]->estimate();
      rest.push_back({fmt::format("; {}{} is told from none of them", some_of(loose, 1),
                                  loose.size() == 1 ? " (" + lines_.text(one) + ")" : ""),
                      fmt::format("; {} may have any place", some_of(loose, 1))});
    } else if (!out.reason.empty())
      rest.push_back({"; " + out.reason, "; " + short_reason(out.reason)});
    if (std::vector<std::string> idle; !first.untouched.empty()) {
      for (const Line* line : first.untouched) idle.push_back(name_of(*line));
      rest.push_back({"; nothing touches " + some_of(idle), fmt::format("; {} never touched", idle.size())});
    }
    if (orders_.size() > 1)
      rest.push_back(
          {!turned.empty()                  ? fmt::format("; {} is first with {}", turned_to, some_of(turned, 1))
           : surely_first == orders_.size() ? fmt::format("; the same first in all {} combinations", surely_first)
           : surely_first > 0 ? fmt::format("; {} is surely first in {} of {} combinations", first.names.front(),
                                            surely_first, orders_.size())
                              : "; in no combination one is surely first",
           !turned.empty() ? fmt::format("; {} is first in {} of {}", turned_to, turned.size(), orders_.size())
           : surely_first > 0
               ? fmt::format("; {} surely first in {} of {}", first.names.front(), surely_first, orders_.size())
               : "; none surely first",
           !turned.empty() ? "; another elsewhere" : ""});
    if (first.without > 0) {
      // Each of those without a value may be the largest.
      const std::string why = lines_.without.empty() ? "" : " (" + some_of(lines_.without, 1) + ")";
      out.sentence = in_thirty_words(
          fmt::format("Open: which {} is the largest is not told: {} of {} {} no value", lines_.words.words,
                      first.without, first.lines.size() + first.without, first.without == 1 ? "has" : "have"),
          {{why, ""}, {first.level.empty() ? "" : ", with " + first.level, ""}});
      return out;
    }
    // What holds over all combinations is worth more than the third place of one.
    const auto says_all = [&](const std::string& sentence) {
      return orders_.size() == 1 || std::any_of(rest.back().begin(), rest.back().end(), [&](const std::string& one) {
               return !one.empty() && sentence.ends_with(one + ".");
             });
    };
    for (std::size_t most = 3; most > 0; --most) {
      const std::string must = capitalised_order(first, most);
      out.sentence = in_thirty_words(must, rest);
      if (fits(must) && says_all(out.sentence)) break;
    }
    return out;
  }

 private:
  static bool is_firm(const Order& order) {
    return order.without == 0 && order.groups.size() == order.lines.size() && !is_idle(*order.lines.front());
  }
  static bool is_idle(const Line& line) { return asks::is_idle(line.point, line.stop); }
  static std::string without_value(const Order& order) {
    return fmt::format("{} {} no value", order.without, order.without == 1 ? "has" : "have");
  }

  /// All else, "HRZ, end"; what is ranked.
  std::string level_of(const Line& line) const {
    const std::string level = evidence_.level(line.point.first(), others_),
                      stop = over_ == over_stops || line.one_stop ? "" : line.stop;
    return level + (stop.empty() ? "" : (level.empty() ? "" : ", ") + stop);
  }
  std::string name_of(const Line& line) const {
    return over_ == over_stops ? line.stop : or_none(evidence_.level(line.point.first(), own_));
  }

  /// A group of bars for each combination of all else.
  Json figure() const {
    Json out = bars(lines_);
    out["sorted"] = true;
    for (std::size_t k = 0; k < lines_.all.size(); ++k) {
      out["rows"][k]["name"] = name_of(lines_.all[k]);
      out["rows"][k]["group"] = level_of(lines_.all[k]);
    }
    return out;
  }

  /// "Largest wear power: p2, 3.1 ± 0.2 mW, then p1, 1.2 ± 0.1 mW; p3 and p4 are not told apart".
  std::string capitalised_order(const Order& order, std::size_t most) const {
    std::vector<std::string> parts;
    for (std::size_t g = 0; g < std::min(order.groups.size(), most); ++g) {
      const std::vector<std::size_t>& group = order.groups[g];
      std::vector<std::string> names;
      for (const std::size_t k : group) names.push_back(order.names[k]);
      const Estimate& top = order.lines[group.front()]->estimate();
      parts.push_back(group.size() == 1 ? fmt::format("{} ({})", names.front(), lines_.text(top))
                                        : fmt::format("{}, not told apart (to {})", some_of(names, most > 1 ? 2 : 1),
                                                      lines_.text(top)));
    }
    std::size_t more = 0;
    for (std::size_t g = most; g < order.groups.size(); ++g) more += order.groups[g].size();
    std::string what = lines_.words.words;
    for (const std::string said : {"the ", "largest "})
      if (what.starts_with(said)) what.erase(0, said.size());
    std::vector<std::string> aside;
    for (const std::size_t k : order.aside) aside.push_back(order.names[k]);
    return fmt::format("Largest {}{}{}: {}{}", what, order.level.empty() ? "" : " with " + order.level,
                       aside.empty() ? "" : ", " + some_of(aside, 1) + " aside", fmt::join(parts, ", then "),
                       more > 0 ? fmt::format(", then {} more", more) : "");
  }

  /// The levels of all else with which another is surely the largest, and which one is so with the first of them.
  std::pair<std::vector<std::string>, std::string> turns() const {
    std::pair<std::vector<std::string>, std::string> out;
    const Order& first = orders_[told_].second;
    if (!first.surely_first()) return out;
    for (const auto& keyed : orders_) {
      const Order& order = keyed.second;
      if (order.names.front() == first.names.front()) continue;
      // Nothing is turned round where the first is not there, or not told from others.
      const bool there = std::find(order.names.begin(), order.names.end(), first.names.front()) != order.names.end();
      if (!there || !order.surely_first()) continue;
      if (out.first.empty()) out.second = order.names.front();
      out.first.push_back(order.level);
    }
    return out;
  }

  /// Why a line has no place of its own: intervals touch, or one is not settled and may be farther off.
  static std::string why_together(const Order& order, std::size_t k) {
    const Estimate& own = order.lines[k]->estimate();
    if (!own.has_interval()) return own.unsettled().empty() ? own.unknown() : "it " + own.unsettled();
    std::string moving;
    for (std::size_t other = 0; other < order.lines.size(); ++other) {
      if (other == k || order.apart.told(k, other)) continue;
      const Estimate& one = order.lines[other]->estimate();
      if (!one.has_interval()) return order.names[other] + " has no interval";
      if (own.low() <= one.high() && one.low() <= own.high())
        return "its difference from " + order.names[other] + " is not told from zero";
      if (one.doubted() && moving.empty()) moving = order.names[other] + " " + one.unsettled();
    }
    return own.doubted() || moving.empty() ? "it " + own.unsettled() : moving;
  }

  void add_rows(Answered& out, const Order& order) const {
    for (std::size_t k = 0; k < order.lines.size(); ++k) {
      VerdictRow row = lines_.row(*order.lines[k]);
      const Place& place = order.places[k];
      row.verdict = order.without > 0 ? word(Verdict::open) : place.text();
      if (row.reason.empty() && order.without > 0)
        row.reason = without_value(order);
      else if (row.reason.empty() && place.first != place.last)
        row.reason = is_idle(*order.lines[k]) ? "nothing is touched" : why_together(order, k);
      else if (row.reason.empty() && order.apart.by_difference(k, k + 1))
        row.reason = "by its difference from the next at equal steps and seeds";
      out.rows.push_back(std::move(row));
    }
    for (const Line* line : order.untouched) {
      out.rows.push_back(lines_.row(*line));
      out.rows.back().verdict = "last";
    }
  }

  const Evidence& evidence_;
  std::string over_;
  std::vector<std::string> own_, others_;
  Lines lines_;
  std::vector<std::pair<std::string, Order>> orders_;
  std::size_t told_ = 0;  // of these: the first with the most frequent largest
};

void check_rank(const Ask& ask, const Study& study) {
  const std::string over = ask.text("over");
  if (over == over_stops) {
    const Json& stops = study.resolved.at("scene").at("stops");
    constexpr std::size_t two = 2;
    if (!stops.is_array() || stops.size() < two)
      throw InputError(ask.pointer("over"), "nothing to rank: the scene has fewer than two stops with names");
    if (split_measure(ask.subject()).second != "")
      throw InputError(ask.pointer(), "a measure of one stop is not ranked over stops; expected " +
                                          quote(split_measure(ask.subject()).first));
    const auto named = ask.has("stops") ? ask.keys["stops"] : Json::array();
    if (ask.has("stops") && named.size() < two)
      throw InputError(ask.pointer("stops"), "nothing to rank: one stop; expected two or more");
    check_measure(ask, study, "rank", ask.subject() + "[" + stops.front().at("name").get<std::string>() + "]");
    check_one_unit(ask, study, ask.subject());
    return;
  }
  check_subject(ask, study);
  const Json& stops = study.resolved.at("scene").at("stops");
  if (stops.is_array() && stops.size() > 1 && did_you_mean(over, {over_stops}) != "" &&
      std::find(study.columns.begin(), study.columns.end(), over) == study.columns.end())
    throw InputError(ask.pointer("over"),
                     "no choice of this study is called " + quote(over) + did_you_mean(over, {over_stops}));
  check_choice(ask, study, "over", over);
  refuse_seeds(ask, "over", "are not ranked", ask.subject());
}

std::string doubt_rank(const Ask&, const Study& study) {
  const Planned plan = planned(study);
  if (plan.steps == 1) return "one step only: no intervals, so nothing is told apart";
  constexpr std::size_t few = 8;
  if (plan.seeds > 1 && plan.seeds < few)
    return fmt::format("{} seeds: the interval of a mean is ± {} times the scatter between them", plan.seeds,
                       short_number(half_interval_over_scatter(plan.seeds), 2));
  return "";
}

}  // namespace

const Verb& rank_verb() {
  static const Verb verb{"rank",
                         "Which stop or level has the largest value, and how surely.",
                         {keys::of_form(Field::Form::text, "rank", std::nullopt, "The measure."),
                          keys::of_form(Field::Form::text, "over", std::nullopt, "\"stops\", a choice or an axis.")},
                         "",
                         check_rank,
                         doubt_rank,
                         [](const Ask& ask, const Evidence& evidence) { return Ranking(ask, evidence).answer(); }};
  return verb;
}

}  // namespace ricochet::asks
