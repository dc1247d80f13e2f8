#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/kinds/trajectory/energy_tables.hpp"
#include "runners/run/compare_studies.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

// The error that orders and costs are told by.
constexpr const char* told_error = "tip-l2";
constexpr double told_seconds = 1e-3;
// An order whose 95 % interval is wider is none that could be told.
constexpr double widest_interval = 0.5;

/// A scheme and its parameters, by column.
using Scheme = std::vector<std::pair<std::string, std::string>>;

Scheme scheme_of(const CaseRecord& record) {
  Scheme out;
  for (const auto& [column, value] : record.axes)
    if (axis_role(column) == "time" && !value.is_null()) out.emplace_back(column, cell_of(value).text());
  std::sort(out.begin(), out.end());
  return out;
}

/// Takes a value of a case; nothing: it was looked for, and could not be told.
using Add = std::function<void(const CaseRecord&, std::optional<double>)>;
/// Calls with every row of a derived table and its case, where the study has both.
template <class Record, class See>
void see_rows(const StudyResults& study, const TableType<Record>& type, See see) {
  std::map<std::string, const CaseRecord*> cases;
  for (const CaseRecord& record : study.cases) cases[record.id] = &record;
  for (const Record& row : type.read(study.derived))
    if (const auto found = cases.find(row.id); found != cases.end()) see(*found->second, row);
}

bool touches(const CaseRecord& record) {
  return measure(record, "impacts").value_or(0) > 0;
}

void add_orders(const StudyResults& study, bool contact, const Add& add) {
  see_rows(study, orders_type(), [&](const CaseRecord& record, const OrderRow& row) {
    if (row.refined != "step" || row.error != told_error || touches(record) != contact) return;
    const bool told = row.order && row.low && row.high && *row.high - *row.low <= widest_interval;
    add(record, told ? row.order : std::nullopt);
  });
}

// A column of a table where the case has it.
template <class Record>
void add_column(const StudyResults& study, const TableType<Record>& type, std::optional<double> Record::*column,
                bool contact, const Add& add) {
  see_rows(study, type, [&](const CaseRecord& record, const Record& row) {
    if (row.*column && (!contact || touches(record))) add(record, row.*column);
  });
}

void see_points(const StudyResults& study, const std::function<void(const CaseRecord&, double error, double s)>& see) {
  see_rows(study, work_precision_type(), [&](const CaseRecord& record, const WorkRow& row) {
    if (row.error == told_error && row.value && row.run_seconds) see(record, *row.value, *row.run_seconds);
  });
}

void add_costs(const StudyResults& study, const Add& add) {
  see_points(study, [&](const CaseRecord& record, double, double seconds) {
    if (record.steps > 0) add(record, 1e6 * seconds / static_cast<double>(record.steps));
  });
}

// The best that a method reaches within the time, over its steps.
void add_reached(const StudyResults& study, const Add& add) {
  std::vector<std::string> method = study.columns;
  std::erase(method, "step");
  std::map<std::string, std::pair<const CaseRecord*, double>> best;
  see_points(study, [&](const CaseRecord& record, double error, double seconds) {
    if (seconds > told_seconds) return;
    const auto [at, fresh] = best.try_emplace(key_of(axes_of(record, method)), &record, error);
    if (!fresh) at->second.second = std::min(at->second.second, error);
  });
  for (const auto& [key, reached] : best) add(*reached.first, reached.second);
}

struct Figure {
  Column column;
  std::function<void(const StudyResults&, const Add&)> find;
  int decimals = 0;      ///< 0: two significant digits
  bool largest = false;  ///< the largest value alone
};

const std::vector<Figure>& figures() {
  const auto orders = [](bool impacts) {
    return [impacts](const StudyResults& results, const Add& add) { add_orders(results, impacts, add); };
  };
  const auto restitution = [](std::optional<double> RestitutionRow::*column) {
    return [=](const StudyResults& results, const Add& add) {
      add_column(results, restitution_type(), column, false, add);
    };
  };
  const auto step_gains = [](const StudyResults& results, const Add& add) {
    add_column(results, energy_ends_type(), &EnergyEnd::step_gain, true, add);
  };
  static const std::vector<Figure> all = {
      {{"order free", "1", "Order in the step without contact."}, orders(false), 2},
      {{"order through contact", "1", "Order in the step where a stop is touched."}, orders(true), 2},
      {{"largest step gain", "1", "Largest gain of energy in one step at contact, over the starting energy."},
       step_gains,
       0,
       true},
      {{"e least", "1", "Least restitution of a free mass over the phases of a step."},
       restitution(&RestitutionRow::least)},
      {{"e mean", "1", "Mean of the same."}, restitution(&RestitutionRow::mean)},
      {{"e most", "1", "Largest of the same."}, restitution(&RestitutionRow::most)},
      {{"ρ∞", "1", "What a step leaves of the highest frequencies."}, restitution(&RestitutionRow::rho_inf)},
      {{"cost of a step", "µs", "Processor time of one step."}, add_costs},
      {{"error at 1 ms", "m", "Smallest error of the tip, root mean square over time, within 1 ms of processor time."},
       add_reached},
  };
  return all;
}

std::string said(const Figure& figure, double value) {
  return figure.decimals > 0 ? fmt::format("{:.{}f}", value, figure.decimals) : fmt::format("{:.2g}", value);
}

/// The values that a study told of a scheme, and how many it looked for.
struct Told {
  std::vector<double> values;
  std::size_t sought = 0;
};

/// "1.98 … 2.03 [free]"; with "(2 of 6)" where not all could be told.
std::string said(const Figure& figure, const Told& told, const std::string& study) {
  if (told.values.empty()) return fmt::format("not told [{}]", study);
  const auto [least, most] = std::minmax_element(told.values.begin(), told.values.end());
  const std::string low = said(figure, figure.largest ? *most : *least), high = said(figure, *most);
  std::string out = low == high ? low : low + " … " + high;
  if (told.values.size() < told.sought) out += fmt::format(" ({} of {})", told.values.size(), told.sought);
  return out + " [" + study + "]";
}

/// The name, and the parameters in which the schemes of this name differ.
std::string label(const Scheme& scheme, const std::vector<std::pair<Scheme, Row>>& all) {
  const auto value_of = [](const Scheme& one, const std::string& column) {
    const auto found = std::find_if(one.begin(), one.end(), [&](const auto& field) { return field.first == column; });
    return found == one.end() ? std::string() : found->second;
  };
  const std::string name = value_of(scheme, "time");
  std::string out = name;
  for (const auto& [column, value] : scheme) {
    const bool differs = std::any_of(all.begin(), all.end(), [&, in = column, own = value](const auto& other) {
      return value_of(other.first, "time") == name && value_of(other.first, in) != own;
    });
    if (differs && column != "time") out += fmt::format(", {} {}", column.substr(column.find('.') + 1), value);
  }
  return out;
}

}  // namespace

std::string common_beginning(const std::vector<StudyResults>& studies) {
  if (studies.size() < 2) return "";
  std::string common = studies.front().name;
  for (const StudyResults& study : studies)
    common.erase(std::mismatch(common.begin(), common.end(), study.name.begin(), study.name.end()).first, common.end());
  const std::size_t hyphen = common.rfind('-');
  return hyphen == std::string::npos ? "" : common.substr(0, hyphen + 1);
}

Table league_table(const std::vector<StudyResults>& studies) {
  Table out{"league", "One time scheme: what studies measured of it.", {{"scheme", "", "Name and parameters."}}, {}};
  std::vector<std::pair<Scheme, Row>> rows;
  const Row blank(figures().size());
  for (const StudyResults& study : studies)
    for (const CaseRecord& record : study.cases)
      if (Row& row = in_order_met(rows, scheme_of(record)); row.empty()) row = blank;
  const std::size_t beginning = common_beginning(studies).size();
  for (std::size_t f = 0; f < figures().size(); ++f) {
    const Figure& figure = figures()[f];
    out.columns.push_back(figure.column);
    for (const StudyResults& study : studies) {
      std::map<Scheme, Told> found;
      figure.find(study, [&](const CaseRecord& record, std::optional<double> value) {
        Told& told = found[scheme_of(record)];
        ++told.sought;
        if (value) told.values.push_back(*value);
      });
      for (auto& [scheme, row] : rows)
        if (const auto told = found.find(scheme); told != found.end() && row[f].is_nothing())
          row[f] = said(figure, told->second, study.name.substr(beginning));
    }
  }
  for (const auto& [scheme, cells] : rows) {
    if (std::all_of(cells.begin(), cells.end(), [](const Cell& cell) { return cell.is_nothing(); })) continue;
    out.rows.push_back({label(scheme, rows)});
    out.rows.back().insert(out.rows.back().end(), cells.begin(), cells.end());
  }
  return out;
}

std::string markdown(const Table& table) {
  std::string head = "|", rule = "|", body;
  for (const Column& column : table.columns) {
    head += fmt::format(" {}{} |", column.name, column.unit.empty() || column.unit == "1" ? "" : ", " + column.unit);
    rule += "---|";
  }
  for (const Row& row : table.rows) {
    body += "|";
    for (const Cell& cell : row) body += fmt::format(" {} |", cell.text());
    body += "\n";
  }
  return head + "\n" + rule + "\n" + body;
}

}  // namespace ricochet
