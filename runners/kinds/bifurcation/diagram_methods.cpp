#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "runners/answers/set_names.hpp"
#include "runners/kinds/bifurcation/diagram_speaker.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/report/case_view.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {

namespace say = answers;
using say::Clause, say::Sentence, say::and_list, say::percent, say::short_number;

namespace {

constexpr std::size_t most_listed = 5;

}  // namespace

void DiagramSpeaker::find_reference(const std::vector<DistanceRow>& distances) {
  for (const DistanceRow& row : distances)
    if (const auto found = by_id_.find(row.reference); found != by_id_.end()) reference_ = found->second;
  if (reference_) return;
  for (const CaseRecord& record : results_.cases)
    if (record.status == "done" && (!reference_ || steps(record) > steps(*reference_))) reference_ = &record;
}

void DiagramSpeaker::compare(const std::vector<DistanceRow>& of_orbits) {
  std::map<std::string, std::vector<double>> distances;
  for (const DistanceRow& row : of_orbits)
    if (row.wasserstein) distances[row.id].push_back(*row.wasserstein);
  int all = 0;
  const std::vector<AgreementRow> rows = agreement_type().read(results_.derived);
  for (const AgreementRow& row : rows)
    if (row.id == reference_->id && row.other == reference_->id) all = row.compared;
  for (const AgreementRow& row : rows) {
    const auto found = by_id_.find(row.other);
    if (row.id != reference_->id || row.other == reference_->id || found == by_id_.end()) continue;
    if (found->second->status != "done") continue;
    Likeness one{found->second, row.same, row.compared, std::max(all, row.compared), std::nullopt};
    if (const auto known = distances.find(row.other); known != distances.end()) one.distance = median(known->second);
    others_.push_back(one);
  }
}

void DiagramSpeaker::read_motions() {
  const report::Quantity swept = report::swept_parameter(results_);
  parameter_ = swept.name;
  unit_ = report::shown_unit(swept.unit);
  std::vector<OrbitRow> orbits = orbits_of(*reference_);
  const auto first =
      std::find_if(orbits.begin(), orbits.end(), [](const OrbitRow& one) { return !is_random_start(one.start); });
  if (first == orbits.end()) return;
  start_ = first->start;
  std::erase_if(orbits, [&](const OrbitRow& one) { return one.start != start_ || !std::isfinite(one.parameter); });
  std::stable_sort(orbits.begin(), orbits.end(),
                   [](const OrbitRow& a, const OrbitRow& b) { return a.parameter < b.parameter; });
  for (const OrbitRow& one : orbits) {
    const std::string motion = motion_words(one.motion_text());
    values_.push_back({one.parameter, one.parameter, motion});
    if (!runs_.empty() && runs_.back().motion == motion)
      runs_.back().to = one.parameter;
    else
      runs_.push_back({one.parameter, one.parameter, motion});
  }
}

std::string DiagramSpeaker::told(const Likeness& one) const {
  std::string out = fmt::format("{} of {} motions", one.same, one.all);
  if (one.all > one.decided) out += fmt::format(", {} open", one.all - one.decided);
  if (one.distance) out += ", " + short_number(*one.distance, 2) + " away";
  return out;
}

Clause DiagramSpeaker::clause(const char* form, const Likeness& one, const std::string& who) const {
  Clause out{.form = form, .who = who, .methods = one.record->id};
  out.value = one.distance;
  out.low = one.same;
  out.high = one.all;
  out.status = one.same_diagram() ? "same" : one.nearly_same() ? "nearly" : "another";
  out.unit = "motions";
  out.at_step = study_.step(*one.record);
  out.at_mesh = study_.elements(*one.record);
  return out;
}

/// Which methods give the reference's diagram, at the most steps.
void DiagramSpeaker::say_methods(say::Answer& answer) const {
  double finest = 0;
  for (const Likeness& one : others_) finest = std::max(finest, steps(*one.record));
  finest = std::max(finest, steps(*reference_));
  const double mesh = study_.elements(*reference_).value_or(0);
  std::vector<Likeness> same, nearly, other;
  for (const Likeness& one : others_)
    if (!own_method(*one.record) && steps(*one.record) == finest && study_.elements(*one.record).value_or(0) == mesh)
      (one.same_diagram() ? same : one.nearly_same() ? nearly : other).push_back(one);
  if (same.empty() && nearly.empty() && other.empty()) return;
  const auto by_distance = [](const Likeness& a, const Likeness& b) {
    return a.distance.value_or(0) < b.distance.value_or(0);
  };
  std::stable_sort(same.begin(), same.end(), by_distance);
  std::stable_sort(nearly.begin(), nearly.end(), by_distance);
  std::stable_sort(other.begin(), other.end(), by_distance);
  const std::string at =
      study_.varies("steps_per_period") ? fmt::format(" at {} steps per period", short_number(finest)) : "";
  Sentence said;
  const auto list = [&](const std::vector<Likeness>& some) {
    std::string out;
    for (std::size_t k = 0; k < some.size(); ++k) {
      const std::string who = name(*some[k].record, false);
      said.clauses.push_back(clause("diagram", some[k], who));
      if (k < most_listed) out += fmt::format("{}{} ({})", k == 0 ? "" : "; ", who, told(some[k]));
    }
    if (some.size() > most_listed) out += fmt::format("; {} more", some.size() - most_listed);
    return out;
  };
  const std::string reference = name(*reference_, false);
  if (!same.empty()) {
    said.text = fmt::format("The diagram of {}{} is also that of {}.", reference, at, list(same));
    answer.say(std::move(said));
    said = {};
  }
  if (!nearly.empty()) {
    said.text = same.empty() ? fmt::format("The diagram of {}{} is nearly that of {}.", reference, at, list(nearly))
                             : fmt::format("Nearly: {}.", list(nearly));
    answer.say(std::move(said));
    said = {};
  }
  if (!other.empty()) {
    said.text = same.empty() && nearly.empty()
                    ? fmt::format("No method gives the diagram of {}{}: {}.", reference, at, list(other))
                    : fmt::format("Another: {}.", list(other));
    answer.say(std::move(said));
  }
}

/// Whether the diagram of the reference's own method converges in the step, and what its mesh moves.
void DiagramSpeaker::say_steps(say::Answer& answer) const {
  std::map<double, std::vector<Likeness>> by_steps;
  std::vector<Likeness> meshes;
  const double mesh = study_.elements(*reference_).value_or(0);
  for (const Likeness& one : others_) {
    if (!own_method(*one.record)) continue;
    if (study_.elements(*one.record).value_or(0) == mesh && steps(*one.record) != steps(*reference_))
      by_steps[steps(*one.record)].push_back(one);
    else if (steps(*one.record) == steps(*reference_))
      meshes.push_back(one);
  }
  if (!by_steps.empty()) {
    Sentence said;
    std::vector<std::string> parts;
    std::vector<std::pair<double, double>> distances;
    for (const auto& [count, some] : by_steps) {
      const Likeness& one = some.front();
      parts.push_back(fmt::format("{} steps {}", short_number(count), told(one)));
      Clause part = clause("diagram", one, short_number(count) + " steps per period");
      part.choice = "steps_per_period";
      said.clauses.push_back(part);
      if (one.distance && *one.distance > 0) distances.emplace_back(count, *one.distance);
    }
    said.text =
        fmt::format("Against {} steps per period: {}", short_number(steps(*reference_)), fmt::join(parts, "; "));
    // From three sizes on, the reference among them, an order shows.
    if (distances.size() >= 2 && distances.back().second < distances.front().second) {
      const double order = std::log(distances.front().second / distances.back().second) /
                           std::log(distances.back().first / distances.front().first);
      said.text += fmt::format("; the distance falls with order {:.1f}", order);
      said.clauses.back().value = order;
      said.clauses.back().status = "order";
    } else if (distances.size() < 2 && !all_robust()) {
      said.text += "; whether it converges needs a third number of steps";
    }
    said.text += ".";
    answer.say(std::move(said));
  }
  if (!meshes.empty()) {
    Sentence said;
    std::vector<std::string> parts;
    for (const Likeness& one : meshes) {
      const std::string who = study_.mesh_words(study_.elements(*one.record).value_or(0));
      parts.push_back(fmt::format("{} {}", who, told(one)));
      Clause part = clause("diagram", one, who);
      part.choice = study_.mesh_column();
      said.clauses.push_back(part);
    }
    said.text = fmt::format("Against {}: {}.", study_.mesh_words(mesh), fmt::join(parts, "; "));
    answer.say(std::move(said));
  }
}

}  // namespace ricochet
