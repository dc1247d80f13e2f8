#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/kinds/basins/basin_analysis.hpp"
#include "runners/kinds/basins/basins.hpp"
#include "runners/kinds/basins/cell_scenes.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet {
namespace {

namespace say = answers;
using say::Clause, say::Sentence, say::percent, say::short_number;

constexpr double border_moves = 0.005;  // share of the cells

std::string motion_of(const FractionRow& row) {
  const std::string period = fmt::format("period {}", row.period.value_or(1));
  if (row.regime == text(Regime::periodic)) return period;
  if (row.regime == text(Regime::chattering)) return period + " with chatter";
  return row.regime;
}

constexpr double half_of_them = 0.5, some_of_them = 0.05;

/// What becomes of the starts of one case.
struct CaseEnds {
  const CaseRecord* record = nullptr;
  std::map<int, const FractionRow*> ends;  ///< by attractor
  double decided = 0, undecided = 0;       ///< cells that are starts
  double undecided_share() const { return decided + undecided > 0 ? undecided / (decided + undecided) : 0; }
  double fraction(int attractor) const {
    const auto found = ends.find(attractor);
    return found == ends.end() ? 0 : found->second->fraction.value_or(0);
  }
  double half(int attractor) const {
    const auto found = ends.find(attractor);
    return found == ends.end() ? 0 : 0.5 * (found->second->high.value_or(0) - found->second->low.value_or(0));
  }
};

class BasinSpeaker {
 public:
  BasinSpeaker(const say::Compared& study, const BasinAnalysis& basins) : study_(study), basins_(basins) {
    std::map<std::string, CaseEnds> by_id;
    for (const FractionRow& row : basins.fractions) by_id[row.id].ends[row.attractor] = &row;
    for (const CaseRecord& record : study.results().cases)
      if (const auto found = by_id.find(record.id); found != by_id.end()) {
        const BasinStarts& starts = basins.starts.at(record.id);
        found->second.record = &record;
        found->second.decided = static_cast<double>(starts.decided);
        found->second.undecided = static_cast<double>(starts.undecided);
        (found->second.undecided_share() > half_of_them ? vague_ : cases_).push_back(found->second);
      }
  }
  std::optional<Sentence> no_starts() const;
  void say_undecided(say::Answer& answer) const;
  void say_ends(say::Answer& answer) const;
  void say_border(say::Answer& answer) const;
  void say_fractal(say::Answer& answer) const;

 private:
  /// A case as its method, step and mesh; never empty.
  std::string name(const CaseRecord& record) const {
    std::string out = study_.label(record);
    const auto step = study_.step(record), elements = study_.elements(record);
    if (study_.varies("steps_per_period") && step) out += (out.empty() ? "" : ", ") + study_.step_words(*step);
    if (study_.varies(study_.mesh_column()) && elements)
      out += (out.empty() ? "" : ", ") + study_.mesh_words(*elements);
    return out.empty() ? "the one method" : out;
  }
  const CaseEnds* find(const std::string& id) const {
    const auto found =
        std::find_if(cases_.begin(), cases_.end(), [&](const CaseEnds& one) { return one.record->id == id; });
    return found == cases_.end() ? nullptr : &*found;
  }
  /// Whether two cases lead as many starts to every end, as far as the grid tells.
  bool alike(const CaseEnds& a, const CaseEnds& b) const {
    std::set<int> all;
    for (const auto* one : {&a, &b})
      for (const auto& [attractor, row] : one->ends) all.insert(attractor);
    return std::all_of(all.begin(), all.end(), [&](int attractor) {
      return std::abs(a.fraction(attractor) - b.fraction(attractor)) <=
             std::max(2 * std::max(a.half(attractor), b.half(attractor)), 1e-12);
    });
  }
  Sentence ends_of(const std::vector<const CaseEnds*>& group, bool named) const;
  std::string names(const std::vector<const CaseEnds*>& group) const;

  const say::Compared& study_;
  const BasinAnalysis& basins_;
  std::vector<CaseEnds> cases_, vague_;  ///< those with half of their starts decided, and the others
};

std::string BasinSpeaker::names(const std::vector<const CaseEnds*>& group) const {
  constexpr std::size_t few = 3;
  std::vector<std::string> out;
  for (const CaseEnds* one : group) out.push_back(name(*one->record));
  return out.size() <= few ? say::and_names(out) : fmt::format("{} of {} cases", out.size(), cases_.size());
}

/// Cells that begin beyond a stop, once for all cases.
std::optional<Sentence> BasinSpeaker::no_starts() const {
  std::size_t least = 0, most = 0, of = 0, cases = 0;
  std::string ids;
  for (const auto& [id, starts] : basins_.starts) {
    const std::size_t beyond = starts.no_starts;
    if (beyond == 0) continue;
    least = cases == 0 ? beyond : std::min(least, beyond);
    most = std::max(most, beyond);
    of = std::max(of, starts.cells);
    ids += (ids.empty() ? "" : " ") + id;
    ++cases;
  }
  if (cases == 0) return std::nullopt;
  Clause clause{.form = "basin", .measure = "no starts", .methods = ids};
  clause.value = static_cast<double>(most);
  clause.low = static_cast<double>(least);
  clause.high = static_cast<double>(of);
  clause.unit = "cells";
  clause.status = no_start;
  const std::string count = least == most ? std::to_string(most) : fmt::format("{} to {}", least, most);
  return Sentence{
      fmt::format(
          "{} of {} cells begin beyond a stop{}: they are no starts, and no share counts them.", count, of,
          cases == basins_.starts.size() ? "" : fmt::format(" in {} of {} cases", cases, basins_.starts.size())),
      {clause}};
}

/// Of what is not decided nothing is told.
void BasinSpeaker::say_undecided(say::Answer& answer) const {
  std::vector<const CaseEnds*> many;
  double least = 1, most = 0;
  for (const std::vector<CaseEnds>* list : {&cases_, &vague_})
    for (const CaseEnds& one : *list)
      if (const double share = one.undecided_share(); share > some_of_them) {
        many.push_back(&one);
        least = std::min(least, share);
        most = std::max(most, share);
      }
  if (many.empty()) return;
  const std::size_t all = cases_.size() + vague_.size();
  Clause clause{.form = "basin", .who = many.size() == all ? "every case" : names(many)};
  clause.low = 100 * least;
  clause.high = 100 * most;
  clause.unit = "%";
  clause.status = "undecided";
  const std::string share = percent(least) == percent(most) ? percent(most) : percent(least) + " to " + percent(most);
  answer.say(fmt::format("{} of the starts are undecided{}; more periods are needed.", share,
                         many.size() == all ? "" : " with " + clause.who),
             clause);
}

/// "81.5 ± 1.6 % of the starts end in period 1, 18.5 ± 1.6 % without contact", the mean over a group of cases.
Sentence BasinSpeaker::ends_of(const std::vector<const CaseEnds*>& group, bool named) const {
  struct End {
    double low = 1, high = 0, half = 0;
    const FractionRow* row = nullptr;
  };
  std::map<int, End> ends;
  for (const CaseEnds* one : group)
    for (const auto& [attractor, row] : one->ends) ends[attractor].row = row;
  for (auto& [attractor, end] : ends)
    for (const CaseEnds* one : group) {
      end.low = std::min(end.low, one->fraction(attractor));
      end.high = std::max(end.high, one->fraction(attractor));
      end.half = std::max(end.half, one->half(attractor));
    }
  std::vector<End> by_size;
  for (const auto& [attractor, end] : ends)
    if (end.high > 0) by_size.push_back(end);
  std::stable_sort(by_size.begin(), by_size.end(), [](const End& a, const End& b) { return a.high > b.high; });
  say::MeasureWords words;
  words.unit = "%";
  words.factor = 100;
  const std::size_t told = named ? 2 : 4;
  const std::string who = names(group);
  Sentence said;
  for (std::size_t k = 0; k < by_size.size(); ++k) {
    const End& end = by_size[k];
    const std::string motion = motion_of(*end.row);
    Clause one{.form = "basin", .choice = named ? who : "", .who = motion};
    one.value = 50 * (end.low + end.high);
    one.low = 100 * end.low;
    one.high = 100 * end.high;
    one.uncertainty = 100 * end.half;
    one.unit = "%";
    one.status = named ? "differ" : "agree";
    said.clauses.push_back(one);
    if (k >= told) continue;
    said.text += fmt::format("{}{} ± {}{}{}", k == 0 ? "" : ", ",
                             say::value_text(words, 0.5 * (end.low + end.high), end.half, false),
                             say::uncertainty_text(words, end.half), k == 0 ? " of the starts end " : " ",
                             motion == "no contact" ? "without contact" : "in " + motion);
  }
  if (by_size.size() > told) said.text += fmt::format("; {} more ends", by_size.size() - told);
  if (named) said.text = "With " + who + " " + said.text;
  said.text += ".";
  return said;
}

void BasinSpeaker::say_ends(say::Answer& answer) const {
  if (cases_.empty()) return;
  std::vector<std::vector<const CaseEnds*>> groups;
  for (const CaseEnds& one : cases_) {
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return std::all_of(group.begin(), group.end(), [&](const CaseEnds* other) { return alike(*other, one); });
    });
    if (found == groups.end())
      groups.push_back({&one});
    else
      found->push_back(&one);
  }
  constexpr std::size_t most_groups = 3;
  for (std::size_t k = 0; k < std::min(most_groups, groups.size()); ++k)
    answer.say(ends_of(groups[k], groups.size() > 1 || !vague_.empty()));
}

/// Whether the ends depend on each choice, by the cells in which two cases differ that differ in it alone.
void BasinSpeaker::say_border(say::Answer& answer) const {
  const std::vector<BasinDifferenceRow>& rows = basins_.differences;
  if (rows.empty()) {
    if (study_.results().cases.size() == 1)
      answer.say("One method only: whether another moves the border is not known.",
                 Clause{.form = "basin", .status = "one"});
    return;
  }
  std::vector<std::string> columns = study_.columns(), choices = study_.choices();
  for (const std::string& refined : {std::string("steps_per_period"), study_.mesh_column()})
    if (study_.varies(refined) && std::find(columns.begin(), columns.end(), refined) == columns.end()) {
      columns.emplace_back(refined);
      choices.emplace_back(refined);
    }
  Sentence moves, still;
  for (const std::string& choice : choices) {
    std::vector<std::string> others;
    for (const std::string& column : columns)
      if (axis_role(column) != choice && column != choice) others.push_back(column);
    const BasinDifferenceRow* most = nullptr;
    for (const BasinDifferenceRow& row : rows) {
      const CaseEnds *one = find(row.id), *other = find(row.other);
      if (!one || !other || row.cells == 0) continue;
      if (study_.key(*one->record, others) != study_.key(*other->record, others)) continue;
      if (!most || row.share.value_or(0) > most->share.value_or(0)) most = &row;
    }
    if (!most) continue;
    const bool moved = most->share.value_or(0) > border_moves;
    Clause clause{.form = "basin", .choice = choice, .methods = most->id + " " + most->other};
    clause.who = name(*find(most->id)->record) + " and " + name(*find(most->other)->record);
    clause.value = most->differ;
    clause.high = most->cells;
    clause.unit = "cells";
    clause.status = moved ? "moves" : "does not move";
    Sentence& said = moved ? moves : still;
    const std::string cells = fmt::format("{} of {} cells differ{}", most->differ, most->cells,
                                          moved               ? " between " + clause.who
                                          : most->differ == 1 ? "s"
                                                              : "");
    said.text += said.text.empty() ? fmt::format("{} {} the border: {}", say::capitalised(say::spoken(choice)),
                                                 moved ? "moves" : "does not move", cells)
                                   : fmt::format("; {} does {}: {}", moved ? "so" : "nor", say::spoken(choice), cells);
    said.clauses.push_back(std::move(clause));
  }
  for (Sentence* one : {&moves, &still})
    if (!one->text.empty()) {
      one->text += ".";
      answer.say(std::move(*one));
    }
}

void BasinSpeaker::say_fractal(say::Answer& answer) const {
  std::vector<UncertaintyRow> rows = basins_.uncertainty;
  std::erase_if(rows,
                [&](const UncertaintyRow& row) { return !row.exponent || !row.low || !row.high || !find(row.id); });
  if (rows.empty()) return;
  const auto fractal = std::find_if(rows.begin(), rows.end(), [](const UncertaintyRow& row) { return *row.high < 1; });
  const UncertaintyRow& row = fractal == rows.end() ? rows.front() : *fractal;
  Clause clause{
      .form = "basin", .measure = "uncertainty exponent", .who = name(*find(row.id)->record), .methods = row.id};
  clause.value = row.exponent;
  clause.low = row.low;
  clause.high = row.high;
  clause.unit = "1";
  clause.status = fractal == rows.end() ? "not shown" : "fractal";
  const std::string numbers = fmt::format("{:.2f}, {:.2f} to {:.2f}", *row.exponent, *row.low, *row.high);
  answer.say(fractal == rows.end() ? fmt::format("Whether the border is fractal is not shown (exponent {}).", numbers)
                                   : fmt::format("The border is fractal with {} (exponent {}).", clause.who, numbers),
             clause);
}

}  // namespace

answers::Answer basins_answer(const answers::Compared& study, const BasinAnalysis& of) {
  answers::Answer answer;
  const BasinSpeaker basins(study, of);
  basins.say_undecided(answer);
  basins.say_ends(answer);
  basins.say_border(answer);
  basins.say_fractal(answer);
  if (answer.sentences.empty()) answer.say("No cell was decided.", Clause{.form = "status", .status = "none"});
  if (auto beyond = basins.no_starts()) answer.sentences.insert(answer.sentences.begin() + 1, std::move(*beyond));
  for (Sentence& one : answers::ended(study)) answer.say(std::move(one));
  return answer;
}

}  // namespace ricochet
