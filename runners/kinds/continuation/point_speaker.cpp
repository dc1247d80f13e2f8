#include "runners/kinds/continuation/point_speaker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/case_view.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {

namespace say = answers;
using say::Clause, say::Sentence, say::and_list, say::short_number;

namespace {

constexpr std::size_t most_points = 4, most_unconfirmed = 4;

/// Points of a known kind at a known place.
bool tellable(const StudyPoint& one) {
  return is_point_kind(one.kind) && !std::isnan(one.parameter);
}

}  // namespace

std::string point_value(double value, std::optional<double> half) {
  if (!half || !(*half > 1e-12 * std::abs(value))) return short_number(value, 7);
  int places = -static_cast<int>(std::floor(std::log10(*half)));
  constexpr double begins_with_one = 1.95;
  const bool fine = *half * std::pow(10, places) < begins_with_one;
  constexpr int most = 15;
  std::string text = fmt::format("{:.{}f}", value, std::clamp(places + fine, 0, most));
  if (text.starts_with('-')) text.replace(0, 1, "−");
  return text + " ± " + short_number(*half, fine ? 2 : 1);
}

PointSpeaker::PointSpeaker(const answers::Compared& study, const PointAnalysis& of)
    : study_(study),
      of_(of),
      points_(of.points),
      told_(of.told),
      unit_(report::shown_unit(report::swept_parameter(study.results()).unit)) {}

std::string PointSpeaker::subject(const ToldPoint& told) const {
  // Where no orbit is symmetric the scene has no symmetry to lose.
  const bool symmetry = std::any_of(points_.names().begin(), points_.names().end(),
                                    [](const NamedPoint& one) { return one.point->symmetric.value_or(false); });
  const StudyPoint& point = told.point();
  return fmt::format("the {}{}period-{} orbit", told.ends_stability ? "stable " : "",
                     !symmetry || !point.symmetric ? ""
                     : *point.symmetric            ? "symmetric "
                                                   : "asymmetric ",
                     point.period);
}

const CaseRecord* PointSpeaker::record(const std::string& id) const {
  for (const CaseRecord* one : points_.cases())
    if (one->id == id) return one;
  return nullptr;
}

/// "P0 on 10 elements, 2000 steps per period": what of it varies in the study.
std::string PointSpeaker::case_words(const CaseRecord& one) const {
  std::string out = study_.label(one);
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  if (const auto elements = study_.elements(one); elements && study_.varies(study_.mesh_column()))
    add(study_.mesh_words(*elements));
  if (const auto step = study_.step(one); step && study_.varies("steps_per_period")) add(study_.step_words(*step));
  return out.empty() ? "the one case" : out;
}

std::string PointSpeaker::place_words(const ToldPoint& told, Sentence& said) const {
  const PointLimitRow& limit = *told.limit;
  const bool refined = limit.low && limit.high;
  // Of one case its own interval is left.
  const double own = told.point().half;
  const auto half = refined   ? std::optional(0.5 * (*limit.high - *limit.low))
                    : own > 0 ? std::optional(own)
                              : std::nullopt;
  const PointWords& words = point_words(told.point().kind);
  Clause where{.form = "value", .measure = words.thing, .who = told.name->text, .methods = points_.reference()->id};
  where.value = limit.limit;
  where.low = limit.low;
  where.high = limit.high;
  where.uncertainty = half;
  where.unit = unit_;
  where.status = refined ? "" : "one";
  said.clauses.push_back(where);
  return fmt::format("{} at {}{}", words.does, point_value(*limit.limit, half), unit());
}

std::string PointSpeaker::facts_words(const ToldPoint& told, Sentence& said) const {
  const std::string &name = told.name->text, &reference = points_.reference()->id;
  std::vector<std::string> orders;
  for (const PointOrderRow& row : of_.orders) {
    if (row.name != name || row.method != reference || row.verdict != order_told) continue;
    const auto axis = std::find_if(points_.axes().begin(), points_.axes().end(),
                                   [&](const RefinedAxis& one) { return one.column == row.refined; });
    const double width = 0.5 * (*row.high - *row.low);
    orders.push_back(fmt::format("{} ± {} in {}", short_number(*row.order, 2), short_number(width, 1), axis->symbol));
    Clause order{.form = "order", .measure = axis->words, .who = name, .methods = row.id};
    order.value = row.order;
    order.low = row.low;
    order.high = row.high;
    order.unit = "1";
    said.clauses.push_back(order);
  }
  std::string facts = orders.empty() ? "" : "order " + and_list(orders);
  if (told.limit->reference) {
    const auto given = study_.results().study.find("reference");
    const std::string words = given == study_.results().study.end()
                                  ? "the reference"
                                  : study_.method_words("reference", given->at(0).at("name").get<std::string>());
    facts += fmt::format("{}{}: {}", facts.empty() ? "" : "; ", words, short_number(*told.limit->reference, 7));
    Clause standard{.form = "value", .measure = "reference", .who = name, .methods = reference};
    standard.value = told.limit->reference;
    standard.unit = unit_;
    said.clauses.push_back(standard);
  }
  return facts.empty() ? "" : " (" + facts + ")";
}

void PointSpeaker::say_points(say::Answer& answer) const {
  if (told_.empty()) return;
  const auto same_orbit = [](const ToldPoint& a, const ToldPoint& b) {
    return a.point().period == b.point().period && a.point().symmetric == b.point().symmetric;
  };
  // The first point alone, with the method; then those of its orbit in one sentence, and other orbits in one each.
  const std::string method = points_.heads().size() > 1 ? "with " + study_.name(*points_.reference()) : std::string();
  const std::string after = method.empty() ? "" : " " + method;
  Sentence first;
  const std::string place = place_words(told_.front(), first);
  first.text = fmt::format("{} {}{}{}.", say::capitalised(subject(told_.front())), place, after,
                           facts_words(told_.front(), first));
  answer.say(std::move(first));
  std::vector<ToldPoint> left(told_.begin() + 1, told_.begin() + std::min(most_points, told_.size()));
  while (!left.empty()) {
    const ToldPoint head = left.front();
    Sentence said;
    std::vector<std::string> parts;
    for (const ToldPoint& one : left)
      if (same_orbit(one, head)) {
        const std::string at = place_words(one, said);
        parts.push_back(at + facts_words(one, said));
      }
    std::erase_if(left, [&](const ToldPoint& one) { return same_orbit(one, head); });
    said.text =
        same_orbit(head, told_.front())
            ? say::capitalised(fmt::format("{}it also {}.", method.empty() ? "" : method + " ", and_list(parts)))
            : fmt::format("{} {}{}.", say::capitalised(subject(head)), and_list(parts), after);
    answer.say(std::move(said));
  }
  const std::size_t told = std::min(most_points, told_.size()), all = distinct_of(points_.root()).size();
  if (all <= told) return;
  Clause more{.form = "value", .measure = "special points", .methods = points_.reference()->id};
  more.value = static_cast<double>(all - told);
  more.unit = "1";
  answer.say(
      fmt::format("special_points.csv has {} more point{} of that case.", all - told, all - told == 1 ? "" : "s"),
      more);
}

std::vector<const StudyPoint*> PointSpeaker::distinct_of(std::size_t owner) const {
  std::vector<const StudyPoint*> out;
  for (const StudyPoint& one : points_.points()) {
    if (one.owner != owner || !tellable(one)) continue;
    if (std::none_of(out.begin(), out.end(), [&](const StudyPoint* other) { return at_one_place(one, *other); }))
      out.push_back(&one);
  }
  return out;
}

void PointSpeaker::say_unconfirmed(say::Answer& answer) const {
  if (!told_.empty()) return;
  const auto first_with_points = std::find_if(points_.points().begin(), points_.points().end(), tellable);
  if (first_with_points == points_.points().end()) {
    say_orbits(answer);
    return;
  }
  // Of the finest case; of the first that has points where that has none.
  const auto of_root = [&](const StudyPoint& one) { return one.owner == points_.root() && tellable(one); };
  const bool finest = std::any_of(points_.points().begin(), points_.points().end(), of_root);
  const std::size_t owner = finest ? points_.root() : first_with_points->owner;
  Sentence said;
  std::vector<std::string> parts;
  const std::vector<const StudyPoint*> all = distinct_of(owner);
  for (const StudyPoint* point : all) {
    if (parts.size() == most_unconfirmed) break;
    const StudyPoint& one = *point;
    parts.push_back(fmt::format("{} at {}", point_words(one.kind).thing, short_number(one.parameter, 6)));
    Clause part{.form = "value", .measure = point_words(one.kind).thing, .methods = points_.cases()[owner]->id};
    part.value = one.parameter;
    part.low = one.row.low;
    part.high = one.row.high;
    part.unit = unit_;
    part.status = "one";
    said.clauses.push_back(part);
  }
  parts.back() += unit();
  if (all.size() > most_unconfirmed) parts.push_back(fmt::format("{} more", all.size() - most_unconfirmed));
  const std::string whose = points_.cases().size() == 1 ? "One case, so that no second one confirms its points"
                            : finest ? "No special point is confirmed by a second case; the finest has"
                                     : fmt::format(
                                           "No special point is confirmed by a second case; the finest has none, "
                                           "{} has",
                                           case_words(*points_.cases()[owner]));
  said.text = fmt::format("{}: {}.", whose, and_list(parts));
  answer.say(std::move(said));
}

void PointSpeaker::say_orbits(say::Answer& answer) const {
  constexpr std::size_t most_orbits = 4;
  const Table* table = find_table(points_.reference()->tables, branches_name);
  std::vector<BranchRow> ends;
  for (BranchRow& row : branch_rows_in(*table))
    if (ends.empty() || ends.back().branch != row.branch) ends.push_back(std::move(row));
  Sentence said;
  std::vector<std::string> parts;
  for (const BranchRow& row : ends) {
    if (parts.size() == most_orbits || !row.stable || row.multipliers.empty() || !row.multipliers.front()) continue;
    const std::string at = fmt::format("at {}{}", short_number(*row.parameter, 6), unit());
    const double modulus = std::abs(*row.multipliers.front());
    const std::string words =
        fmt::format("{} {} (largest multiplier {})", *row.stable ? "stable" : "unstable", at, short_number(modulus, 3));
    if (std::find(parts.begin(), parts.end(), words) != parts.end()) continue;
    parts.push_back(words);
    Clause part{.form = "value", .measure = "multiplier", .who = at, .methods = points_.reference()->id};
    part.value = modulus;
    part.unit = "1";
    part.status = *row.stable ? "stable" : "unstable";
    said.clauses.push_back(part);
  }
  if (parts.empty()) {
    answer.say("The branches have no special point.", Clause{.form = "status", .status = "none"});
    return;
  }
  said.text = fmt::format("No special point was met; orbits are {}.", and_list(parts));
  answer.say(std::move(said));
}

void PointSpeaker::say_ends(say::Answer& answer) const {
  // Of the reference case each branch that ends inside the range, in words; of other cases their number.
  struct Ways {
    const char *ended, *one, *many;
    int count = 0;
  } ways[] = {{"range", "goes to an end of the range", "go to an end of the range"},
              {"closed", "closes", "close"},
              {"joined", "joins another branch", "join another branch"},
              {"asked", "stops at a point of stop_at", "stop at a point of stop_at"}};
  int branches = 0;
  std::set<std::size_t> other_cases;
  std::vector<const SpecialRow*> inside;
  for (const StudyPoint& point : points_.points()) {
    const SpecialRow& row = point.row;
    if (row.kind != "end" || row.ended.empty() || row.ended == "missing") continue;
    ++branches;
    const auto way =
        std::find_if(std::begin(ways), std::end(ways), [&](const Ways& known) { return row.ended == known.ended; });
    if (way != std::end(ways))
      ++way->count;
    else if (point.owner == points_.root())
      inside.push_back(&row);
    else
      other_cases.insert(point.owner);
  }
  if (branches == 0) return;
  std::vector<std::string> parts;
  Sentence whole;
  for (const Ways& way : ways) {
    if (way.count == 0) continue;
    parts.push_back(fmt::format("{} {}", way.count, way.count == 1 ? way.one : way.many));
    Clause part{.form = "value", .measure = "branches", .status = way.ended};
    part.value = way.count;
    part.unit = "1";
    whole.clauses.push_back(part);
  }
  const std::string all = fmt::format("{} branch{}", branches, branches == 1 ? "" : "es");
  whole.text = parts.empty() ? fmt::format("None of {} goes to an end of the range.", all)
                             : fmt::format("Of {} {}.", all, and_list(parts));
  if (parts.empty()) whole.clauses.push_back({.form = "status", .measure = "branches", .status = "none"});
  answer.say(std::move(whole));
  constexpr std::size_t most_inside = 2;
  for (std::size_t k = 0; k < std::min(most_inside, inside.size()); ++k) {
    const SpecialRow& row = *inside[k];
    Clause end{.form = "value", .measure = "end of a branch", .who = row.branch, .methods = points_.reference()->id};
    end.value = row.parameter;
    end.unit = unit_;
    end.status = row.ended;
    answer.say(fmt::format("{} ends inside the range, at {}{}: {}.", row.branch, short_number(*row.parameter, 6),
                           unit(), row.note),
               end);
  }
  const std::size_t more = inside.size() - std::min(most_inside, inside.size());
  const std::size_t others = other_cases.size();
  parts.clear();
  if (more > 0) parts.push_back(fmt::format("{} more branch{} of that case", more, more == 1 ? "" : "es"));
  if (others > 0) parts.push_back(fmt::format("branches of {} other case{}", others, others == 1 ? "" : "s"));
  if (parts.empty()) return;
  Clause rest{.form = "value", .measure = "branches", .status = "inside"};
  rest.value = static_cast<double>(more + others);
  rest.unit = "1";
  answer.say(
      fmt::format("Inside the range end {}{} (special_points.csv).", inside.empty() ? "" : "also ", and_list(parts)),
      rest);
}

void PointSpeaker::say_nothing(say::Answer& answer) const {
  std::string note;
  for (const CaseRecord& one : study_.results().cases)
    for (const SpecialRow& row : special_points_type().read(one.tables))
      if (note.empty() && !row.note.empty()) note = row.note;
  answer.say(note.empty() ? "No periodic orbit was found." : "No periodic orbit was found: " + note + ".",
             Clause{.form = "status", .status = "none"});
}

answers::Answer continuation_answer(const answers::Compared& study, const PointAnalysis& points) {
  answers::Answer answer;
  const PointSpeaker speaker(study, points);
  if (speaker.known()) {
    speaker.say_points(answer);
    speaker.say_unconfirmed(answer);
    speaker.say_shifts(answer);
    speaker.say_absent(answer);
    speaker.say_turns(answer);
  } else {
    speaker.say_nothing(answer);
  }
  constexpr std::size_t most = 6;
  answer.keep(most);
  if (speaker.known()) speaker.say_ends(answer);
  for (answers::Sentence& one : answers::ended(study)) answer.say(std::move(one));
  return answer;
}

}  // namespace ricochet
