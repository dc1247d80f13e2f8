#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/answers/measure_answer.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"

// What a study's measures cannot say.
namespace ricochet::answers {
namespace {

/// Why a case that ran has no value of a measure.
std::string why_blank(const MeasureWords& words, const CaseRecord& record) {
  for (const auto& [item, reason] : record.left_out)
    if (item == words.measure) return reason;
  const bool of_energy = words.scale == "energy_brought_in" || words.most;
  if (!of_energy) return "";
  // Works are known together or not at all.
  if (!measure(record, "work_of_damping")) return "the scheme declares no work form, and works are not known";
  if (!measure(record, "energy_left")) return "the motion has no energy to lose";
  return "";
}

}  // namespace

std::vector<Sentence> say_without_value(const Compared& study, const std::vector<MeasureLimits>& measures) {
  struct Blank {
    Members members;
    std::string reason;
    std::vector<std::string> names;
    std::vector<Clause> clauses;
  };
  std::vector<Sentence> out;
  InOrderMet<std::string, Blank> blanks;
  for (const MeasureLimits& limits : measures) {
    Cases firsts;
    for (const Method& method : limits.methods) firsts.push_back(&method.first());
    InOrderMet<std::string, Members> reasons;
    for (const Method* method : limits.without_value())
      reasons[why_blank(limits.words, *with_status(method->cases, "done").front())].push_back(
          static_cast<std::size_t>(method - limits.methods.data()));
    for (const auto& [reason, members] : reasons.list()) {
      const SetNames names(study, firsts);
      const bool all = members.size() == firsts.size();
      const SetNames::Name name = all ? SetNames::Name{"no case", false, true} : names.found(members);
      Blank& one = blanks[reason + '\n' + name.text];
      one.reason = reason;
      one.names.push_back(limits.words.words);
      Clause clause{.form = "status", .measure = limits.words.measure, .who = name.text};
      clause.status = "no value";
      one.clauses.push_back(std::move(clause));
      one.members = all ? Members() : members;
    }
  }
  for (const auto& [key, one] : blanks.list()) {
    const std::string who = key.substr(key.find('\n') + 1), why = one.reason.empty() ? "" : ": " + one.reason;
    out.push_back({one.members.empty()
                       ? fmt::format("No case has a value of {}{}.", and_list(one.names), why)
                       : fmt::format("Left out, without a value of {}: {}{}.", and_list(one.names), who, why),
                   one.clauses});
  }
  return out;
}

std::optional<Sentence> say_untouched(const Compared& study) {
  double gap = 0, largest = 0;
  bool any = false, several = false;
  std::string law;
  for (const CaseRecord& record : study.results().cases) {
    const auto own = measure(record, "smallest_gap");
    if (record.status != "done" || !own) continue;
    const auto instants = measure(record, "contact_instants"), tip = measure(record, "largest_tip_displacement");
    if (!instants || *instants > 0 || !tip) return std::nullopt;
    // Of the case that comes nearest.
    if (!any || *tip * gap > largest * *own) gap = *own, largest = *tip;
    const std::string name = study.level(record, "contact");
    several = several || (any && name != law);
    law = name;
    any = true;
  }
  if (!any) return std::nullopt;
  std::string text = "No stop was touched: the largest displacement of the tip";
  const double times = largest > 0 ? gap / largest : 0;
  constexpr double few = 1.5;
  text += times == 0 ? fmt::format(" is {} m", short_number(largest, 2))
          : times > few
              ? fmt::format(", {} m, is 1/{} of the smallest gap", short_number(largest, 2), short_number(times, 2))
              : fmt::format(", {} m, is {} of the smallest gap", short_number(largest, 2), percent(largest / gap));
  text += several ? "; contact laws are not compared." : ".";
  Clause clause{.form = "status", .measure = "largest_tip_displacement"};
  clause.value = largest;
  clause.high = gap;
  clause.unit = "m";
  clause.status = "untouched";
  return Sentence{text, {clause}};
}

}  // namespace ricochet::answers
