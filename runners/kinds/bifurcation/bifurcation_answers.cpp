#include "runners/kinds/bifurcation/bifurcation_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/orbits/regime.hpp>
#include <set>

#include "runners/kinds/kind.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/report/html.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

using report::CaseView;
using report::list_text;
using report::number_text;

// Of more stretches the classes are counted, of more cases the steps are told from which on they agree.
constexpr std::size_t most_stretches = 8, most_cases = 9, most_listed = 16;
constexpr double nearly_all = 0.95;

void add(Table& answers, const std::string& verdict, const Cell& effect, const std::string& sentence) {
  answers.rows.push_back(AnswerRow{.verdict = verdict, .effect = effect, .sentence = sentence}.row());
}

/// The case that the others are compared with; where nothing is compared the first one that is done.
const CaseRecord* standard_case(const StudyResults& results, const CaseView& view) {
  if (const Table* distances = find_table(results.derived, "distances"); distances && !distances->rows.empty())
    return view.find(TableReader(*distances).text(0, "reference_case"));
  const Cases done = view.with_status("done");
  return done.empty() ? nullptr : done.front();
}

/// "singular · newmark, 2000 steps per period".
std::string case_words(const CaseView& view, const CaseRecord& record) {
  const std::string steps = view.varies("steps_per_period")
                                ? CaseView::text(record, "steps_per_period") + " steps per period"
                                : std::string();
  const std::vector<std::string> others = view.varying_without({"steps_per_period"});
  if (others.empty() && !steps.empty()) return steps;
  return view.name(record, others) + (steps.empty() ? "" : ", " + steps);
}

std::string from_where(const std::string& start) {
  return start == "rest"    ? "From rest"
         : start == "state" ? "From the state of the scene"
         : start == "up"    ? "Upwards"
                            : "Downwards";
}

/// "periodic 1 from 2 to 2.645", "periodic 2 at 2.66", in the order of the parameter.
std::vector<std::string> stretches_of(const std::vector<OrbitRow>& orbits) {
  std::vector<std::string> out;
  for (std::size_t first = 0, next = 0; first < orbits.size(); first = next) {
    const std::string name = orbits[first].motion_text();
    while (next < orbits.size() && orbits[next].motion_text() == name) ++next;
    const std::string low = number_text(orbits[first].parameter, 5), high = number_text(orbits[next - 1].parameter, 5);
    out.push_back(next - first == 1 ? fmt::format("{} at {}", name, low)
                                    : fmt::format("{} from {} to {}", name, low, high));
  }
  return out;
}

/// "periodic 1 at 20 of 41 values", the most frequent first.
std::vector<std::string> class_counts_of(const std::vector<OrbitRow>& orbits) {
  std::vector<std::pair<std::string, std::size_t>> counts;
  for (const OrbitRow& orbit : orbits) ++in_order_met(counts, orbit.motion_text());
  std::stable_sort(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> out;
  for (const auto& [name, count] : counts)
    out.push_back(out.empty() ? fmt::format("{} at {} of {} values", name, count, orbits.size())
                              : fmt::format("{} at {}", name, count));
  return out;
}

/// Speed of the one impact that repeats from one start, by value of the parameter.
std::map<double, double> single_impacts(const CaseRecord& record, const std::string& start) {
  std::map<double, double> speeds;
  const NumberTable* table = find_table(record.numbers, "impacts");
  if (!table) return speeds;
  const std::vector<double>*parameter = &table->values.front().get(), *from = table->numbers("start"),
        *speed = table->numbers("speed");
  const std::vector<std::string>* words = table->words_of("start");
  if (!from || !speed || !words) return speeds;
  std::set<double> several;
  for (std::size_t row = 0; row < table->rows(); ++row)
    if ((*words)[static_cast<std::size_t>((*from)[row])] == start &&
        !speeds.emplace((*parameter)[row], (*speed)[row]).second)
      several.insert((*parameter)[row]);
  for (const double value : several) speeds.erase(value);
  return speeds;
}

/// How hard the stop is hit, where a motion repeats with one impact: of few values, in the standard case and how far
/// the others are from it.
void say_speeds(const CaseView& view, const CaseRecord& standard, const std::string& start, Table& answers) {
  const std::map<double, double> speeds = single_impacts(standard, start);
  if (speeds.empty() || speeds.size() > most_stretches) return;
  std::vector<std::string> said;
  double apart = 0;
  std::size_t others = 0;
  for (const auto& [value, speed] : speeds)
    said.push_back(fmt::format("{} m/s at {}", number_text(speed, 5), number_text(value, 5)));
  for (const CaseRecord* other : view.with_status("done")) {
    if (other == &standard) continue;
    for (const auto& [value, speed] : single_impacts(*other, start))
      if (const auto found = speeds.find(value); found != speeds.end()) {
        ++others;
        apart = std::max(apart, std::abs(speed / found->second - 1));
      }
  }
  add(answers, "impacts", {},
      fmt::format(
          "Where the motion repeats with one impact it hits the stop with {}{}.", list_text(said, said.size()),
          others > 0 ? fmt::format("; in other cases with up to {} % more or less", number_text(100 * apart, 2)) : ""));
}

void say_motions(const StudyResults& results, const CaseView& view, const CaseRecord& standard, Table& answers) {
  std::vector<OrbitRow> orbits = orbits_of(standard);
  const auto first =
      std::find_if(orbits.begin(), orbits.end(), [](const OrbitRow& one) { return !is_random_start(one.start); });
  if (first == orbits.end()) return;
  const std::string start = first->start;
  std::erase_if(orbits, [&](const OrbitRow& one) { return one.start != start || !std::isfinite(one.parameter); });
  std::stable_sort(orbits.begin(), orbits.end(),
                   [](const OrbitRow& a, const OrbitRow& b) { return a.parameter < b.parameter; });
  std::vector<std::string> said = stretches_of(orbits);
  if (said.size() > most_stretches) said = class_counts_of(orbits);
  const std::string who =
      results.cases.size() > 1 ? ", in the reference case (" + case_words(view, standard) + ")" : "";
  add(answers, "diagram", {},
      fmt::format("{}{}, the motion over {} is {}.", from_where(start), who,
                  report::with_unit(report::swept_parameter(results)), list_text(said, most_stretches)));
  say_speeds(view, standard, start, answers);
}

/// How a case compares with the standard one.
struct Compared {
  const CaseRecord* record;
  double same, all, steps;
  double share() const { return same / all; }
};

std::vector<Compared> compared_with(const CaseRecord& standard, const StudyResults& results, const CaseView& view) {
  std::vector<Compared> out;
  const Table* table = find_table(results.derived, "agreement");
  if (!table) return out;
  const TableReader rows(*table);
  const auto of_standard = [&](std::size_t row) { return rows.text(row, "case") == standard.id; };
  // What another case leaves open is not found by it: all that the standard case decides counts.
  double all = 0;
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (of_standard(row) && rows.text(row, "other_case") == standard.id) all = rows.number(row, "compared").value_or(0);
  if (all <= 0) return out;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const CaseRecord* other = view.find(rows.text(row, "other_case"));
    if (!of_standard(row) || !other || other == &standard || other->status != "done") continue;
    out.push_back({other, rows.number(row, "same_class").value_or(0), all,
                   CaseView::number(*other, "steps_per_period").value_or(0)});
  }
  return out;
}

std::string name_without_steps(const CaseView& view, const CaseRecord& record) {
  return view.name(record, view.varying_without({"steps_per_period"}));
}

void say_each(std::vector<Compared> compared, const CaseView& view, const CaseRecord& standard, Table& answers) {
  std::stable_sort(compared.begin(), compared.end(),
                   [](const Compared& a, const Compared& b) { return a.share() > b.share(); });
  std::vector<std::string> said;
  for (const Compared& one : compared) said.push_back(fmt::format("{} ({})", one.same, case_words(view, *one.record)));
  add(answers, "agreement", compared.back().share(),
      fmt::format(
          "Of {} that {} has over values and starts, others share: {}.",
          report::count_text(static_cast<std::size_t>(compared.front().all), "class of motion", "classes of motion"),
          case_words(view, standard), list_text(said, most_listed)));
}

/// From which step on each method has nearly all classes of the standard case.
void say_steps(const std::vector<Compared>& compared, const CaseView& view, const CaseRecord& standard,
               Table& answers) {
  std::vector<std::pair<std::string, std::vector<Compared>>> methods;
  for (const Compared& one : compared) in_order_met(methods, name_without_steps(view, *one.record)).push_back(one);
  std::map<double, std::vector<std::string>> from;  // steps per period, infinity: at none
  for (auto& [name, steps] : methods) {
    std::sort(steps.begin(), steps.end(), [](const Compared& a, const Compared& b) { return a.steps > b.steps; });
    double least = INFINITY;
    for (const Compared& one : steps) {
      if (one.share() < nearly_all) break;
      least = one.steps;
    }
    const Compared& finest = steps.front();
    from[least].push_back(std::isfinite(least) ? name : fmt::format("{} ({})", finest.same, name));
  }
  const std::string whole = fmt::format("the {} classes of {}", compared.front().all, case_words(view, standard));
  for (const auto& [least, names] : from)
    add(answers, "agreement", {},
        std::isfinite(least) ? fmt::format("At least {} of {} from {} steps per period on: {}.",
                                           report::share_text(nearly_all), whole, least, list_text(names, names.size()))
                             : fmt::format("Fewer of {} at every step, with the most steps per period: {}.", whole,
                                           list_text(names, names.size())));
}

void say_attractors(const StudyResults& results, Table& answers) {
  const Table* table = find_table(results.derived, "attractors");
  if (!table || table->rows.empty()) return;
  const TableReader rows(*table);
  std::vector<std::pair<std::string, std::size_t>> labels;
  for (std::size_t row = 0; row < rows.size(); ++row) ++in_order_met(labels, rows.text(row, "label"));
  if (labels.size() == 1 && labels.front().first == "not compared") return;
  std::stable_sort(labels.begin(), labels.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> said;
  const std::string depends = "depends on ";
  for (const auto& [label, count] : labels)
    said.push_back(fmt::format(
        "{} ({})", label.starts_with(depends) ? depends + spoken_choice(label.substr(depends.size())) : label, count));
  add(answers, "attractors", static_cast<double>(rows.size()),
      fmt::format("{} met over all values; as to who shows them: {}.",
                  report::count_text(rows.size(), "attractor was", "attractors were"), list_text(said)));
}

}  // namespace

void say_diagram(const StudyResults& results, Table& answers) {
  const CaseView view(results);
  const CaseRecord* standard = standard_case(results, view);
  if (!standard) return;
  say_motions(results, view, *standard, answers);
  const std::vector<Compared> compared = compared_with(*standard, results, view);
  if (!compared.empty()) {
    if (compared.size() <= most_cases || !view.varies("steps_per_period"))
      say_each(compared, view, *standard, answers);
    else
      say_steps(compared, view, *standard, answers);
  }
  say_attractors(results, answers);
}

namespace {

using report::number_text;

std::string with_unit(double value, const report::Quantity& parameter) {
  return number_text(value, 5) + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

// An answer tells the widest intervals of each verdict, and how many others there are.
constexpr std::size_t most_told = 3;

std::vector<bool> told_in_full(const TableReader& verdicts) {
  std::vector<bool> told(verdicts.size(), false);
  for (const char* wanted : {"depends", "undecided", "robust"}) {
    std::vector<std::size_t> found;
    for (std::size_t row = 0; row < verdicts.size(); ++row)
      if (verdicts.text(row, "verdict") == wanted) found.push_back(row);
    const auto width = [&](std::size_t row) {
      return verdicts.number(row, "to").value_or(0) - verdicts.number(row, "from").value_or(0);
    };
    std::stable_sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) { return width(a) > width(b); });
    for (std::size_t k = 0; k < std::min(found.size(), most_told); ++k) told[found[k]] = true;
  }
  return told;
}

}  // namespace

Table bifurcation_answers(const StudyResults& results) {
  Table out = answers_head();
  const auto add = [&](const std::string& choice, const std::string& verdict, const Cell& share, const Cell& sentence) {
    out.rows.push_back(AnswerRow{.choice = choice, .verdict = verdict, .effect = share, .sentence = sentence}.row());
  };
  const report::Quantity parameter = report::swept_parameter(results);
  if (const Table* shares = find_table(results.derived, "verdict_shares"); shares && !shares->rows.empty()) {
    const TableReader rows(*shares);
    std::size_t all = 0;
    std::string parts;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::string verdict = rows.text(row, "verdict"), choice = rows.text(row, "choice");
      const auto intervals = static_cast<std::size_t>(rows.number(row, "intervals").value_or(0));
      const auto share = rows.number(row, "share");
      all += intervals;
      const bool depends = verdict == "depends" && !choice.empty();
      parts += fmt::format("{}{} in {}{}", parts.empty() ? "" : ", ",
                           depends ? "depends on " + spoken_choice(choice) : verdict, intervals,
                           share ? fmt::format(" ({} of the range)", report::share_text(*share)) : "");
    }
    const auto from = rows.number(0, "from"), to = rows.number(0, "to");
    const std::string range = from && to ? fmt::format(" of {} from {} to {}", parameter.name, number_text(*from, 5),
                                                       with_unit(*to, parameter))
                                         : "";
    // Of one verdict there are no parts to count.
    const std::string one = rows.text(0, "verdict");
    const bool whole = rows.size() == 1 && one != "depends" && from && to;
    const std::string lead = whole ? fmt::format("Over the whole range{} the motion is {}.", range, one)
                                   : fmt::format("The motion over {}{}: {}.",
                                                 report::count_text(all, "interval", "intervals"), range, parts);
    for (std::size_t row = 0; row < rows.size(); ++row)
      add(rows.text(row, "choice"), rows.text(row, "verdict"), Cell(rows.number(row, "share")),
          row == 0 ? Cell(lead) : Cell());
  }
  say_diagram(results, out);
  if (const Table* verdicts = find_table(results.derived, "verdicts")) {
    const TableReader rows(*verdicts);
    const std::vector<bool> told = told_in_full(rows);
    std::size_t untold = 0;
    for (const char* wanted : {"depends", "undecided", "robust"})
      for (std::size_t row = 0; row < rows.size(); ++row)
        if (rows.text(row, "verdict") == wanted) {
          untold += !told[row];
          add(rows.text(row, "choice"), wanted, {}, told[row] ? Cell(rows.text(row, "sentence")) : Cell());
        }
    if (untold > 0)
      add("", "", {},
          fmt::format("{} told in verdicts.csv alone, none wider than those of its verdict above.",
                      report::count_text(untold, "interval is", "intervals are")));
  }
  return out;
}

}  // namespace ricochet
