#include "runners/kinds/continuation/point_speaker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/case_view.hpp"

namespace ricochet {

namespace say = answers;
using say::Clause, say::Sentence, say::and_list, say::short_number;

namespace {

constexpr std::size_t most_points = 4, most_shifts = 3, most_unconfirmed = 4;

/// What an orbit does at a point of a kind, and the point as a thing.
struct KindWords {
  const char *kind, *does, *thing;
};
constexpr KindWords kind_words[] = {{"fold", "folds", "fold"},
                                    {"torus", "becomes a torus", "torus"},
                                    {"symmetry", "loses its symmetry", "loss of symmetry"},
                                    {"flip", "doubles its period", "flip"},
                                    {"first contact", "first touches a stop", "first contact"},
                                    {"contact", "gains or loses a contact", "change of contact"}};

const KindWords* find_words(const std::string& kind) {
  const auto* found = std::find_if(std::begin(kind_words), std::end(kind_words),
                                   [&](const KindWords& one) { return one.kind == kind; });
  return found == std::end(kind_words) ? nullptr : found;
}

const KindWords& point_words(const std::string& kind) {
  static constexpr KindWords other = {"", "changes", "point"};
  const KindWords* found = find_words(kind);
  return found ? *found : other;
}

std::string subject(const ToldPoint& told) {
  const PointName& name = *told.name;
  return fmt::format("the {}{}period-{} orbit", told.ends_stability ? "stable " : "",
                     !name.symmetric   ? ""
                     : *name.symmetric ? "symmetric "
                                       : "asymmetric ",
                     name.period);
}

std::string signed_number(double value, int digits) {
  return (value > 0 ? "+" : "") + short_number(value, digits);
}

std::string how_often(int count) {
  return count == 0 ? "never" : count == 1 ? "once" : count == 2 ? "twice" : fmt::format("{} times", count);
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

PointSpeaker::PointSpeaker(const answers::Compared& study) : study_(study), points_(study) {
  unit_ = report::shown_unit(report::swept_parameter(study.results()).unit);
  limits_ = point_limits_type().read(study.results().derived);
  orders_ = point_orders_type().read(study.results().derived);
  if (!known()) return;
  told_ = told_points(points_, limits_, orders_);
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
  const double own = told.point->half;
  const auto half = refined   ? std::optional(0.5 * (*limit.high - *limit.low))
                    : own > 0 ? std::optional(own)
                              : std::nullopt;
  const KindWords& words = point_words(told.name->kind);
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
  for (const PointOrderRow& row : orders_) {
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
    return a.name->period == b.name->period && a.name->symmetric == b.name->symmetric;
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
}

void PointSpeaker::say_unconfirmed(say::Answer& answer) const {
  if (!told_.empty()) return;
  Sentence said;
  std::vector<std::string> parts;
  std::size_t count = 0;
  for (const StudyPoint& one : points_.points()) {
    if (one.owner != points_.root() || !find_words(one.kind) || std::isnan(one.value)) continue;
    if (++count > most_unconfirmed) continue;
    parts.push_back(fmt::format("{} at {}", point_words(one.kind).thing, short_number(one.value, 6)));
    Clause part{.form = "value", .measure = point_words(one.kind).thing, .methods = points_.reference()->id};
    part.value = one.value;
    part.low = one.row.low;
    part.high = one.row.high;
    part.unit = unit_;
    part.status = "one";
    said.clauses.push_back(part);
  }
  if (parts.empty()) {
    answer.say("The branches have no special point.", Clause{.form = "status", .status = "none"});
    return;
  }
  if (count > most_unconfirmed) parts.push_back(fmt::format("{} more", count - most_unconfirmed));
  said.text = fmt::format("{}: {}{}.",
                          points_.cases().size() > 1 ? "No special point is confirmed by a second case; the finest has"
                                                     : "One case, so that no second one confirms its points",
                          and_list(parts), count > most_unconfirmed ? "" : unit());
  answer.say(std::move(said));
}

void PointSpeaker::say_shifts(say::Answer& answer) const {
  if (told_.empty()) return;
  const std::string& name = told_.front().name->text;
  std::vector<PointShiftRow> moved, still;
  for (PointShiftRow& row : point_shifts_type().read(study_.results().derived)) {
    if (row.name != name || say::is_refinement(row.choice) || !row.shift || !row.low || !row.high) continue;
    (*row.low > 0 || *row.high < 0 ? moved : still).push_back(std::move(row));
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
    Clause part{.form = "differ", .measure = point_words(told_.front().name->kind).thing, .choice = row.choice};
    part.who = row.value;
    part.methods = row.id;
    part.value = row.shift;
    part.low = row.low;
    part.high = row.high;
    part.unit = unit_;
    said.clauses.push_back(part);
  }
  const std::string thing = point_words(told_.front().name->kind).thing;
  if (!parts.empty()) {
    said.text = fmt::format("The {} moves by {}", thing, and_list(parts));
    if (moved.size() > most_shifts) said.text += fmt::format(", by less in {} more cases", moved.size() - most_shifts);
  }
  for (const PointOrderRow& row : orders_)
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
  const std::string thing = point_words(told_.front().name->kind).thing;
  Cases reached;
  Members absent;
  std::size_t shared = 0;
  std::optional<double> least;
  Sentence said;
  for (const PointPresenceRow& row : point_presence_type().read(study_.results().derived)) {
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
  // Folds of all branches of a case by prominence.
  std::map<std::string, std::map<double, int>> folds;
  for (const CaseRecord* one : points_.cases())
    for (const TurnRow& row : turns_type().read(one->tables)) folds[one->id][row.prominence] += row.folds;
  const CaseRecord& reference = *points_.reference();
  const auto finest = folds.find(reference.id);
  if (finest == folds.end()) return;
  // The case of the reference's method and mesh that differs most from it.
  const CaseRecord* coarse = nullptr;
  std::string refined;
  double at = 0;
  int most = 0;
  for (std::size_t c = 0; c < points_.cases().size(); ++c) {
    const std::vector<std::string> differs = points_.differences(c, points_.root());
    if (differs.size() != 1 || !say::is_refinement(differs.front()) || is_reference(*points_.cases()[c])) continue;
    for (const auto& [prominence, count] : folds[points_.cases()[c]->id]) {
      const auto same = finest->second.find(prominence);
      if (same == finest->second.end() || count <= same->second) continue;
      // The largest turns that the finest case has not.
      if (coarse && (prominence < at || (prominence == at && count <= most))) continue;
      coarse = points_.cases()[c];
      refined = differs.front();
      at = prominence;
      most = count;
    }
  }
  if (!coarse) return;
  Sentence said;
  const int left = finest->second.at(at);
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

void PointSpeaker::say_nothing(say::Answer& answer) const {
  std::string note;
  for (const CaseRecord& one : study_.results().cases)
    for (const SpecialRow& row : special_points_type().read(one.tables))
      if (note.empty() && !row.note.empty()) note = row.note;
  answer.say(note.empty() ? "No periodic orbit was found." : "No periodic orbit was found: " + note + ".",
             Clause{.form = "status", .status = "none"});
}

}  // namespace ricochet
