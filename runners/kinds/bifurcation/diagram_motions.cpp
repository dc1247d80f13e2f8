#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <set>

#include "runners/answers/set_names.hpp"
#include "runners/kinds/bifurcation/diagram_speaker.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/report/case_view.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/row_type.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {

namespace say = answers;
using say::Clause, say::Sentence, say::and_list, say::percent, say::short_number;

namespace {

constexpr std::size_t most_stretches = 6, most_speeds = 6;

}  // namespace

std::string DiagramSpeaker::runs_text(const std::vector<MotionRun>& runs) const {
  std::string out;
  for (const MotionRun& run : runs)
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", run.motion,
                       run.from == run.to ? "at " + short_number(run.from)
                                          : fmt::format("from {} to {}", short_number(run.from), short_number(run.to)));
  return out + (out.empty() ? "" : parameter_unit());
}

/// Over how much of the range the motion is the same whatever the numerics, which it is there, and what decides
/// elsewhere.
void DiagramSpeaker::say_robust(say::Answer& answer) const {
  if (verdicts_.empty() || others_.empty()) return;
  double robust = 0, open = 0, total = 0;
  InOrderMet<std::string, double> deciding;
  for (const VerdictRow& row : verdicts_) {
    const double width = row.to - row.from;
    total += width;
    if (row.verdict == "robust")
      robust += width;
    else if (row.verdict == "depends")
      deciding[row.choice] += width;
    else
      open += width;
  }
  if (total <= 0) return;
  Sentence said;
  const auto part = [&](const std::string& who, double width, const char* status) {
    Clause one{.form = "diagram", .who = who};
    one.value = 100 * width / total;
    one.unit = "%";
    one.status = status;
    said.clauses.push_back(one);
  };
  // What the reference shows at the values where all agree.
  std::vector<MotionRun> shown;
  bool goes_on = false;
  for (const MotionRun& value : values_) {
    const bool agreed = std::any_of(verdicts_.begin(), verdicts_.end(), [&](const VerdictRow& row) {
      return row.verdict == "robust" && row.from <= value.from && value.from <= row.to;
    });
    if (agreed && goes_on && shown.back().motion == value.motion)
      shown.back().to = value.to;
    else if (agreed)
      shown.push_back(value);
    goes_on = agreed;
  }
  constexpr std::size_t told_runs = 4;
  std::stable_sort(shown.begin(), shown.end(),
                   [](const MotionRun& a, const MotionRun& b) { return a.to - a.from > b.to - b.from; });
  if (shown.size() > told_runs) shown.resize(told_runs);
  std::sort(shown.begin(), shown.end(), [](const MotionRun& a, const MotionRun& b) { return a.from < b.from; });
  part("whatever the numerics", robust, "robust");
  said.text = fmt::format("The same motion whatever the numerics in {} of the range", percent(robust / total));
  if (!shown.empty()) said.text += ": " + runs_text(shown);
  std::vector<std::pair<std::string, double>> choices = deciding.list();
  std::stable_sort(choices.begin(), choices.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  constexpr std::size_t told_choices = 2;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    const std::string who =
        choices[k].first == "several choices" ? "several choices at once" : say::spoken(choices[k].first);
    part(who, choices[k].second, "depends");
    if (k >= told_choices) continue;
    said.text += fmt::format("; {} decide{} {}", who, choices[k].first == "several choices" ? "" : "s",
                             percent(choices[k].second / total));
  }
  if (open > 0) {
    part("open", open, "undecided");
    said.text += fmt::format("; {} is open", percent(open / total));
  }
  said.text += ".";
  answer.say(std::move(said));
}

void DiagramSpeaker::say_motions(say::Answer& answer) const {
  if (runs_.empty()) return;
  std::vector<MotionRun> shown = runs_;
  std::stable_sort(shown.begin(), shown.end(),
                   [](const MotionRun& a, const MotionRun& b) { return a.to - a.from > b.to - b.from; });
  const bool left_out = shown.size() > most_stretches;
  if (left_out) shown.resize(most_stretches);
  std::sort(shown.begin(), shown.end(), [](const MotionRun& a, const MotionRun& b) { return a.from < b.from; });
  const std::string who = results_.cases.size() > 1 && study_.varies("steps_per_period")
                              ? fmt::format("With {} steps per period", short_number(steps(*reference_)))
                          : results_.cases.size() > 1 ? "With " + name(*reference_, false)
                                                      : "Along " + say::spoken(parameter_);
  Clause said{.form = "diagram", .who = name(*reference_, true), .methods = reference_->id};
  said.low = runs_.front().from;
  said.high = runs_.back().to;
  said.unit = unit_;
  said.status = "motions";
  answer.say(fmt::format("{}: {}{}.", who, runs_text(shown), left_out ? "; others between" : ""), said);
}

/// Where one known motion becomes another, as well as it is located.
void DiagramSpeaker::say_changes(say::Answer& answer) const {
  std::vector<ChangeRow> changes = changes_of(*reference_);
  // Where methods differ in them they are no property of the motion.
  const auto robust_at = [&](double value) {
    return verdicts_.empty() || std::any_of(verdicts_.begin(), verdicts_.end(), [&](const VerdictRow& row) {
             return row.verdict == "robust" && row.from <= value && value <= row.to;
           });
  };
  std::erase_if(changes, [&](const ChangeRow& one) {
    if (!robust_at(one.value)) return true;
    const auto repeats = [](const std::string& words) {
      const auto motion = motion_class(words);
      return motion && motion->repeats();
    };
    return !repeats(one.from) || !repeats(one.to) || std::isnan(one.value) || (!start_.empty() && one.start != start_);
  });
  if (changes.empty()) return;
  const std::vector<ShiftRow> shifts = shifts_type().read(results_.derived);
  constexpr std::size_t most_changes = 3;
  Sentence said;
  for (std::size_t k = 0; k < std::min(most_changes, changes.size()); ++k) {
    const ChangeRow& one = changes[k];
    double largest = 0;
    std::size_t found = 0, expected = 0;
    for (const ShiftRow& shift : shifts) {
      if (shift.from != one.from || shift.to != one.to || shift.start != one.start ||
          shift.reference_value != one.value)
        continue;
      ++expected;
      if (shift.found != true || !shift.shift) continue;
      ++found;
      largest = std::max(largest, std::abs(*shift.shift));
    }
    // Seen by the reference alone.
    if (expected > 0 && found == 0) continue;
    const double half = std::isnan(one.low) || std::isnan(one.high) ? 0 : 0.5 * std::abs(one.high - one.low);
    say::MeasureWords words;
    words.unit = unit_;
    const std::string place = say::value_text(words, one.value, half > 0 ? std::optional(half) : std::nullopt);
    std::string text = fmt::format("{} to {} at {}", motion_words(one.from), motion_words(one.to).substr(7), place);
    if (half > 0) text += " ± " + short_number(half, 1);
    if (expected > 0 && found == expected && largest <= half)
      text += " in every case";
    else if (found > 0)
      text += fmt::format(" ({} of {} other cases, shifted by at most {})", found, expected, short_number(largest, 2));
    said.text += (said.text.empty() ? "The motion changes from " : "; from ") + text;
    Clause part{.form = "diagram", .who = one.from + " to " + one.to, .methods = reference_->id};
    part.value = one.value;
    part.uncertainty = half;
    part.unit = unit_;
    part.status = "change";
    said.clauses.push_back(part);
  }
  if (said.text.empty()) return;
  said.text += ".";
  answer.say(std::move(said));
}

/// Speed of the one impact that repeats from one start, by value of the parameter.
std::map<double, double> DiagramSpeaker::single_impacts(const CaseRecord& record) const {
  std::map<double, double> speeds;
  const NumberType<ImpactColumns> type = impacts_type();
  const NumberTable* table = type.find(record.numbers);
  if (!table) return speeds;
  const ImpactColumns of = type.read(*table);
  const std::vector<std::string>* words = table->words_of(start_name);
  if (!of.parameter || !of.start || !of.speed || !words) return speeds;
  const std::vector<double>&parameter = of.parameter->get(), &from = of.start->get(), &speed = of.speed->get();
  std::set<double> several;
  for (std::size_t row = 0; row < table->rows(); ++row)
    if ((*words)[static_cast<std::size_t>(from[row])] == start_ && !speeds.emplace(parameter[row], speed[row]).second)
      several.insert(parameter[row]);
  for (const double value : several) speeds.erase(value);
  return speeds;
}

/// How hard the stop is hit, where a motion repeats with one impact, of few values.
void DiagramSpeaker::say_speeds(say::Answer& answer) const {
  const std::map<double, double> speeds = single_impacts(*reference_);
  if (speeds.empty() || speeds.size() > most_speeds) return;
  Sentence said;
  std::vector<std::string> values, places;
  for (const auto& [value, speed] : speeds) {
    values.push_back(short_number(speed, 5));
    places.push_back(short_number(value, 5));
    Clause one{.form = "value",
               .measure = "impact speed",
               .who = parameter_ + " " + short_number(value, 5),
               .methods = reference_->id};
    one.value = speed;
    one.unit = "m/s";
    said.clauses.push_back(one);
  }
  double apart = 0;
  std::size_t others = 0;
  for (const CaseRecord& other : results_.cases) {
    if (&other == reference_ || other.status != "done") continue;
    for (const auto& [value, speed] : single_impacts(other))
      if (const auto found = speeds.find(value); found != speeds.end())
        ++others, apart = std::max(apart, std::abs(speed / found->second - 1));
  }
  said.text = fmt::format("Orbits with one impact hit with {} m/s at {}{}{}.", and_list(values), and_list(places),
                          parameter_unit(), others > 0 ? "; other cases within " + percent(apart) : "");
  answer.say(std::move(said));
}

}  // namespace ricochet
