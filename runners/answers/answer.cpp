#include "runners/answers/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runners/answers/limits.hpp"
#include "runners/answers/measure_answer.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/report/html.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/row_type.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet::answers {

void Answer::say(std::string text, Clause clause) {
  sentences.push_back({std::move(text), {std::move(clause)}});
}

Table Answer::table() const {
  Table table = answers_type().head();
  int order = 0;
  for (const Sentence& sentence : sentences) {
    ++order;
    bool first = true;
    for (Clause clause : sentence.clauses) {
      clause.order = order;
      clause.sentence = first ? sentence.text : "";
      first = false;
      table.rows.push_back(answers_type().rows.row(clause));
    }
  }
  return table;
}

namespace {

std::optional<double> finite(std::optional<double> value, double factor) {
  return value && std::isfinite(*value) ? std::optional(*value * factor) : std::nullopt;
}

}  // namespace

const TableType<MeasureLimit>& limits_type() {
  static const TableType<MeasureLimit> all = [] {
    RowType<MeasureLimit> rows;
    rows.add({"measure", "", "The measure."}, &MeasureLimit::measure)
        .add({"case", "", "The case of the finest mesh and step that has a value."}, &MeasureLimit::id)
        .add({"value", "", "The value there, over the scale of its measure where that is a share; in `unit`."},
             &MeasureLimit::value)
        .add({"u", "", "Uncertainty that step and mesh leave, in `unit`; none of a single size, and of what grows."},
             &MeasureLimit::uncertainty)
        .add({"low", "", "Where the limit may be: from."}, &MeasureLimit::low)
        .add({"high", "", "Where the limit may be: to."}, &MeasureLimit::high)
        .add({"unit", "", "Unit of these."}, &MeasureLimit::unit)
        .add({"status", "",
              "What the values do as they are refined: one, same, two, settles, reaches truth, vanishes, moves, "
              "wanders, blows up."},
             &MeasureLimit::status)
        .add({"order", "1", "Order of convergence in the step, where two orders in a row agree."}, &MeasureLimit::order)
        .add({"step_moves", "", "What the step still moves it by, in `unit`."}, &MeasureLimit::step_moves)
        .add({"mesh_moves", "", "What the mesh still moves it by, in `unit`."}, &MeasureLimit::mesh_moves)
        .add({"steps", "1", "Steps at the finest mesh."}, &MeasureLimit::steps)
        .add({"meshes", "1", "Meshes at the finest step."}, &MeasureLimit::meshes)
        .add({"method", "", "The method in words."}, &MeasureLimit::method)
        .add({"tier", "1", "Methods with one number are not told apart; 1 is best, or least where none is better."},
             &MeasureLimit::tier)
        .add({"truth", "", "What an exact method gives, in `unit`, where that is known."}, &MeasureLimit::truth);
    return TableType<MeasureLimit>{
        "limits",
        "One row per method and measure: the value at the finest step and mesh, and how far refining them still "
        "moves it.",
        rows};
  }();
  return all;
}

Table limits_table(const Compared& study, const std::vector<std::string>& measures) {
  const StudyResults& results = study.results();
  const TableType<MeasureLimit>& type = limits_type();
  Table table{type.name, type.text, axis_columns(results, study.columns()), {}};
  table.columns = joined(std::move(table.columns), type.rows.columns());
  for (const std::string& measure : measures) {
    const MeasureLimits limits = limits_of(study, measure, keeps_energy(results), all_cases(results));
    const std::vector<const Method*> methods = limits.with_limit();
    const std::vector<std::size_t> tiers = in_tiers(study, limits)
                                               ? TierSpeaker(study, limits, study.columns()).places()
                                               : std::vector<std::size_t>(methods.size(), 0);
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const Method* method = methods[k];
      const auto tier = tiers[k] > 0 ? std::optional(static_cast<int>(tiers[k])) : std::nullopt;
      const double factor = limits.words.factor;
      const Limit& limit = *method->limit;
      const auto move = [&](const std::optional<Limit>& along) -> std::optional<double> {
        return along ? finite(along->uncertainty, factor) : std::nullopt;
      };
      const auto sizes = [](const std::optional<Limit>& along) { return along ? static_cast<int>(along->sizes) : 0; };
      MeasureLimit row{.measure = measure, .id = method->finest->id, .value = factor * limit.value};
      row.uncertainty = finite(limit.uncertainty, factor);
      row.low = finite(limit.low, factor);
      row.high = finite(limit.high, factor);
      row.unit = limits.words.unit;
      row.status = word(limit.status);
      row.order = limit.order;
      row.step_moves = move(method->step);
      row.mesh_moves = move(method->mesh);
      row.steps = sizes(method->step);
      row.meshes = sizes(method->mesh);
      row.method = study.label(method->first());
      row.tier = tier;
      row.truth = finite(limits.words.truth, factor);
      add_row(table, axes_of(method->first(), study.columns()), type.rows.row(row));
    }
  }
  return table;
}

Table refinements_table(const Compared& study, const std::vector<std::string>& measures) {
  const StudyResults& results = study.results();
  Table table{"refinements",
              "The values that limits rest on: one row per method, measure, step at the finest mesh, and mesh at the "
              "finest step.",
              {{"measure", "", "The measure."},
               {"method", "", "The case that stands for the method in limits."},
               {"refined", "", "step or mesh."},
               {"size", "", "The step, in s or in periods, or the number of elements or modes."},
               {"value", "", "The value, in `unit`."},
               {"unit", "", "Unit of the value."}},
              {}};
  for (const std::string& measure : measures) {
    const MeasureLimits limits = limits_of(study, measure, keeps_energy(results), all_cases(results));
    for (const Method* method : limits.with_limit()) {
      const double h = study.step(*method->finest).value_or(0), N = study.elements(*method->finest).value_or(1);
      for (const auto& [size, value] : method->grid) {
        const bool by_step = size.second == N, by_mesh = size.first == h;
        const double shown = limits.words.factor * value;
        if (by_step && size.first > 0)
          table.rows.push_back({measure, method->finest->id, "step", size.first, shown, limits.words.unit});
        if (by_mesh && size.second > 1)
          table.rows.push_back({measure, method->finest->id, "mesh", size.second, shown, limits.words.unit});
      }
    }
  }
  return table;
}

Table differences_table(const Compared& study, const std::vector<std::string>& measures) {
  const StudyResults& results = study.results();
  Table table{"differences",
              "One row per choice, measure and combination of all other choices: how far apart the two levels are that "
              "are farthest apart.",
              {{"choice", "", "The choice: a role with its parameters, or an axis of the study."},
               {"measure", "", "The measure."}},
              {}};
  for (const std::string& column : study.columns()) table.columns.push_back(axis_column(results, column));
  for (const Column& column :
       {Column{"levels", "1", "Levels of the choice that were compared."},
        {"difference", "%", "Difference at the finest step and mesh, over one scale for all that are compared."},
        {"u", "%", "Uncertainty that step and mesh leave of it; none of a single step and mesh."},
        {"most", "", "The level with the largest value."},
        {"least", "", "The level with the smallest value."},
        {"verdict", "",
         "matters: the difference is beyond 1 % and its uncertainty; does not matter: both within; open."}})
    table.columns.push_back(column);
  for (const std::string& measure : measures) {
    const MeasureLimits limits = limits_of(study, measure, keeps_energy(results), all_cases(results));
    for (const ChoiceEffect& effect : choice_effects(study, limits)) {
      const std::vector<std::string> own = study.columns_of(effect.choice);
      for (const ChoiceRow& one : effect.rows) {
        Row row = {effect.choice, measure};
        for (const std::string& column : study.columns()) {
          const bool of_choice = std::find(own.begin(), own.end(), column) != own.end();
          row.push_back(of_choice ? Cell() : axis(*one.combination, column));
        }
        for (Cell cell : {Cell(one.levels), Cell(100 * one.difference), Cell(finite(one.uncertainty, 100)),
                          Cell(one.most), Cell(one.least), Cell(word(one.matters()))})
          row.push_back(std::move(cell));
        table.rows.push_back(std::move(row));
      }
    }
  }
  return table;
}

namespace {

constexpr std::size_t most_rows = 10, most_sizes = 4, most_page_rows = 14;

std::string status_words(const Limit& limit) {
  switch (limit.status) {
    case LimitStatus::one:
      return "one step";
    case LimitStatus::same:
      return "the same at every step";
    case LimitStatus::two:
      return "two steps";
    case LimitStatus::settles:
      return "settles" + (limit.order ? fmt::format(", order {:.1f}", *limit.order) : "");
    case LimitStatus::reaches_truth:
      return "reaches it" + (limit.order ? fmt::format(", order {:.1f}", *limit.order) : "");
    case LimitStatus::vanishes:
      return fmt::format("falls to zero, order {:.1f}", limit.order.value_or(0));
    case LimitStatus::moves:
      return limit.trend > 0 ? "still rises" : limit.trend < 0 ? "still falls" : "still moves";
    case LimitStatus::wanders:
      return "wanders";
    case LimitStatus::blows_up:
      return "grows without bound";
  }
  return "";
}

std::string limit_words(const MeasureWords& words, const Limit& limit) {
  if (limit.status == LimitStatus::wanders) return range_text(words, limit.low, limit.high);
  return with_uncertainty(words, limit.value, limit.uncertainty);
}

/// The evidence as cells of text: its columns, rows, and how many more the CSV file has.
struct Evidence {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
  std::size_t more = 0;
  std::string caption, file;
};

Evidence of_methods(const Compared& study, const MeasureLimits& limits, std::size_t most) {
  std::vector<const Method*> methods = limits.with_limit();
  std::stable_sort(methods.begin(), methods.end(), [&](const Method* a, const Method* b) {
    return limits.words.direction < 0 ? a->limit->value < b->limit->value : a->limit->value > b->limit->value;
  });
  std::set<double, std::greater<>> sizes;
  for (const Method* method : methods)
    for (const auto& [size, value] : method->grid) sizes.insert(size.first);
  std::vector<double> shown(sizes.begin(), sizes.end());
  if (shown.size() > most_sizes) shown.erase(shown.begin(), shown.end() - static_cast<std::ptrdiff_t>(most_sizes));
  const bool steps = study.step(*methods.front()->finest).has_value();
  Evidence out;
  out.file = "limits.csv";
  out.caption = capitalised(limits.words.words) + " of each method as it is refined, at the finest mesh; best first.";
  out.head = {limits.words.words};
  for (const double size : shown) out.head.push_back(steps ? study.step_words(size) : "value");
  out.head.insert(out.head.end(), {"limit", "status"});
  for (std::size_t k = 0; k < std::min(most, methods.size()); ++k) {
    const Method& method = *methods[k];
    const double N = study.elements(*method.finest).value_or(1);
    const std::string label = study.label(method.first());
    std::vector<std::string> line = {label.empty() ? "the one method" : label};
    for (const double size : shown) {
      const auto value = method.at(size, N);
      line.push_back(value ? cell_text(limits.words, *value) : "–");
    }
    line.push_back(limit_words(limits.words, *method.limit));
    line.push_back(status_words(*method.limit));
    out.rows.push_back(std::move(line));
  }
  out.more = methods.size() > most ? methods.size() - most : 0;
  return out;
}

Evidence of_choices(const Compared& study, const MeasureLimits& limits, std::size_t most) {
  std::vector<ChoiceEffect> effects = choice_effects(study, limits);
  std::stable_sort(effects.begin(), effects.end(), [](const auto& a, const auto& b) { return a.typical > b.typical; });
  Evidence out;
  out.file = "differences.csv";
  out.caption = "How far each choice moves " + limits.words.words + ", all else the same and as fine as there is.";
  out.head = {limits.words.words, "typical", "most", "refinement leaves", "matters in"};
  for (std::size_t k = 0; k < std::min(most, effects.size()); ++k) {
    const ChoiceEffect& one = effects[k];
    out.rows.push_back({spoken(one.choice), percent(one.typical), percent(one.largest),
                        one.typical_uncertainty ? percent(*one.typical_uncertainty) : "–",
                        fmt::format("{} of {}", one.matters, one.rows.size())});
  }
  out.more = effects.size() > most ? effects.size() - most : 0;
  return out;
}

Evidence evidence(const Compared& study, const std::string& measure, std::size_t most) {
  const MeasureLimits limits = limits_of(study, measure, keeps_energy(study.results()), all_cases(study.results()));
  if (limits.with_limit().empty()) return {};
  return in_tiers(study, limits) ? of_methods(study, limits, most) : of_choices(study, limits, most);
}

}  // namespace

std::string evidence_text(const Compared& study, const std::string& measure) {
  const Evidence found = evidence(study, measure, most_rows);
  if (found.rows.empty()) return "";
  TextTable table(found.head);
  for (const auto& row : found.rows) table.add(row);
  return table.text(2) + (found.more > 0 ? fmt::format("  … and {} more in {}\n", found.more, found.file) : "");
}

std::string evidence_html(const Compared& study) {
  // The measure that the answer rests on stands first in `limits`.
  const std::vector<MeasureLimit> limits = limits_type().read(study.results().derived);
  if (limits.empty()) return "";
  const Evidence found = evidence(study, limits.front().measure, most_page_rows);
  if (found.rows.empty()) return "";
  const std::string more = found.more > 0 ? fmt::format(" {} more in {}.", found.more, found.file) : "";
  // What is concluded stands before what it rests on, which may go on out of sight, the finest first.
  const bool concludes = found.file == "limits.csv";
  const auto turned = [&](std::vector<std::string> cells) {
    if (concludes) {
      std::reverse(cells.begin() + 1, cells.end());
      std::swap(cells[1], cells[2]);
    }
    return cells;
  };
  const std::size_t words = concludes ? 2 : found.head.size() - 1;
  const std::vector<std::string> head = turned(found.head);
  report::HtmlTable table(report::escape(found.caption + more), {}, "matrix evidence");
  for (std::size_t k = 0; k < head.size(); ++k) table.add({.text = head[k], .number = k > 0 && k != words});
  for (const auto& row : found.rows) {
    const std::vector<std::string> cells = turned(row);
    table.row(cells.front());
    for (std::size_t k = 1; k < cells.size(); ++k) k == words ? table.text(cells[k]) : table.number(cells[k]);
  }
  return table.html();
}

}  // namespace ricochet::answers
