#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runners/answers/answer.hpp"
#include "runners/answers/limits.hpp"
#include "runners/report/html.hpp"
#include "runners/table/row_type.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet::answers {
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
