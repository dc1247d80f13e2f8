#include <fmt/format.h>

#include <algorithm>

#include "runners/answers/answer.hpp"
#include "runners/asks/lines.hpp"
#include "runners/asks/verbs.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::asks {
namespace {

struct Ending {
  std::string status, reason;
  bool done = false, alike = true;  // whether the reason is that of each, or has the numbers of the first
  std::vector<const CaseRecord*> cases = {};
  std::string of_first(const std::string& text) const { return (alike ? "" : "the first: ") + text; }
};

/// How cases ended, by status and reason; those that differ in numbers alone are one.
std::vector<Ending> endings(const Cases& cases) {
  InOrderMet<std::string, Ending> out;
  for (const CaseRecord* record : cases) {
    const std::string status = record->partial ? "running" : word(record->status);
    const bool done = !record->partial && record->status == Status::done;
    Ending& ending = out[done ? status : ending_key(*record)];
    const std::string reason = done ? "" : record->reason();
    if (ending.cases.empty()) ending = {.status = status, .reason = reason, .done = done};
    ending.alike = ending.alike && ending.reason == reason;
    ending.cases.push_back(record);
  }
  std::vector<Ending> list;
  for (auto& [key, one] : std::move(out).list()) list.push_back(std::move(one));
  return list;
}

Answered answer_runs(const Ask& ask, const Evidence& evidence) {
  const Cases cases = evidence.cases(ask);
  Answered out;
  out.cases = cases.size();
  std::size_t done = 0, wrong = 0;
  std::vector<std::string> others;
  InOrderMet<std::string, std::size_t> by_status;
  for (const Ending& one : endings(cases)) {
    VerdictRow row;
    row.level = one.status;
    row.value = static_cast<double>(one.cases.size());
    row.unit = "1";
    row.verdict = one.status;
    row.reason = one.of_first(one.reason);
    row.cases = one.cases.size();
    out.rows.push_back(std::move(row));
    if (one.done)
      done += one.cases.size();
    else {
      others.push_back(fmt::format("{} {} ({})", one.cases.size(), one.status, one.of_first(short_reason(one.reason))));
      by_status[one.status] += one.cases.size();
      wrong += went_wrong(*one.cases.front()) ? one.cases.size() : 0;
    }
  }
  VerdictRow all;
  all.level = "all";
  all.value = static_cast<double>(cases.size());
  all.unit = "1";
  all.cases = cases.size();
  out.rows.push_back(std::move(all));
  out.passes = done == cases.size() ? Verdict::yes : wrong > 0 ? Verdict::no : Verdict::open;
  // What is refused was never to run.
  out.verdict = done == cases.size() ? "yes" : wrong > 0 ? "no" : "some refused";
  if (done == cases.size()) {
    out.sentence = fmt::format("Yes: all {} cases run.", done);
    return out;
  }
  const auto with = [&](const std::vector<std::string>& rest) {
    return fmt::format("{} of {} cases run; {}.", done, cases.size(), some_of(rest));
  };
  out.sentence = with(others);
  if (fits(out.sentence)) return out;
  std::vector<std::string> counts;
  for (const auto& [status, count] : by_status.list()) counts.push_back(fmt::format("{} {}", count, status));
  out.sentence = with(counts);
  return out;
}

void check_runs(const Ask& ask, const Study&) {
  if (!ask.keys.at("runs").get<bool>()) throw InputError(ask.pointer(), "false asks nothing; expected true");
}

}  // namespace

const Verb& runs_verb() {
  static const Verb verb = [] {
    Field key = keys::of_form(Field::Form::scalar, "runs", std::nullopt, "true.");
    key.spec.type = ParameterSpec::Type::boolean;
    return Verb{"runs", "What becomes of the cases, and why.", {std::move(key)}, "", check_runs, {}, answer_runs};
  }();
  return verb;
}

}  // namespace ricochet::asks
