// How the first point that is told differs between cases: shifts, cases without it, turns that steps invent.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/kinds/continuation/point_speaker.hpp"

namespace ricochet {

namespace say = answers;
using say::Clause, say::Sentence, say::and_list, say::short_number;

namespace {

constexpr std::size_t most_shifts = 3;

std::string signed_number(double value, int digits) {
  return (value > 0 ? "+" : "") + short_number(value, digits);
}

std::string how_often(int count) {
  return count == 0 ? "never" : count == 1 ? "once" : count == 2 ? "twice" : fmt::format("{} times", count);
}

}  // namespace

void PointSpeaker::say_shifts(say::Answer& answer) const {
  if (told_.empty()) return;
  const std::string& name = told_.front().name->text;
  std::vector<PointShiftRow> moved, still;
  for (const PointShiftRow& row : of_.shifts) {
    if (row.name != name || say::is_refinement(row.choice) || !row.shift || !row.low || !row.high) continue;
    (*row.low > 0 || *row.high < 0 ? moved : still).push_back(row);
  }
  if (moved.empty() && still.empty()) return;
  std::stable_sort(moved.begin(), moved.end(), [](const PointShiftRow& a, const PointShiftRow& b) {
    return std::abs(*a.shift) > std::abs(*b.shift);
  });
  Sentence said;
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < std::min(moved.size(), most_shifts); ++k) {
    const PointShiftRow& row = moved[k];
    parts.push_back(
        fmt::format("{}{} with {}", signed_number(*row.shift, 2), unit(), say::level_phrase(row.choice, row.value)));
    Clause part{.form = "differ", .measure = point_words(told_.front().point().kind).thing, .choice = row.choice};
    part.who = row.value;
    part.methods = row.id;
    part.value = row.shift;
    part.low = row.low;
    part.high = row.high;
    part.unit = unit_;
    said.clauses.push_back(part);
  }
  const std::string thing = point_words(told_.front().point().kind).thing;
  if (!parts.empty()) {
    said.text = fmt::format("The {} moves by {}", thing, and_list(parts));
    if (moved.size() > most_shifts) said.text += fmt::format(", by less in {} more cases", moved.size() - most_shifts);
  }
  for (const PointOrderRow& row : of_.orders)
    if (row.name == name && row.refined == "contact.stiffness" && row.verdict == order_told && !parts.empty()) {
      said.text += fmt::format(" (order {} in 1/κ)", short_number(*row.order, 2));
      Clause order{.form = "order", .measure = "stiffness", .who = name, .methods = row.id};
      order.value = row.order;
      order.low = row.low;
      order.high = row.high;
      order.unit = "1";
      said.clauses.push_back(order);
      break;
    }
  if (!still.empty()) {
    std::vector<std::string> levels;
    double largest = 0;
    for (const PointShiftRow& row : still) {
      levels.push_back(say::level_phrase(row.choice, row.value));
      largest = std::max({largest, std::abs(*row.low), std::abs(*row.high)});
    }
    if (levels.size() > most_shifts) levels = {fmt::format("{} other levels", levels.size())};
    said.text += said.text.empty() ? fmt::format("The {} does not move", thing) : "; it does not move";
    said.text += fmt::format(" beyond {}{} with {}", short_number(largest, 1), unit(), and_list(levels));
    Clause part{.form = say::alike, .measure = thing, .who = and_list(levels)};
    part.uncertainty = largest;
    part.unit = unit_;
    said.clauses.push_back(part);
  }
  said.text += ".";
  answer.say(std::move(said));
}

void PointSpeaker::say_absent(say::Answer& answer) const {
  if (told_.empty()) return;
  const std::string thing = point_words(told_.front().point().kind).thing;
  Cases reached;
  Members absent;
  std::size_t shared = 0;
  std::optional<double> least;
  Sentence said;
  for (const PointPresenceRow& row : of_.presence) {
    const CaseRecord* one = record(row.id);
    if (row.name != told_.front().name->text || !one || is_reference(*one) ||
        row.presence == word(PointPresence::not_reached))
      continue;
    if (row.presence == word(PointPresence::absent)) {
      absent.push_back(reached.size());
      if (row.passed_to) least = std::min(*row.passed_to, least.value_or(*row.passed_to));
    } else if (row.presence == word(PointPresence::many)) {
      Clause part{.form = "status", .measure = thing, .who = case_words(*one), .methods = row.id};
      part.value = row.points;
      part.unit = "1";
      part.status = row.presence;
      ++shared;
      said.clauses.push_back(part);
    }
    reached.push_back(one);
  }
  const auto cases = static_cast<std::size_t>(std::count_if(points_.cases().begin(), points_.cases().end(),
                                                            [](const CaseRecord* one) { return !is_reference(*one); }));
  if (absent.empty() && shared == 0) {
    if (cases < 2) return;
    Clause part{.form = "status", .measure = thing, .who = told_.front().name->text};
    part.status = "robust";
    part.value = static_cast<double>(reached.size());
    part.unit = "1";
    answer.say(reached.size() == cases ? fmt::format("All {} cases have that {}.", cases, thing)
                                       : fmt::format("All {} of {} cases whose branches come there have that {}.",
                                                     reached.size(), cases, thing),
               part);
    return;
  }
  if (!absent.empty()) {
    std::vector<std::string> columns = study_.columns();
    for (const RefinedAxis& axis : points_.axes())
      if (std::find(columns.begin(), columns.end(), axis.column) == columns.end()) columns.push_back(axis.column);
    const auto name = say::SetNames(study_, reached, columns).found(absent);
    constexpr std::size_t longest_name = 60;
    const bool ruled = name.exact && name.text.size() <= longest_name;
    Clause part{.form = "status", .measure = thing};
    part.who = ruled ? name.text : fmt::format("{} of {} cases", absent.size(), reached.size());
    for (const std::size_t k : absent) part.methods += (part.methods.empty() ? "" : " ") + reached[k]->id;
    part.value = least;
    part.unit = unit_;
    part.status = word(PointPresence::absent);
    said.clauses.push_back(part);
    said.text = fmt::format("No such {} {} {}", thing, ruled ? "with" : "in", part.who);
    if (least) said.text += fmt::format(", whose branches go on to {}{} at least", short_number(*least, 4), unit());
  }
  if (shared > 0)
    said.text += fmt::format("{}other turns share its place in {} case{}", said.text.empty() ? "" : "; ", shared,
                             shared == 1 ? "" : "s");
  said.text = say::capitalised(said.text) + ".";
  answer.say(std::move(said));
}

void PointSpeaker::say_turns(say::Answer& answer) const {
  const CaseRecord& reference = *points_.reference();
  // The case of the reference's method and mesh that differs most from it.
  const CaseRecord* coarse = nullptr;
  std::string refined;
  double at = 0;
  int most = 0, left = 0;
  for (std::size_t c = 0; c < points_.cases().size(); ++c) {
    const std::vector<std::string> differs = points_.differences(c, points_.root());
    if (differs.size() != 1 || !say::is_refinement(differs.front()) || is_reference(*points_.cases()[c])) continue;
    const StudyPoints::FoldCounts own = points_.folds(c, points_.root()), finest = points_.folds(points_.root(), c);
    for (const auto& [prominence, count] : own.all) {
      const auto same = finest.all.find(prominence);
      // Folds of the motion have names, or are there in both.
      if (same == finest.all.end() || count <= same->second ||
          own.nameless.at(prominence) <= finest.nameless.at(prominence))
        continue;
      // The largest turns that the finest case has not.
      if (coarse && (prominence < at || (prominence == at && count <= most))) continue;
      coarse = points_.cases()[c];
      refined = differs.front();
      at = prominence;
      most = count;
      left = same->second;
    }
  }
  if (!coarse) return;
  Sentence said;
  for (const auto& [one, count] : {std::pair(coarse, most), std::pair(&reference, left)}) {
    Clause part{.form = "value", .measure = "folds", .who = case_words(*one), .methods = one->id};
    part.value = count;
    part.low = at;
    part.unit = "1";
    said.clauses.push_back(part);
  }
  const auto words = [&](const CaseRecord& one) { return study_.value_words(refined, study_.text(one, refined)); };
  said.text = fmt::format("With {} the branches turn {} by {}{} or more, with {} {}: the others are the {}'s own.",
                          words(*coarse), how_often(most), short_number(at, 2), unit(), words(reference),
                          how_often(left), refined == "steps_per_period" ? "step" : "mesh");
  answer.say(std::move(said));
}

}  // namespace ricochet
