// The verb `order`: how an error falls with the step and with the mesh, method by method.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/report/quantity.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

using Run = OrderRun::Verdict;

/// What is found of one method.
enum class Found { clean, none, unclear, hidden, absent };

const char* found_word(Found found) {
  constexpr const char* words[] = {"clean", "none", "unclear", "hidden", "no error"};
  return words[static_cast<int>(found)];
}

struct Method {
  const CaseRecord* first = nullptr;
  std::optional<MethodRun> run = {};  ///< nothing where no two sizes have an error
  Found found = Found::absent;
  std::string reason = {};
};

Found found_in(const MethodRun& one) {
  switch (one.run.verdict) {
    case Run::order:
      return one.clean() ? Found::clean : Found::unclear;
    case Run::stops:
    case Run::does_not_fall:
    case Run::no_steady_order:
      return Found::none;
    default:
      return Found::hidden;
  }
}

constexpr double orders_agree = 0.35;

/// Whether a clean order in the step is less than the one that the scheme declares.
bool below_declared(const Method& method) {
  const auto& declared = method.run->declared.order;
  return method.found == Found::clean && declared && method.run->run.order < *declared - orders_agree;
}

class OrderAsk {
 public:
  OrderAsk(const asks::Ask& ask, const asks::Evidence& evidence)
      : evidence_(evidence), study_(evidence.study()), error_(error_name(ask.subject())), cases_(evidence.cases(ask)) {
    const MeasureInfo* info = measure_info("error." + error_);
    unit_ = info ? info->unit : "";
  }

  asks::Answered answer() {
    asks::Answered out;
    const std::string measure_name = "error." + error_;
    const asks::LeftOut left = evidence_.left_out(measure_name, cases_);
    out.left_out = left.count;
    out.cases = cases_.size() - left.count;
    out.aside = left.told();
    std::vector<asks::Verdict> verdicts;
    std::vector<std::vector<std::string>> said;
    Json series = Json::array();
    std::vector<std::string> refined;
    for (const char* one : {"step", "elements"})
      if (sizes(one) >= 3) refined.emplace_back(one);
    std::set<std::string> words;
    std::size_t below = 0;
    for (const std::string& one : refined) {
      const std::vector<Method> methods = methods_along(one);
      const std::string beside = refined.size() > 1 ? (one == "step" ? "in the step" : "in the mesh") : "";
      for (const Method& method : methods) {
        add_row(out, method, beside);
        words.insert(found_word(method.found));
        const bool less = one == "step" && below_declared(method);
        below += less ? 1 : 0;
        verdicts.push_back(method.found == Found::none || less ? asks::Verdict::no
                           : method.found == Found::clean      ? asks::Verdict::yes
                                                               : asks::Verdict::open);
        if (one == refined.front()) add_series(series, method);
      }
      said.push_back(texts(methods, one, refined.size() > 1));
    }
    if (said.empty()) {
      out.reason = "no three sizes have an error";
      out.sentence = fmt::format("Open: no order shows in {}: {}.", error_words(error_), out.reason);
    } else {
      std::vector<std::string> sentences;
      for (std::size_t k = 0; k < said.front().size(); ++k) {
        std::string text;
        for (const auto& one : said) text += (text.empty() ? "" : " ") + one[k];
        sentences.push_back(std::move(text));
      }
      out.sentence = asks::fitting(sentences);
      const std::string less = below == 0 ? ""
                               : said.size() == 1 && out.rows.size() == 1
                                   ? ", less than the scheme declares"
                                   : fmt::format(", less than declared with {}", below);
      if (!less.empty() && asks::fits(out.sentence + less))
        out.sentence = out.sentence.substr(0, out.sentence.size() - 1) + less + ".";
    }
    out.passes = verdicts.empty() ? asks::Verdict::open : asks::all_of(verdicts);
    out.verdict = words.empty() ? "open" : words.size() == 1 ? *words.begin() : "in part";
    for (std::string& one : reference_words(cases_)) out.aside.push_back(std::move(one));
    if (!refined.empty()) {
      const bool step = refined.front() == "step";
      out.figure = {{"form", "curves"},
                    {"x", step ? "step" : "1 over the elements"},
                    {"x_unit", step ? "s" : "1"},
                    {"y", error_words(error_)},
                    {"y_unit", unit_},
                    {"log", true},
                    {"series", series}};
    }
    return out;
  }

 private:
  std::size_t sizes(const std::string& refined) const {
    std::set<std::string> all;
    for (const CaseRecord* one : cases_)
      if (const std::string& text = study_.text(*one, refined); !text.empty()) all.insert(text);
    return all.size();
  }

  std::vector<Method> methods_along(const std::string& refined) const {
    InOrderMet<std::string, Method> out;
    for (const CaseRecord* one : cases_)
      if (Method& method = out[study_.key(*one)]; !method.first) method.first = one;
    for (MethodRun& run : runs_of(study_, cases_, error_, refined)) {
      Method& method = out[study_.key(*run.finest)];
      method.found = found_in(run);
      method.reason = reason(run, refined);
      method.run = std::move(run);
    }
    std::vector<Method> list;
    for (auto& [key, method] : std::move(out).list()) {
      if (!method.run) {
        Cases own;
        for (const CaseRecord* one : cases_)
          if (study_.key(*one) == key) own.push_back(one);
        const asks::LeftOut left = evidence_.left_out("error." + error_, own);
        method.reason = left.reasons.empty() ? "one size" : left.reasons.front().said();
      }
      list.push_back(std::move(method));
    }
    return list;
  }

  std::string with_unit(double value) const { return short_number(value, 2) + (unit_.empty() ? "" : " " + unit_); }

  std::string reason(const MethodRun& one, const std::string& refined) const {
    const OrderRun& run = one.run;
    std::string share;
    if (run.stops_at && one.motion) share = ", " + answers::percent(*run.stops_at / *one.motion) + " of the motion";
    std::vector<std::string> parts;
    switch (run.verdict) {
      case Run::order:
        if (!one.clean())
          parts.push_back(run.length == 2 && run.order > OrderRun::steepest_of_two
                              ? "two slopes alone, steeper than a scheme's"
                              : fmt::format("{} of {} slopes agree", run.length, run.slopes.size()));
        else if (!run.beyond.empty())
          parts.push_back(fmt::format("{:.2f} once at finer sizes", run.beyond.front()));
        if (run.stops_at) parts.push_back("the least error is " + with_unit(*run.stops_at) + share);
        if (const auto& declared = one.declared.order; refined == "step" && declared)
          parts.push_back(!one.declared.because.empty() ? one.declared.because
                          : std::abs(run.order - *declared) <= orders_agree
                              ? "as declared"
                              : "the scheme declares " + fraction_text(*declared));
        break;
      case Run::stops:
        parts.push_back("the least error is " + with_unit(run.smallest) + share);
        break;
      case Run::does_not_fall:
        parts.push_back("the error does not fall: " + with_unit(run.last) + " at the finest");
        break;
      case Run::no_steady_order:
        parts.emplace_back("slopes do not agree");
        break;
      case Run::below_floor:
        parts.push_back(measure(*one.finest, "floor." + error_).value_or(0) < one.floor
                            ? "errors are round-off, up to " + with_unit(one.floor)
                            : "the floor of the reference, " + with_unit(one.floor) + ", hides it");
        break;
      case Run::too_few:
        parts.push_back(one.errors.size() < 3 ? fmt::format("{} sizes have an error", one.errors.size())
                                              : "fewer than three errors above their floor, " + with_unit(one.floor));
        break;
    }
    return fmt::format("{}", fmt::join(parts, "; "));
  }

  void add_row(asks::Answered& out, const Method& method, const std::string& beside) const {
    asks::VerdictRow row;
    row.measure = "error." + error_;
    row.level = study_.words(*method.first, study_.columns());
    if (!beside.empty()) row.level += (row.level.empty() ? "" : ", ") + beside;
    row.unit = "1";
    row.verdict = found_word(method.found);
    row.reason = method.reason;
    std::size_t all = 0;
    for (const CaseRecord* one : cases_) all += study_.key(*one) == study_.key(*method.first);
    row.cases = method.run ? method.run->errors.size() : 0;
    row.left_out = all - *row.cases;
    if (method.run && method.run->run.verdict == Run::order) {
      row.value = method.run->run.order;
      row.low = std::min(method.run->run.least, *row.value);
      row.high = std::max(method.run->run.most, *row.value);
    }
    out.rows.push_back(std::move(row));
  }

  void add_series(Json& series, const Method& method) const {
    if (!method.run) return;
    Json points = Json::array();
    for (const SizedValue& one : method.run->errors)
      if (one.value > method.run->floor) points.push_back({one.size, one.value});
    series.push_back({{"name", study_.words(*method.first, study_.columns())}, {"points", points}});
    if (method.run->floor > 0) series.back()["floor"] = method.run->floor;
  }

  /// The sentence on one refinement, the fullest first.
  std::vector<std::string> texts(const std::vector<Method>& methods, const std::string& refined, bool of_two) const {
    Cases firsts;
    std::map<double, Members, std::greater<>> orders;
    std::map<Found, Members> others;
    for (std::size_t k = 0; k < methods.size(); ++k) {
      firsts.push_back(methods[k].first);
      if (methods[k].found == Found::clean)
        orders[order_class(methods[k].run->run.order)].push_back(k);
      else
        others[methods[k].found].push_back(k);
    }
    const answers::SetNames names(study_, firsts);
    const auto range = [&](const Members& of) {
      double low = INFINITY, high = -INFINITY;
      for (const std::size_t k : of) {
        low = std::min(low, methods[k].run->run.order);
        high = std::max(high, methods[k].run->run.order);
      }
      const std::string a = fmt::format("{:.2f}", low), b = fmt::format("{:.2f}", high);
      return a == b ? a : a + " to " + b;
    };
    // With names, with the count of the largest part, with counts.
    std::size_t largest = 0;
    for (const auto& [order, of] : orders) largest = std::max(largest, of.size());
    for (const auto& [found, of] : others) largest = std::max(largest, of.size());
    const auto who = [&](const Members& of, int brief) {
      if (methods.size() == 1) return std::string();
      if (of.size() == methods.size()) return std::string(" with every method");
      const bool counted = brief == 2 || (brief == 1 && of.size() == largest && of.size() > 1);
      return " with " + (counted ? fmt::format("{} of {} methods", of.size(), methods.size()) : names.of(of));
    };
    const std::string subject = answers::capitalised(short_error_words(error_)) + (refined != "step" ? ", in the mesh"
                                                                                   : of_two          ? ", in the step"
                                                                                                     : "");
    std::vector<std::string> out;
    for (const int brief : {0, 1, 2}) {
      std::vector<std::string> parts;
      for (const auto& [order, of] : orders)
        parts.push_back((parts.empty() ? "order " : "") + range(of) + who(of, brief));
      std::vector<std::string> clauses;
      if (!parts.empty()) clauses.push_back(fmt::format("{}", fmt::join(parts, ", ")));
      for (const auto& [found, of] : others)
        clauses.push_back((found == Found::none      ? "no order"
                           : found == Found::unclear ? "unclear"
                           : found == Found::hidden  ? "the floor or too few sizes hide it"
                           : brief == 0              ? "no error (" + methods[of.front()].reason + ")"
                                                     : "no error") +
                          who(of, brief));
      out.push_back(fmt::format("{}: {}.", subject, fmt::join(clauses, "; ")));
    }
    // Counts of what is clean, unclear, none.
    std::vector<std::string> counts;
    Members clean;
    for (const auto& [order, of] : orders) clean.insert(clean.end(), of.begin(), of.end());
    if (!clean.empty())
      counts.push_back(
          fmt::format("a clean order with {} of {} methods, {}", clean.size(), methods.size(), range(clean)));
    for (const auto& [found, of] : others) counts.push_back(fmt::format("{} with {}", found_word(found), of.size()));
    out.push_back(fmt::format("{}: {}.", subject, fmt::join(counts, "; ")));
    // Of two refinements the subject once, and of each what is clean and what is none.
    std::string brief = fmt::format("{}clean with {} of {}",
                                    refined == "step" ? subject + ": " : "In the mesh: ", clean.size(), methods.size());
    if (!clean.empty()) brief += ", " + range(clean);
    if (const auto none = others.find(Found::none); none != others.end())
      brief += fmt::format("; none with {}", none->second.size());
    out.push_back(brief + ".");
    return out;
  }

  const asks::Evidence& evidence_;
  const Choices& study_;
  std::string error_, unit_;
  Cases cases_;
};

}  // namespace

asks::Answered order_ask(const asks::Ask& ask, const asks::Evidence& evidence) {
  return OrderAsk(ask, evidence).answer();
}

}  // namespace ricochet
