#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/motion/motion_errors.hpp>

#include "runners/answers/answer.hpp"
#include "runners/answers/numbers_in_words.hpp"

// What a study's measures cannot say.
namespace ricochet::answers {

bool of_untouched_stop(const std::string& name, const CaseRecord& record) {
  const std::size_t stop = name.find('[');
  return stop != std::string::npos && record.status == Status::done && !measure(record, name) &&
         why_left_out(record, name).empty() && measure(record, "contact_time" + name.substr(stop)) == 0.0;
}

std::string why_without(const std::string& name, const CaseRecord& record) {
  if (const std::string& reason = why_left_out(record, name); !reason.empty()) return reason;
  if (of_untouched_stop(name, record)) return "the stop is never touched";
  const MeasureWords words = measure_words(name);
  const bool of_energy = words.scale == "energy_brought_in" || words.most || name.starts_with("work_of_");
  if (!of_energy) return "";
  // Works are known together or not at all.
  if (!measure(record, "work_of_damping")) return no_work_form;
  if (!measure(record, "energy_left")) return "the motion has no energy to lose";
  return "";
}

namespace {

/// Where no case has moved at all, and none had energy.
std::optional<Sentence> say_unmoved(const Choices& study) {
  std::size_t still = 0;
  for (const CaseRecord& record : study.results().cases) {
    if (record.status != Status::done) continue;
    const auto zero = [&](const char* name) { return measure(record, name).value_or(0) == 0; };
    const bool known = measure(record, "largest_tip_displacement") && measure(record, "energy_start");
    if (!known || !zero("largest_tip_displacement") || !zero("energy_start") || !zero("work_of_loads"))
      return std::nullopt;
    ++still;
  }
  if (still == 0) return std::nullopt;
  Clause clause{.form = "status", .measure = "largest_tip_displacement"};
  clause.value = 0;
  clause.unit = "m";
  clause.status = "unmoved";
  return Sentence{"Nothing moved: the structure starts at rest where nothing pushes it, and no load does work.",
                  {clause}};
}

/// How a sentence on these cases ends, in which no contact law did anything.
const char* end_of(const Choices& study, const Cases& cases) {
  const bool several = std::any_of(cases.begin(), cases.end(), [&](const CaseRecord* one) {
    return study.level(*one, "contact") != study.level(*cases.front(), "contact");
  });
  return several ? "; contact laws are not compared." : ".";
}

/// Where every case with a contact law is compared with a reference, and neither touches a stop.
std::optional<Sentence> say_no_contact(const Choices& study) {
  Cases done = with_status(all_cases(study.results()), Status::done);
  std::erase_if(done, [](const CaseRecord* one) { return !measure(*one, "contact_time"); });
  const bool none = !done.empty() && std::all_of(done.begin(), done.end(), [](const CaseRecord* one) {
    return std::any_of(one->left_out.begin(), one->left_out.end(),
                       [](const auto& item) { return item.second == no_contact; });
  });
  if (!none) return std::nullopt;
  return Sentence{std::string("No stop was touched by the motions and by their references") + end_of(study, done),
                  {Clause{.form = "status", .status = "untouched"}}};
}

/// Whether friction did anything: a friction damper is pressed without contact.
bool rubbed(const CaseRecord& record) {
  return std::any_of(record.measures.begin(), record.measures.end(), [](const auto& one) {
    return one.second != 0 && (one.first == "dissipated_by_friction" || one.first.starts_with("friction_impulse["));
  });
}

}  // namespace

std::optional<Sentence> say_untouched(const Choices& study) {
  if (auto unmoved = say_unmoved(study)) return unmoved;
  if (auto untouched = say_no_contact(study)) return untouched;
  double gap = 0, largest = 0;
  Cases looked;
  for (const CaseRecord& record : study.results().cases) {
    const auto own = measure(record, "smallest_gap");
    if (record.status != Status::done || !own) continue;
    const auto instants = measure(record, "contact_instants"), tip = measure(record, "largest_tip_displacement");
    if (!instants || *instants > 0 || !tip || rubbed(record)) return std::nullopt;
    // Of the case that comes nearest.
    if (looked.empty() || *tip * gap > largest * *own) gap = *own, largest = *tip;
    looked.push_back(&record);
  }
  if (looked.empty()) return std::nullopt;
  std::string text = "No stop was touched: the largest displacement of the tip";
  const double times = largest > 0 ? gap / largest : 0;
  constexpr double few = 1.5;
  text += times == 0 ? fmt::format(" is {} m", short_number(largest, 2))
          : times > few
              ? fmt::format(", {} m, is 1/{} of the smallest gap", short_number(largest, 2), short_number(times, 2))
              : fmt::format(", {} m, is {} of the smallest gap", short_number(largest, 2), percent(largest / gap));
  text += end_of(study, looked);
  Clause clause{.form = "status", .measure = "largest_tip_displacement"};
  clause.value = largest;
  clause.high = gap;
  clause.unit = "m";
  clause.status = "untouched";
  return Sentence{text, {clause}};
}

}  // namespace ricochet::answers
