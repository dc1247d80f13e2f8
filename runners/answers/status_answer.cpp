#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runners/answers/answer.hpp"
#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/answers/thirty_words.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::answers {
namespace {

/// Every method with its cases, in the study's order.
struct Listed {
  Cases firsts;
  std::vector<Cases> cases;
};

Listed methods_of(const Choices& study) {
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
std::string at_steps(const Choices& study, const Cases& cases) {
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

/// "Doubtful: 4 of 48 cases (those with …): why."
Sentence told_of(const Choices& study, const Listed& methods, const SetNames& names, const Doubt& doubt) {
  const Cases& some = doubt.cases;
  const std::size_t total = study.results().cases.size();
  const std::set<const CaseRecord*> chosen(some.begin(), some.end());
  const Members members = members_where(methods, [&](const CaseRecord* one) { return chosen.contains(one); });
  bool whole = true;
  for (const std::size_t k : members)
    for (const CaseRecord* one : methods.cases[k]) whole = whole && chosen.contains(one);
  const std::string who = names.of(members) + (whole ? "" : at_steps(study, some));
  const std::string own = without_count(who).empty() ? who : without_count(who);
  // The fullest name that thirty words hold.
  std::string text;
  for (const std::string& shown : {own, names.shared(members), std::string()}) {
    const std::string must = fmt::format("Doubtful: {} of {} case{}{}", some.size(), total, total == 1 ? "" : "s",
                                         some.size() == total || shown.empty() ? "" : " (" + shown + ")");
    text = with_reason(must, doubt.text, doubt.differs ? ", in the first of them" : "");
    if (fits(text)) break;
  }
  return {text, {status_clause("doubtful", who, some.size(), total)}};
}

}  // namespace

std::vector<Doubt> doubts_of(const StudyResults& results) {
  InOrderMet<std::string, Doubt> kinds;
  for (const CaseRecord& record : results.cases) {
    if (record.partial || record.status != Status::done) continue;
    for (const Said& doubt : record.reasons) {
      Doubt& one = kinds[doubt.without_numbers()];
      if (one.cases.empty()) one.text = doubt.text;
      one.differs = one.differs || doubt.text != one.text;
      one.cases.push_back(&record);
    }
  }
  std::vector<Doubt> out;
  for (auto& [key, doubt] : std::move(kinds).list()) out.push_back(std::move(doubt));
  return out;
}

std::vector<Sentence> doubted(const Choices& study) {
  constexpr std::size_t most = 4;
  const std::vector<Doubt> doubts = doubts_of(study.results());
  std::vector<Sentence> out;
  if (doubts.empty()) return out;
  const Listed methods = methods_of(study);
  const SetNames names(study, methods.firsts);
  const std::size_t told = doubts.size() <= most ? doubts.size() : most - 1;
  for (std::size_t k = 0; k < told; ++k) out.push_back(told_of(study, methods, names, doubts[k]));
  if (told < doubts.size())
    out.push_back({fmt::format("{} more doubts are in reasons.csv.", doubts.size() - told),
                   {status_clause("doubtful", "", 0, study.results().cases.size())}});
  return out;
}

std::vector<Sentence> refused_references(const Choices& study) {
  std::vector<Sentence> out;
  InOrderMet<std::string, std::size_t> counts;
  const std::string begins = refused_reference;
  for (const CaseRecord& record : study.results().cases)
    for (const std::string& note : record.notes)
      if (note.starts_with(begins)) ++counts[note.substr(begins.size())];
  const std::size_t total = study.results().cases.size();
  for (const auto& [refusal, cases] : counts.list()) {
    const std::string name = refusal.substr(0, refusal.find(": "));
    const std::string must = fmt::format("The reference {} does not apply{}", name,
                                         cases == total ? "" : fmt::format(" to {} of {} cases", cases, total));
    out.push_back({with_reason(must, refusal.substr(std::min(refusal.size(), name.size() + 2))),
                   {status_clause("reference refused", name, cases, total)}});
  }
  return out;
}

}  // namespace ricochet::answers
