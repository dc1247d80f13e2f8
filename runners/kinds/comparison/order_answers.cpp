#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <ricochet/measure/statistics/refinement.hpp>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

using namespace answers;
using Verdict = OrderRun::Verdict;

constexpr double order_agrees = 0.35;

/// The error that is spoken of first: the root mean square error of the tip, else the first.
std::string headline(const std::vector<std::string>& errors) {
  const bool mean = std::find(errors.begin(), errors.end(), "tip-l2") != errors.end();
  return mean || errors.empty() ? "tip-l2" : errors.front();
}

std::string error_unit(const std::string& error) {
  if (error.starts_with("tip")) return "m";
  if (error == "energy") return "J";
  if (error == "impact-times") return "s";
  return error == "impulse" ? "N s" : "";
}

class OrderSpeaker {
 public:
  OrderSpeaker(const Compared& study, std::vector<MethodRun> runs, std::string error, std::string refined)
      : study_(study),
        runs_(std::move(runs)),
        error_(std::move(error)),
        refined_(std::move(refined)),
        names_(study, firsts()) {}

  void say(Answer& answer) const;

 private:
  Cases firsts() const {
    Cases out;
    for (const MethodRun& one : runs_) out.push_back(one.cases.front());
    return out;
  }
  Members members(Verdict verdict) const {
    Members out;
    for (std::size_t k = 0; k < runs_.size(); ++k)
      if (this->verdict(k) == verdict) out.push_back(k);
    return out;
  }
  /// Beside orders that last, one met in passing is one of these or none.
  Verdict verdict(std::size_t k) const;
  std::vector<Members> order_groups() const;
  Clause clause(const std::string& form, const Members& members) const {
    Clause out{.form = form, .measure = "error." + error_, .choice = refined_, .who = names_.of(members)};
    for (const std::size_t k : members) out.methods += (out.methods.empty() ? "" : " ") + runs_[k].finest->id;
    return out;
  }
  std::string where() const;
  std::string errors_text(const Members& members, bool stops) const;
  Clause errors_clause(const Members& members, const char* status) const;

  const Compared& study_;
  std::vector<MethodRun> runs_;
  std::string error_, refined_;
  SetNames names_;
};

std::string OrderSpeaker::where() const {
  const CaseRecord& any = *runs_.front().finest;
  if (refined_ == "step" && study_.varies(study_.mesh_column()) && study_.elements(any))
    return ", on " + study_.mesh_words(*study_.elements(any));
  if (refined_ == "elements" && study_.varies("step") && study_.step(any))
    return ", at " + study_.step_words(*study_.step(any));
  return "";
}

/// "1e-8 to 5e-8 m (0.5 to 1.2 % of the motion)".
std::string OrderSpeaker::errors_text(const Members& members, bool stops) const {
  double low = INFINITY, high = 0, low_share = INFINITY, high_share = 0;
  bool shares = true;
  for (const std::size_t k : members) {
    const double value = stops ? runs_[k].run.stops_at.value_or(runs_[k].run.last) : runs_[k].run.last;
    low = std::min(low, value);
    high = std::max(high, value);
    shares = shares && runs_[k].motion.has_value();
    if (runs_[k].motion)
      low_share = std::min(low_share, value / *runs_[k].motion),
      high_share = std::max(high_share, value / *runs_[k].motion);
  }
  const std::string unit = error_unit(error_).empty() ? "" : " " + error_unit(error_);
  constexpr double apart = 1.5;
  std::string text = short_number(low, 2) + (high > apart * low ? " to " + short_number(high, 2) : "") + unit;
  if (shares && low_share < 10)
    text += fmt::format(" ({}{} of the motion)", high_share > apart * low_share ? percent(low_share) + " to " : "",
                        percent(high_share));
  return text;
}

Clause OrderSpeaker::errors_clause(const Members& members, const char* status) const {
  Clause out = clause("order", members);
  out.status = status;
  out.unit = error_unit(error_);
  for (const std::size_t k : members) {
    const double value = runs_[k].run.stops_at.value_or(runs_[k].run.last);
    out.low = std::min(out.low.value_or(value), value);
    out.high = std::max(out.high.value_or(value), value);
  }
  return out;
}

Verdict OrderSpeaker::verdict(std::size_t k) const {
  const OrderRun& run = runs_[k].run;
  if (run.verdict != Verdict::order || !run.in_passing) return run.verdict;
  constexpr double steep = 1.5, near = 0.02, near_steep = 0.35;
  bool others = false, like = false;
  for (const MethodRun& one : runs_) {
    if (one.run.verdict != Verdict::order || one.run.in_passing) continue;
    others = true;
    like = like || std::abs(one.run.order - run.order) <= (run.order > steep ? near_steep : near);
  }
  if (like || !others) return run.verdict;
  return run.stops_at ? Verdict::stops : Verdict::no_steady_order;
}

/// Methods whose orders follow each other closely, the highest first. Those that have no name together part where the
/// orders are farthest apart and both parts have one.
std::vector<Members> OrderSpeaker::order_groups() const {
  Members sorted = members(Verdict::order);
  std::sort(sorted.begin(), sorted.end(),
            [&](std::size_t a, std::size_t b) { return runs_[a].run.order > runs_[b].run.order; });
  std::vector<Members> groups;
  constexpr double gap = 0.2, steep = 1.5, steep_gap = 0.35, least_gap = 0.04;
  for (const std::size_t k : sorted) {
    const double order = runs_[k].run.order, apart = order > steep ? steep_gap : gap;
    if (groups.empty() || runs_[groups.back().back()].run.order - order > apart) groups.emplace_back();
    groups.back().push_back(k);
  }
  const auto named = [&](Members of) {
    std::sort(of.begin(), of.end());
    return names_.found(of).exact;
  };
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Members of = groups[g];
    if (of.size() < 2 || named(of)) continue;
    std::vector<std::size_t> cuts;
    const auto step = [&](std::size_t k) { return runs_[of[k - 1]].run.order - runs_[of[k]].run.order; };
    for (std::size_t k = 1; k < of.size(); ++k)
      if (step(k) >= least_gap) cuts.push_back(k);
    std::sort(cuts.begin(), cuts.end(), [&](std::size_t a, std::size_t b) { return step(a) > step(b); });
    for (const std::size_t cut : cuts) {
      const auto middle = of.begin() + static_cast<std::ptrdiff_t>(cut);
      const Members upper(of.begin(), middle), lower(middle, of.end());
      if (!named(upper) || !named(lower)) continue;
      groups[g] = upper;
      groups.insert(groups.begin() + static_cast<std::ptrdiff_t>(g) + 1, lower);
      break;
    }
  }
  for (Members& of : groups) std::sort(of.begin(), of.end());
  return groups;
}

void OrderSpeaker::say(Answer& answer) const {
  const std::string word = refined_ == "step" ? "step" : "mesh";
  const std::string subject = fmt::format("In the {}{}, {}", word, where(), error_words(error_));
  const std::vector<Members> groups = order_groups();
  Sentence orders;
  constexpr std::size_t told = 4;
  std::size_t said = 0;
  for (const Members& of : groups) {
    Clause one = clause("order", of);
    one.status = "order";
    std::vector<double> fitted;
    bool all_declare = true, contradicted = false;
    for (const std::size_t k : of) {
      fitted.push_back(runs_[k].run.order);
      all_declare = all_declare && runs_[k].declared.has_value();
      contradicted =
          contradicted || (runs_[k].declared && std::abs(runs_[k].run.order - *runs_[k].declared) > order_agrees);
    }
    const auto [least, most] = std::minmax_element(fitted.begin(), fitted.end());
    const double order = order_class(median(fitted));
    one.value = median(fitted);
    one.low = *least;
    one.high = *most;
    orders.clauses.push_back(one);
    if (said++ >= told) continue;
    const std::string low = fmt::format("{:.2f}", *least), high = fmt::format("{:.2f}", *most);
    const bool one_class = order_class(*least) == order && order_class(*most) == order;
    const std::string range = low == high ? low : low + " to " + high;
    std::string text = one_class ? fmt::format("order {} ({}) with {}", fraction_text(order), range, one.who)
                                 : fmt::format("order {} with {}", range, one.who);
    if (all_declare && !contradicted && refined_ == "step") text += ", as declared";
    if (contradicted) {
      Members off;
      for (const std::size_t k : of)
        if (runs_[k].declared && std::abs(runs_[k].run.order - *runs_[k].declared) > order_agrees) off.push_back(k);
      text += off.size() == of.size()
                  ? fmt::format(", which declare{} another", off.size() == 1 ? "s" : "")
                  : fmt::format(", where {} declare{} another", names_.of(off), off.size() == 1 ? "s" : "");
    }
    orders.text += (orders.text.empty() ? "" : "; ") + text;
  }
  if (!orders.text.empty()) {
    orders.text =
        fmt::format("{} falls with {}{}.", subject, orders.text, groups.size() > told ? "; others in the table" : "");
    answer.say(std::move(orders));
  }
  const bool begun = !groups.empty();
  // Who ends at a level: it is reached after a fall, or there from the coarsest size on.
  Members stuck;
  constexpr double far_off = 0.1;
  Members lost;
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    const OrderRun& run = runs_[k].run;
    if (!run.stops_at) continue;
    (runs_[k].motion && run.smallest > far_off * *runs_[k].motion ? lost : stuck).push_back(k);
  }
  if (!stuck.empty()) {
    // Most of all, and without a name: those that are not told by themselves.
    const SetNames::Name name = names_.found(stuck);
    const bool most = !name.exact && 2 * stuck.size() > runs_.size();
    const std::string who = most ? fmt::format("the other {} methods", stuck.size()) : name.text;
    answer.say({fmt::format("{} stops at {} with {}: what is left is not of the {}.", begun ? "It" : subject,
                            errors_text(stuck, true), who, word),
                {errors_clause(stuck, "stops")}});
  }
  if (!lost.empty()) {
    const SetNames::Name name = names_.found(lost);
    answer.say({fmt::format("{} {} not converge in the {}: the error is {}.", capitalised(name.text),
                            name.several ? "do" : "does", word, errors_text(lost, true)),
                {errors_clause(lost, "does not fall")}});
  }
  if (const Members vague = members(Verdict::no_steady_order); !vague.empty())
    answer.say({fmt::format("No steady order in the {}: {}; the error is {} at the finest.", word, names_.of(vague),
                            errors_text(vague, false)),
                {errors_clause(vague, "no steady order")}});
  if (const Members floor = members(Verdict::below_floor); !floor.empty())
    answer.say({fmt::format("At the floor of the reference throughout: {}.", names_.of(floor)),
                {errors_clause(floor, "at the floor")}});
}

/// Which other errors show the same orders.
void say_other_errors(const Compared& study, const std::vector<std::string>& errors, const std::string& first,
                      Answer& answer) {
  const auto classes_of = [&](const std::string& error) {
    std::map<std::string, double> out;
    for (const MethodRun& one : runs_of(study, error, "step"))
      if (one.run.verdict == Verdict::order) out[study.key(*one.cases.front())] = order_class(one.run.order);
    return out;
  };
  const auto base = classes_of(first);
  if (base.empty()) return;
  std::vector<std::string> same, others;
  constexpr double enough = 0.3, agree = 0.8;
  for (const std::string& error : errors) {
    if (error == first) continue;
    std::size_t both = 0, equal = 0;
    for (const auto& [key, order] : classes_of(error))
      if (const auto found = base.find(key); found != base.end()) ++both, equal += found->second == order;
    if (both < 1 || static_cast<double>(both) < enough * static_cast<double>(base.size())) continue;
    const bool alike = static_cast<double>(equal) >= agree * static_cast<double>(both);
    std::vector<std::string>& list = alike ? same : others;
    const std::string words = quantity_words(error);
    if (words != quantity_words(first) && std::find(list.begin(), list.end(), words) == list.end())
      list.push_back(words);
  }
  const auto clause = [&](const std::vector<std::string>& names, const char* status) {
    Clause out{.form = "order", .measure = "errors", .choice = "step", .who = and_list(names)};
    out.status = status;
    return out;
  };
  if (!same.empty())
    answer.say({fmt::format("The same orders show in the errors of {}{}.", and_list(same),
                            others.empty() ? "" : "; others in " + and_list(others)),
                {clause(same, "the same orders")}});
  else if (!others.empty())
    answer.say(
        {fmt::format("Other orders show in the errors of {}.", and_list(others)), {clause(others, "other orders")}});
}

}  // namespace

answers::Answer orders_answer(const Compared& study) {
  Answer answer;
  const std::vector<std::string> errors = errors_of(study.results());
  const std::string error = headline(errors);
  for (const char* refined : {"step", "elements"}) {
    if (!study.varies(refined)) continue;
    std::vector<MethodRun> runs = runs_of(study, error, refined);
    if (!runs.empty()) OrderSpeaker(study, std::move(runs), error, refined).say(answer);
  }
  if (study.varies("step")) say_other_errors(study, errors, error, answer);
  answer.keep(sentences_at_most);
  if (answer.sentences.empty())
    answer.say("No case has an error to speak of.", Clause{.form = "status", .status = "none"});
  for (Sentence& one : ended(study)) answer.say(std::move(one));
  return answer;
}

}  // namespace ricochet
