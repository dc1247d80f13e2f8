#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/answers/set_names.hpp"
#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "runners/kinds/bifurcation/diagram_speaker.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"

namespace ricochet {

answers::Answer bifurcation_answer(const answers::Compared& study) {
  answers::Answer answer;
  const DiagramSpeaker diagram(study);
  if (diagram.known()) {
    const bool asked = diagram.random_starts();
    if (asked) diagram.say_coexistence(answer);
    diagram.say_methods(answer);
    diagram.say_steps(answer);
    diagram.say_robust(answer);
    if (!diagram.all_robust()) diagram.say_motions(answer);
    diagram.say_changes(answer);
    diagram.say_speeds(answer);
    if (!asked) diagram.say_coexistence(answer);
  }
  constexpr std::size_t most = 6;
  answer.keep(most);
  if (answer.sentences.empty())
    answer.say("No orbit was decided.", answers::Clause{.form = "status", .status = "none"});
  for (answers::Sentence& one : answers::ended(study)) answer.say(std::move(one));
  return answer;
}

namespace say = answers;
using say::Clause, say::Sentence, say::and_list, say::short_number;

namespace {

/// Motions at each value of the parameter, each attractor once.
using Motions = std::map<double, std::vector<std::string>>;

/// Of every case, by its key.
std::map<std::string, Motions> motions_of(const StudyResults& results) {
  std::map<std::string, std::map<double, std::map<int, std::string>>> attractors;
  for (const Table& table : results.derived)
    if (table.name == "values")
      for (const OrbitRow& one : orbits_in(table))
        if (one.attractor && std::isfinite(one.parameter))
          attractors[one.id][one.parameter].emplace(*one.attractor, motion_words(one.motion_text()));
  std::map<std::string, Motions> out;
  for (const auto& [id, values] : attractors)
    for (const auto& [value, met] : values) {
      std::vector<std::string>& motions = out[id][value];
      for (const auto& [attractor, motion] : met) motions.push_back(motion);
      std::sort(motions.begin(), motions.end());
    }
  return out;
}

/// "two of period 1 and no contact".
std::string list_of(const std::vector<std::string>& motions) {
  std::vector<std::string> words;
  for (std::size_t k = 0; k < motions.size();) {
    const auto count = static_cast<std::size_t>(std::count(motions.begin(), motions.end(), motions[k]));
    static const char* const spoken[] = {"", "", "two", "three", "four"};
    const std::string number = count < std::size(spoken) ? spoken[count] : std::to_string(count);
    words.push_back(count == 1 ? motions[k] : number + " of " + motions[k]);
    k += count;
  }
  return and_list(words);
}

}  // namespace

bool DiagramSpeaker::random_starts() const {
  const std::vector<OrbitRow> orbits = orbits_of(*reference_);
  return std::any_of(orbits.begin(), orbits.end(), [](const OrbitRow& one) { return is_random_start(one.start); });
}

/// Where the reference has several motions at one value, which these are, and whether all cases have several there.
void DiagramSpeaker::say_coexistence(say::Answer& answer) const {
  struct MotionRange {
    double from, to;
    std::vector<std::string> motions;
  };
  std::map<std::string, Motions> motions_by_case = motions_of(results_);
  const Motions& own = motions_by_case[reference_->id];
  std::vector<MotionRange> stretches;
  std::set<double> several;
  for (const auto& [value, motions] : own) {
    if (!stretches.empty() && stretches.back().motions == motions)
      stretches.back().to = value;
    else
      stretches.push_back({value, value, motions});
    if (motions.size() > 1) several.insert(value);
  }
  std::erase_if(stretches, [](const MotionRange& one) { return one.motions.size() < 2; });
  if (stretches.empty()) {
    if (random_starts() && !own.empty())
      answer.say("No value of the parameter has more than one motion, whatever the start.",
                 Clause{.form = "diagram", .methods = reference_->id, .status = "one motion"});
    return;
  }
  const auto place = [](double from, double to) {
    return from == to ? "at " + short_number(from) : fmt::format("from {} to {}", short_number(from), short_number(to));
  };
  Sentence said;
  constexpr std::size_t told = 4;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    const MotionRange& one = stretches[k];
    const std::string list = list_of(one.motions);
    Clause part{.form = "diagram", .who = list, .methods = reference_->id};
    part.value = static_cast<double>(one.motions.size());
    part.low = one.from;
    part.high = one.to;
    part.unit = unit_;
    part.status = "coexist";
    said.clauses.push_back(part);
    if (k < told) said.text += fmt::format("{}{} {}", k == 0 ? "" : "; ", list, place(one.from, one.to));
  }
  said.text = "Motions coexist: " + said.text + parameter_unit();
  if (stretches.size() > told) said.text += fmt::format("; {} more in the table", stretches.size() - told);
  // Elsewhere: the same number in every case.
  std::size_t everywhere = 0, cases = 0;
  std::map<double, std::size_t> shared;
  for (const CaseRecord& record : results_.cases) {
    if (&record == reference_ || record.status != "done") continue;
    ++cases;
    for (const auto& [value, motions] : motions_by_case[record.id])
      if (motions.size() > 1 && several.count(value) > 0) ++shared[value];
  }
  for (const auto& [value, count] : shared) everywhere += count == cases ? 1 : 0;
  if (cases > 0) {
    Clause part{.form = "diagram", .who = "every case"};
    part.value = static_cast<double>(everywhere);
    part.high = static_cast<double>(several.size());
    part.unit = "values";
    part.status = "coexist in every case";
    said.clauses.push_back(part);
    said.text += everywhere == several.size() ? "; several in every case at all of these values"
                 : everywhere == 0
                     ? "; at none of these values in every case"
                     : fmt::format("; several in every case at {} of these {} values", everywhere, several.size());
  }
  said.text += ".";
  answer.say(std::move(said));
}

}  // namespace ricochet
