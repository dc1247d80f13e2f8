#include "runners/kinds/basins/basin_answers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

namespace say = answers;
using say::Clause, say::Sentence, say::percent, say::short_number;

constexpr double border_moves = 0.005;  // share of the cells

std::string motion_of(const FractionRow& row) {
  if (row.regime == "periodic") return fmt::format("period {}", row.period.value_or(1));
  return row.regime;
}

class BasinSpeaker {
 public:
  explicit BasinSpeaker(const say::Compared& study)
      : study_(study), fractions_(basin_fractions_type().read(study.results().derived)) {
    for (const CaseRecord& record : study.results().cases) by_id_[record.id] = &record;
  }
  void say_ends(say::Answer& answer) const;
  void say_border(say::Answer& answer) const;
  void say_fractal(say::Answer& answer) const;

 private:
  /// A case as its method, step and mesh; never empty.
  std::string name(const std::string& id) const {
    const auto found = by_id_.find(id);
    if (found == by_id_.end()) return id;
    std::string out = study_.label(*found->second);
    const auto step = study_.step(*found->second), elements = study_.elements(*found->second);
    if (study_.varies("steps_per_period") && step) out += (out.empty() ? "" : ", ") + study_.step_words(*step);
    if (study_.varies("elements") && elements) out += (out.empty() ? "" : ", ") + short_number(*elements) + " elements";
    return out.empty() ? "the one method" : out;
  }

  const say::Compared& study_;
  std::vector<FractionRow> fractions_;
  std::map<std::string, const CaseRecord*> by_id_;
};

/// "81.5 ± 1.6 % of the starts end in period 1, 18.5 ± 1.6 % without contact."
void BasinSpeaker::say_ends(say::Answer& answer) const {
  InOrderMet<int, std::vector<const FractionRow*>> ends;
  for (const FractionRow& row : fractions_) ends[row.attractor].push_back(&row);
  std::vector<std::pair<int, std::vector<const FractionRow*>>> by_size = ends.list();
  const auto largest = [](const std::vector<const FractionRow*>& rows) {
    double most = 0;
    for (const FractionRow* row : rows) most = std::max(most, row->fraction.value_or(0));
    return most;
  };
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](const auto& a, const auto& b) { return largest(a.second) > largest(b.second); });
  say::MeasureWords words;
  words.unit = "%";
  words.factor = 100;
  constexpr std::size_t told = 4;
  Sentence said;
  for (std::size_t k = 0; k < by_size.size(); ++k) {
    const auto& rows = by_size[k].second;
    double low = 1, high = 0, half = 0;
    for (const FractionRow* row : rows) {
      low = std::min(low, row->fraction.value_or(0));
      high = std::max(high, row->fraction.value_or(0));
      half = std::max(half, 0.5 * (row->high.value_or(0) - row->low.value_or(0)));
    }
    const std::string motion = motion_of(*rows.front());
    const std::string in = motion == "no contact" ? "without contact" : "in " + motion;
    Clause one{.form = "basin", .who = motion};
    one.value = 50 * (low + high);
    one.low = 100 * low;
    one.high = 100 * high;
    one.uncertainty = 100 * half;
    one.unit = "%";
    one.status = high - low > 2 * half ? "differ" : "agree";
    said.clauses.push_back(one);
    if (k >= told) continue;
    const std::string first = said.text.empty() ? " of the starts end " : " ";
    std::string text;
    if (high - low > 2 * half) {
      // Methods that differ are named each.
      for (const FractionRow* row : rows)
        text += fmt::format("{}{} ({})", text.empty() ? "" : ", ",
                            say::value_text(words, row->fraction.value_or(0), half), name(row->id));
    } else {
      text = fmt::format("{} ± {}", say::value_text(words, 0.5 * (low + high), half, false),
                         say::uncertainty_text(words, half));
    }
    said.text += fmt::format("{}{}{}{}", said.text.empty() ? "" : ", ", text, first, in);
  }
  if (said.text.empty()) return;
  if (by_size.size() > told) said.text += fmt::format("; {} more ends", by_size.size() - told);
  said.text += ".";
  answer.say(std::move(said));
}

/// Whether the ends depend on the method, by the cells that differ.
void BasinSpeaker::say_border(say::Answer& answer) const {
  std::vector<BasinDifferenceRow> rows = basin_differences_type().read(study_.results().derived);
  if (rows.empty()) {
    if (study_.results().cases.size() == 1)
      answer.say("One method only: whether another moves the border is not known.",
                 Clause{.form = "basin", .status = "one"});
    return;
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return a.share.value_or(0) > b.share.value_or(0); });
  const BasinDifferenceRow &most = rows.front(), &least = rows.back();
  const std::string what = study_.choices().size() == 1 && study_.varies(study_.choices().front())
                               ? say::spoken(study_.choices().front())
                               : "the method";
  const auto pair = [&](const BasinDifferenceRow& row) {
    return fmt::format("{} of {} cells differ between {} and {}", row.differ, row.cells, name(row.id), name(row.other));
  };
  const auto clause = [&](const BasinDifferenceRow& row) {
    Clause out{.form = "basin",
               .choice = study_.choices().size() == 1 ? study_.choices().front() : "",
               .methods = row.id + " " + row.other};
    out.who = name(row.id) + " and " + name(row.other);
    out.value = row.differ;
    out.high = row.cells;
    out.unit = "cells";
    out.status = row.share.value_or(0) > border_moves ? "moves" : "does not move";
    return out;
  };
  Sentence said;
  said.clauses.push_back(clause(most));
  if (most.share.value_or(0) <= border_moves)
    said.text = fmt::format("{} does not move the border: {}{}.", say::capitalised(what),
                            rows.size() > 1 ? "at most " : "", pair(most));
  else
    said.text = fmt::format(
        "{} moves the border: {}{}.", say::capitalised(what), pair(most),
        rows.size() > 1 ? fmt::format(", {} between {} and {}", least.differ, name(least.id), name(least.other)) : "");
  if (rows.size() > 1) said.clauses.push_back(clause(least));
  answer.say(std::move(said));
}

void BasinSpeaker::say_fractal(say::Answer& answer) const {
  std::vector<UncertaintyRow> rows = basin_uncertainty_type().read(study_.results().derived);
  std::erase_if(rows, [](const UncertaintyRow& row) { return !row.exponent || !row.low || !row.high; });
  if (rows.empty()) return;
  const auto fractal = std::find_if(rows.begin(), rows.end(), [](const UncertaintyRow& row) { return *row.high < 1; });
  const UncertaintyRow& row = fractal == rows.end() ? rows.front() : *fractal;
  Clause clause{.form = "basin", .measure = "uncertainty exponent", .who = name(row.id), .methods = row.id};
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

answers::Answer basins_answer(const answers::Compared& study) {
  answers::Answer answer;
  const BasinSpeaker basins(study);
  basins.say_ends(answer);
  basins.say_border(answer);
  basins.say_fractal(answer);
  if (answer.sentences.empty()) answer.say("No cell was decided.", Clause{.form = "status", .status = "none"});
  for (Sentence& one : answers::ended(study)) answer.say(std::move(one));
  return answer;
}

}  // namespace ricochet
