#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runners/answers/answer.hpp"
#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::answers {
namespace {

constexpr std::size_t longest_reason = 160;

/// The reason of most of these cases, without what holds for one of them alone.
struct Reasons {
  std::string most;
  std::size_t cases = 0, others = 0;
};

std::string general(const std::string& reason) {
  const std::string own = "excluded: ";
  const std::size_t from = reason.starts_with(own) ? own.size() : 0, to = reason.find("; for this case alone");
  return reason.substr(from, to == std::string::npos ? to : to - from);
}

Reasons reasons_of(const Cases& cases) {
  InOrderMet<std::string, std::size_t> counts;
  for (const CaseRecord* record : cases)
    if (const std::string reason = general(record->reason); !reason.empty()) ++counts[reason];
  Reasons out;
  for (const auto& [reason, count] : counts.list())
    if (count > out.cases) out.most = reason, out.cases = count;
  out.others = counts.list().empty() ? 0 : counts.list().size() - 1;
  return out;
}

/// A whole clause of the reason that is not too long.
std::string shortened(const std::string& reason) {
  if (reason.size() <= longest_reason) return reason;
  for (const char* end : {"; ", ": ", ", "}) {
    const std::size_t at = reason.rfind(end, longest_reason);
    if (at != std::string::npos && at > 20) return reason.substr(0, at);
  }
  return reason.substr(0, reason.rfind(' ', longest_reason)) + " …";
}

/// Every method with its cases, in the study's order.
struct Listed {
  Cases firsts;
  std::vector<Cases> cases;
};

Listed methods_of(const Compared& study) {
  InOrderMet<std::string, Cases> groups;
  for (const CaseRecord& record : study.results().cases) groups[study.key(record)].push_back(&record);
  Listed out;
  for (const auto& [key, cases] : groups.list()) {
    out.firsts.push_back(cases.front());
    out.cases.push_back(cases);
  }
  return out;
}

template <class Holds>
Members members_where(const Listed& methods, Holds holds) {
  Members out;
  for (std::size_t k = 0; k < methods.cases.size(); ++k)
    if (std::any_of(methods.cases[k].begin(), methods.cases[k].end(), holds)) out.push_back(k);
  return out;
}

Clause status_clause(const std::string& status, std::string who, std::size_t cases, std::size_t all) {
  Clause out{.form = "status", .who = std::move(who)};
  out.value = static_cast<double>(cases);
  out.high = static_cast<double>(all);
  out.status = status;
  out.unit = "cases";
  return out;
}

/// " at h = 1e-8 and 1e-9 s" where the cases are those of some steps only.
std::string at_steps(const Compared& study, const Cases& cases) {
  std::set<double> some, all;
  for (const CaseRecord* record : cases)
    if (const auto h = study.step(*record)) some.insert(*h);
  for (const CaseRecord& record : study.results().cases)
    if (const auto h = study.step(record)) all.insert(*h);
  constexpr std::size_t listed = 4;
  if (some.empty() || some.size() == all.size()) return "";
  if (some.size() > listed)
    return " at " + std::to_string(some.size()) + " of " + std::to_string(all.size()) + " steps";
  std::vector<std::string> words;
  for (auto at = some.rbegin(); at != some.rend(); ++at) words.push_back(short_number(*at));
  if (!study.varies("step")) {
    words.clear();
    for (const double size : some) words.push_back(short_number(1 / size));
    return " at " + and_list(words) + " steps per period";
  }
  return " at h = " + and_list(words) + " s";
}

/// References that the study names and that refuse: errors are those against the others.
void add_refused_references(const Compared& study, std::vector<Sentence>& out) {
  InOrderMet<std::string, std::size_t> counts;
  const std::string begins = refused_reference;
  for (const CaseRecord& record : study.results().cases)
    for (const std::string& note : record.notes)
      if (note.starts_with(begins)) ++counts[note.substr(begins.size())];
  const std::size_t total = study.results().cases.size();
  for (const auto& [refusal, cases] : counts.list()) {
    const std::string name = refusal.substr(0, refusal.find(": "));
    out.push_back({fmt::format("The reference {} does not apply{}: {}.", name,
                               cases == total ? "" : fmt::format(" to {} of {} cases", cases, total),
                               shortened(refusal.substr(std::min(refusal.size(), name.size() + 2)))),
                   {status_clause("reference refused", name, cases, total)}});
  }
}

}  // namespace

std::vector<Sentence> ended(const Compared& study) {
  std::vector<Sentence> out;
  const Listed methods = methods_of(study);
  const std::size_t total = study.results().cases.size();
  const SetNames names(study, methods.firsts);
  for (const std::string status : {"diverged", "failed", "refused"}) {
    Cases cases;
    for (const CaseRecord& record : study.results().cases)
      if (record.status == status && !record.partial) cases.push_back(&record);
    if (cases.empty()) continue;
    const Members members =
        members_where(methods, [&](const CaseRecord* one) { return one->status == status && !one->partial; });
    bool whole = true;
    for (const std::size_t k : members)
      for (const CaseRecord* one : methods.cases[k]) whole = whole && one->status == status;
    const std::string who = names.of(members) + (whole ? "" : at_steps(study, cases));
    const Reasons reasons = reasons_of(cases);
    const std::string shown = without_count(who);
    std::string text = fmt::format("{}: {} of {} case{} ({})", status == "refused" ? "Not run" : capitalised(status),
                                   cases.size(), total, total == 1 ? "" : "s", shown.empty() ? who : shown);
    // Where each case says its own figures, none speaks for the others.
    if (!reasons.most.empty() && (reasons.cases > 1 || cases.size() == 1))
      text += fmt::format(": {}{}", shortened(reasons.most),
                          reasons.others > 0 ? fmt::format(" ({} of these; {} other reason{})", reasons.cases,
                                                           reasons.others, reasons.others == 1 ? "" : "s")
                                             : "");
    if (!text.ends_with('.') && !text.ends_with("…")) text += ".";
    out.push_back({text, {status_clause(status, who, cases.size(), total)}});
  }
  add_refused_references(study, out);
  return out;
}

std::vector<Sentence> status(const Compared& study) {
  std::vector<Sentence> out;
  const StudyResults& results = study.results();
  const Cases all = all_cases(results);
  const Cases done = with_status(all, "done"), refused = with_status(all, "refused");
  Cases wrong;
  for (const CaseRecord* record : all)
    if (went_wrong(*record)) wrong.push_back(record);
  const Listed methods = methods_of(study);
  const SetNames names(study, methods.firsts);
  if (wrong.empty())
    out.push_back({done.size() == all.size()
                       ? fmt::format("All {} cases run.", all.size())
                       : fmt::format("Everything that applies runs: {} of {} cases, none diverges or fails.",
                                     done.size(), all.size()),
                   {status_clause("done", "", done.size(), all.size())}});
  else {
    Sentence said{fmt::format("{} of {} cases run; ", done.size(), all.size()),
                  {status_clause("done", "", done.size(), all.size())}};
    std::vector<std::string> parts;
    for (const auto& [ending, verb] : {std::pair{"diverged", "diverge"}, std::pair{"failed", "fail"}}) {
      const Cases own = with_status(wrong, ending);
      if (own.empty()) continue;
      const std::string who = names.of(members_where(methods, [&](const CaseRecord* one) {
        return one->status == ending && went_wrong(*one);
      })) + at_steps(study, own);
      const std::string shown = without_count(who);
      parts.push_back(fmt::format("{} {}{}{}", own.size(), verb, own.size() == 1 ? "s" : "",
                                  shown.empty() ? "" : " (" + shown + ")"));
      said.clauses.push_back(status_clause(ending, who, own.size(), all.size()));
    }
    said.text += and_names(parts) + ".";
    out.push_back(std::move(said));
  }
  // By reason, without what a colon explains.
  InOrderMet<std::string, Cases> reasons;
  for (const CaseRecord* record : refused) {
    const std::string reason = general(record->reason);
    reasons[reason.substr(0, reason.find(": "))].push_back(record);
  }
  std::vector<std::pair<std::string, Cases>> by_size = reasons.list();
  std::stable_sort(by_size.begin(), by_size.end(),
                   [](const auto& a, const auto& b) { return a.second.size() > b.second.size(); });
  constexpr std::size_t told = 2;
  std::size_t left = 0;
  for (std::size_t k = 0; k < by_size.size(); ++k) {
    const auto& [reason, cases] = by_size[k];
    if (k >= told) {
      left += cases.size();
      continue;
    }
    const std::set<const CaseRecord*> members(cases.begin(), cases.end());
    const std::string who =
        names.of(members_where(methods, [&](const CaseRecord* one) { return members.count(one) > 0; }));
    const std::string shown = without_count(who);
    out.push_back(
        {fmt::format("Refused: {}{}: {}.", cases.size(), shown.empty() ? "" : ", " + shown, shortened(reason)),
         {status_clause("refused", who, cases.size(), all.size())}});
  }
  if (left > 0)
    out.push_back({fmt::format("Refused for {} other reason{}: {} cases.", by_size.size() - told,
                               by_size.size() == told + 1 ? "" : "s", left),
                   {status_clause("refused", "", left, all.size())}});
  return out;
}

}  // namespace ricochet::answers
