#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/kinds/stability/stability.hpp"
#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

namespace say = answers;
using say::Clause, say::Sentence, say::and_list, say::percent, say::short_number;

/// What a limit is called where there is none.
constexpr const char* unlimited = "none";
constexpr double moves_limit = 0.01, lowers_limit = 0.98;

/// A method on one mesh: its limits with contact open and closed.
struct Limits {
  const CaseRecord* record = nullptr;
  LimitRow open, closed;
  bool has_closed = false;
  bool limited() const { return open.prediction == "limit" && open.predicted; }
  bool free() const { return open.prediction == unlimited; }
};

class StepLimits {
 public:
  explicit StepLimits(const say::Compared& study) : study_(study), columns_(study.columns()) {
    if (const std::string mesh = study.mesh_column(); study.varies(mesh)) columns_.push_back(mesh);
    std::map<std::string, const CaseRecord*> by_id;
    for (const CaseRecord& record : study.results().cases) by_id[record.id] = &record;
    std::map<std::string, std::size_t> place;
    for (const LimitRow& row : step_limits_type().read(study.results().derived)) {
      const auto found = by_id.find(row.id);
      if (found == by_id.end() || row.prediction.empty()) continue;
      const auto [at, fresh] = place.emplace(row.id, all_.size());
      if (fresh) all_.push_back({found->second, {}, {}});
      Limits& one = all_[at->second];
      (row.closed ? one.closed : one.open) = row;
      one.has_closed = one.has_closed || row.closed;
    }
    std::erase_if(all_, [](const Limits& one) { return one.open.id.empty(); });
    for (const std::string& column : columns_)
      if (moves(column, [](const Limits& one) { return one.limited() ? one.open.predicted : std::nullopt; }))
        telling_.push_back(column);
  }

  bool empty() const { return all_.empty(); }
  void say_limits(say::Answer& answer) const;
  void say_mesh(say::Answer& answer) const;
  void say_closed(say::Answer& answer) const;
  void say_marches(say::Answer& answer) const;
  void say_gains(say::Answer& answer) const;
  void say_roots(say::Answer& answer) const;

 private:
  template <class Value>
  bool moves(const std::string& column, Value value) const;
  Cases records() const {
    Cases out;
    for (const Limits& one : all_) out.push_back(one.record);
    return out;
  }
  template <class Holds>
  Members where(Holds holds) const {
    Members out;
    for (std::size_t k = 0; k < all_.size(); ++k)
      if (holds(all_[k])) out.push_back(k);
    return out;
  }
  /// The case without its scheme: "consistent, 10 elements".
  std::string rest_of(const CaseRecord& record) const;
  Clause clause(const Members& members, const char* status) const;

  const say::Compared& study_;
  std::vector<std::string> columns_, telling_;  ///< that vary; those that move a limit
  std::vector<Limits> all_;
};

/// Whether some two methods that differ in the column alone have limits that differ by more than 1 %, or one has none.
template <class Value>
bool StepLimits::moves(const std::string& column, Value value) const {
  const std::string choice = axis_role(column);
  std::vector<std::string> others;
  for (const std::string& other : columns_)
    if (axis_role(other) != choice) others.push_back(other);
  std::map<std::string, std::vector<const Limits*>> groups;
  for (const Limits& one : all_) groups[study_.key(*one.record, others)].push_back(&one);
  for (const auto& [key, group] : groups)
    for (const Limits* one : group) {
      const auto first = value(*group.front()), here = value(*one);
      if (first.has_value() != here.has_value()) return true;
      if (first && std::abs(*here / *first - 1) > moves_limit) return true;
    }
  return false;
}

std::string StepLimits::rest_of(const CaseRecord& record) const {
  std::vector<std::string> choices;
  std::string out;
  for (const std::string& column : telling_) {
    const std::string choice = axis_role(column);
    if (choice == "time" || std::find(choices.begin(), choices.end(), choice) != choices.end()) continue;
    choices.push_back(choice);
    const std::string level = column == study_.mesh_column() ? study_.value_words(column, study_.text(record, column))
                                                             : study_.level(record, choice);
    if (!level.empty()) out += (out.empty() ? "" : ", ") + level;
  }
  return out;
}

Clause StepLimits::clause(const Members& members, const char* status) const {
  Clause out{.form = "limit", .who = say::SetNames(study_, records(), columns_).of(members)};
  out.unit = "s";
  out.status = status;
  for (const std::size_t k : members) {
    out.methods += (out.methods.empty() ? "" : " ") + all_[k].record->id;
    if (!all_[k].open.predicted) continue;
    out.low = std::min(out.low.value_or(*all_[k].open.predicted), *all_[k].open.predicted);
    out.high = std::max(out.high.value_or(*all_[k].open.predicted), *all_[k].open.predicted);
  }
  return out;
}

/// Who has no limit, and the largest step of each scheme.
void StepLimits::say_limits(say::Answer& answer) const {
  const Members free = where([](const Limits&one) { return one.free(); }),
                limited = where([](const Limits&one) { return one.limited(); });
  const nlohmann::ordered_json steps = study_.results().study.is_object()
                                           ? study_.results().study.value("steps", nlohmann::ordered_json::object())
                                           : nlohmann::ordered_json::object();
  const std::string range =
      fmt::format("{} to {} s", short_number(steps.value("from", 0.0)), short_number(steps.value("to", 0.0)));
  if (limited.empty() && free.size() == all_.size()) {
    answer.say(fmt::format("No method has a largest step without contact, from {}.", range), clause(free, "none"));
  } else if (!free.empty()) {
    // One case for each set of levels that move a limit.
    Cases firsts;
    Members chosen;
    std::set<std::string> met;
    for (std::size_t k = 0; k < all_.size(); ++k) {
      if (!met.insert(study_.key(*all_[k].record, telling_)).second) continue;
      if (all_[k].free()) chosen.push_back(firsts.size());
      firsts.push_back(all_[k].record);
    }
    const say::SetNames::Name name = say::SetNames(study_, firsts, telling_).found(chosen);
    answer.say(fmt::format("No largest step from {}: {}.", range, name.text), clause(free, "none"));
  }
  if (!limited.empty()) {
    InOrderMet<std::string, Members> schemes;
    Members sorted = limited;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](std::size_t a, std::size_t b) { return *all_[a].open.predicted < *all_[b].open.predicted; });
    for (const std::size_t k : sorted) schemes[study_.level(*all_[k].record, "time")].push_back(k);
    Sentence said;
    constexpr std::size_t told = 4, levels_told = 3;
    std::size_t count = 0;
    for (const auto& [scheme, members] : schemes.list()) {
      said.clauses.push_back(clause(members, "limit"));
      if (count++ >= told) continue;
      // A limit stands with the level that has it; equal ones once.
      std::vector<std::pair<double, std::string>> limits;
      for (const std::size_t k : members) {
        const std::string rest = rest_of(*all_[k].record);
        const bool known =
            std::any_of(limits.begin(), limits.end(), [&](const auto& one) { return one.second == rest; });
        if (!known) limits.emplace_back(*all_[k].open.predicted, rest);
      }
      std::string text;
      if (limits.size() > levels_told) limits = {limits.front(), limits.back()};
      for (const auto& [limit, rest] : limits)
        text += fmt::format("{}{} s{}", text.empty() ? "" : ", ", short_number(limit, 3),
                            rest.empty() ? "" : " (" + rest + ")");
      said.text += fmt::format("{}{} {}", said.text.empty() ? "" : "; ", scheme.empty() ? "the scheme" : scheme, text);
    }
    said.text = fmt::format("Largest step: {}{}.", said.text,
                            count > told ? fmt::format("; {} more in the table", count - told) : "");
    answer.say(std::move(said));
    // What moves none of them.
    std::vector<std::string> idle;
    for (const std::string& choice : study_.choices()) {
      const std::vector<std::string> own = study_.columns_of(choice);
      const bool tells = std::any_of(own.begin(), own.end(), [&](const auto& column) {
        return std::find(telling_.begin(), telling_.end(), column) != telling_.end();
      });
      if (!tells && choice != "time") idle.push_back(say::spoken(choice));
    }
    if (!idle.empty())
      answer.say(fmt::format("{} {} not change {}.", say::capitalised(and_list(idle)), idle.size() > 1 ? "do" : "does",
                             limited.size() > 1 ? "these limits" : "this limit"),
                 Clause{.form = "limit", .choice = and_list(idle), .status = "no effect"});
  }
  const Members never = where([](const Limits& one) { return one.open.prediction == "below the range"; });
  if (!never.empty()) {
    Clause one = clause(never, "below the range");
    answer.say(fmt::format("Unstable at every step of the range: {}.", one.who), one);
  }
}

/// How limits fall with the element's length.
void StepLimits::say_mesh(say::Answer& answer) const {
  if (!study_.varies("elements")) return;
  std::map<std::string, std::vector<std::pair<double, double>>> groups;
  for (const Limits& one : all_)
    if (one.limited())
      groups[study_.key(*one.record)].emplace_back(study_.elements(*one.record).value_or(1), *one.open.predicted);
  std::vector<double> powers;
  for (auto& [key, points] : groups) {
    if (points.size() < 3) continue;
    std::sort(points.begin(), points.end());
    powers.push_back(std::log(points.front().second / points.back().second) /
                     std::log(points.back().first / points.front().first));
  }
  if (powers.empty()) return;
  const auto [least, most] = std::minmax_element(powers.begin(), powers.end());
  Clause one{.form = "limit", .choice = "elements"};
  one.low = *least;
  one.high = *most;
  one.unit = "1";
  one.status = "power";
  const std::string power = fmt::format(
      "{:.2f}{}", *least,
      fmt::format("{:.2f}", *least) != fmt::format("{:.2f}", *most) ? fmt::format(" to {:.2f}", *most) : "");
  answer.say(fmt::format("They fall with the element's length to the power {}.", power), one);
}

/// What a closed contact lowers.
void StepLimits::say_closed(say::Answer& answer) const {
  const Members lowered = where([](const Limits& one) {
    return one.has_closed && one.closed.prediction == "limit" && one.closed.predicted &&
           (!one.open.predicted || *one.closed.predicted < lowers_limit * *one.open.predicted);
  });
  const bool any_closed = std::any_of(all_.begin(), all_.end(), [](const Limits& one) { return one.has_closed; });
  if (lowered.empty()) {
    if (any_closed)
      answer.say("A closed contact lowers no limit.", Clause{.form = "limit", .status = "closed lowers none"});
    return;
  }
  Clause one = clause(lowered, "lowered by contact");
  one.low.reset();
  one.high.reset();
  for (const std::size_t k : lowered) {
    one.low = std::min(one.low.value_or(INFINITY), *all_[k].closed.predicted);
    one.high = std::max(one.high.value_or(0), *all_[k].closed.predicted);
  }
  std::string text = fmt::format("A closed contact lowers the limit with {}, to {}", one.who,
                                 *one.high > (1 + moves_limit) * *one.low
                                     ? fmt::format("{} to {} s", short_number(*one.low, 3), short_number(*one.high, 3))
                                     : short_number(*one.low, 3) + " s");
  // Over a number with many levels: its power.
  for (const std::string& column : study_.columns()) {
    constexpr std::size_t levels = 4;
    if (study_.numbers_of(column).size() < levels) continue;
    std::vector<std::string> others;
    for (const std::string& other : columns_)
      if (other != column) others.push_back(other);
    std::map<std::string, std::vector<std::pair<double, double>>> groups;
    for (const std::size_t k : lowered)
      if (const auto x = axis(*all_[k].record, column).number(); x && *x > 0)
        groups[study_.key(*all_[k].record, others)].emplace_back(*x, *all_[k].closed.predicted);
    std::vector<double> powers;
    for (auto& [key, points] : groups) {
      if (points.size() < levels) continue;
      std::sort(points.begin(), points.end());
      powers.push_back(std::log(points.front().second / points.back().second) /
                       std::log(points.back().first / points.front().first));
    }
    if (powers.empty()) continue;
    const auto [least, most] = std::minmax_element(powers.begin(), powers.end());
    text += fmt::format(
        "; it falls with the {} to the power {:.2f}{}", say::spoken(column), *least,
        fmt::format("{:.2f}", *least) != fmt::format("{:.2f}", *most) ? fmt::format(" to {:.2f}", *most) : "");
    one.value = 0.5 * (*least + *most);
  }
  answer.say(text + ".", one);
}

/// Whether marches have the limits that the spectra predict.
void StepLimits::say_marches(say::Answer& answer) const {
  std::size_t both = 0, agree = 0;
  double worst = 0, least = INFINITY, most = 0;
  for (const Limits& one : all_)
    for (const LimitRow* row : {&one.open, &one.closed}) {
      if (row->id.empty() || !row->counted || !row->ratio) continue;
      ++both;
      // A scene is open as well as closed: its march may have either limit.
      const double own = row->observed && row->predicted ? std::abs(*row->observed / *row->predicted - 1) : INFINITY;
      const double apart = std::min(own, std::abs(*row->ratio - 1));
      if (apart > limit_tolerance) {
        const double times = row->predicted && row->observed ? *row->observed / *row->predicted : *row->ratio;
        least = std::min(least, times);
        most = std::max(most, times);
        continue;
      }
      ++agree;
      worst = std::max(worst, apart);
    }
  if (both == 0) return;
  Clause one{.form = "limit"};
  one.value = static_cast<double>(agree);
  one.high = static_cast<double>(both);
  one.uncertainty = 100 * worst;
  one.unit = "limits";
  one.status = agree == both ? "confirmed" : "confirmed in part";
  if (agree == both) {
    answer.say(fmt::format("Marching confirms all {} predicted limits, to {}.", both, percent(worst)), one);
    return;
  }
  Sentence said{fmt::format("Marching confirms {} of {} limits{}; contacts that open and close have the others at {} "
                            "times the prediction.",
                            agree, both, agree > 0 ? ", to " + percent(worst) : "",
                            short_number(least, 2) == short_number(most, 2)
                                ? short_number(most, 2)
                                : short_number(least, 2) + " to " + short_number(most, 2)),
                {one}};
  Clause others{.form = "limit"};
  others.low = least;
  others.high = most;
  others.unit = "1";
  others.status = "observed over predicted";
  said.clauses.push_back(std::move(others));
  answer.say(std::move(said));
}

/// Who gains energy in marches although no root leaves the circle.
void StepLimits::say_gains(say::Answer& answer) const {
  const Members gain = where([](const Limits& one) {
    return one.has_closed && one.closed.prediction == unlimited && one.closed.disagreeing > 0 &&
           !one.closed.observation.empty() && one.closed.observation != unlimited;
  });
  if (gain.empty()) return;
  Clause one = clause(gain, "gains energy");
  one.value = static_cast<double>(gain.size());
  one.high = static_cast<double>(all_.size());
  answer.say(fmt::format("Impacts make energy though every spectrum is stable in {} of {} combinations: {}.",
                         gain.size(), all_.size(), one.who),
             one);
}

/// Double roots on the circle grow, though no limit shows.
void StepLimits::say_roots(say::Answer& answer) const {
  std::set<std::string> cases;
  std::string root, place;
  for (const RootRow& row : stability_roots_type().read(study_.results().derived))
    if (row.twofold && cases.insert(row.id).second && root.empty()) root = row.root, place = row.place;
  const Members members = where([&](const Limits& one) { return cases.count(one.record->id) > 0; });
  if (members.empty()) return;
  Clause one = clause(members, "double root");
  const say::SetNames::Name name = say::SetNames(study_, records(), columns_).found(members);
  answer.say(fmt::format("{} {} a double {} on the {}: it grows linearly, though no limit shows.",
                         say::capitalised(name.text), name.several ? "have" : "has", root, place),
             one);
}

}  // namespace

answers::Answer stability_answer(const answers::Compared& study) {
  answers::Answer answer;
  const StepLimits limits(study);
  if (!limits.empty()) {
    limits.say_limits(answer);
    limits.say_mesh(answer);
    limits.say_closed(answer);
    limits.say_marches(answer);
    limits.say_gains(answer);
    limits.say_roots(answer);
  }
  constexpr std::size_t most = 7;
  answer.keep(most);
  if (answer.sentences.empty()) answer.say("No limit was predicted.", Clause{.form = "status", .status = "none"});
  for (Sentence& one : answers::ended(study)) answer.say(std::move(one));
  return answer;
}

}  // namespace ricochet
