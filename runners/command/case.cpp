#include <fmt/format.h>

#include <iostream>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/stored_study.hpp"
#include "runners/run/merge_folders.hpp"
#include "runners/run/study_cases.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/store/number_rows.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/snapshots.hpp"
#include "runners/store/store.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

constexpr std::size_t rows_told = 20;

/// One case of stored results, and all that marches it.
struct OpenCase {
  OpenCase(const Arguments& arguments)
      : folder(arguments.operands[0]),
        results(read_store(folder)),
        kind(find_kind(results.kind)),
        record(find_case(results, arguments.operands[1])) {}
  const std::filesystem::path folder;
  const StudyResults results;
  const Kind* const kind;
  const CaseRecord& record;
};

std::string parameters_text(const CaseRecord& record) {
  TextTable table({"parameter", "value"});
  for (const auto& [name, value] : record.axes) table.add({name, cell_of(value).text()});
  return table.text(2);
}

std::string measures_text(const CaseRecord& record) {
  TextTable table({"measure", "value", "unit"});
  for (const auto& [name, value] : record.measures) {
    const MeasureInfo* info = measure_info(name);
    table.add({name, csv_number(value), info && std::string_view(info->unit) != "1" ? info->unit : ""});
  }
  return table.text(2);
}

std::string rows_text(const Table& rows) {
  std::vector<std::string> header;
  for (const Column& column : rows.columns) header.push_back(column.name);
  TextTable table(std::move(header));
  for (std::size_t r = 0; r < rows.rows.size() && r < rows_told; ++r) {
    std::vector<std::string> cells;
    for (const Cell& cell : rows.rows[r]) cells.push_back(cell.text());
    table.add(std::move(cells));
  }
  std::string out = table.text(2);
  if (rows.rows.size() > rows_told)
    out += fmt::format("  and {} more in {}.csv\n", rows.rows.size() - rows_told, rows.name);
  return out;
}

std::string own_tables_text(const CaseRecord& record) {
  std::string out;
  for (const Table& table : record.tables)
    if (!table.rows.empty()) out += fmt::format("\n{}:\n{}", table.name, rows_text(table));
  return out;
}

/// The row of this case in `energy_ledger`, one column a line; "" where the kind has no such table.
std::string ledger_text(const Kind& kind, const Study& study, const CaseRecord& again) {
  StudyResults alone = results_header(study);
  alone.cases = {again};
  kind.analysis(alone, Choices(alone));
  const Table* ledger = find_table(alone.derived, "energy_ledger");
  if (!ledger || ledger->rows.empty()) return "";
  TextTable table({"", "J"});
  for (std::size_t c = 1 + alone.columns.size(); c < ledger->columns.size(); ++c)
    table.add({ledger->columns[c].name, ledger->rows.front()[c].text()});
  return "\nenergy ledger:\n" + table.text(2);
}

int print_again(const OpenCase& open, const StoredStudy& stored, const StudyCase& study_case, std::ostream& out,
                const std::atomic<bool>& stop) {
  const CaseRecord again = march_again(open.folder, *open.kind, stored, study_case, stop);
  out << fmt::format("case {} of {} ({})\n", open.record.id, open.results.name, open.results.kind)
      << parameters_text(open.record) << "\n"
      << word(again.status) << (again.reasons.empty() ? "" : ": " + again.reason())
      << (again.steps > 0 ? fmt::format(", {} steps", again.steps) : "");
  if (const std::string outcome = again.status == Status::done ? open.kind->outcome(again) : ""; !outcome.empty())
    out << ": " << outcome;
  out << "\n";
  if (!again.measures.empty()) out << "\n" << measures_text(again);
  out << ledger_text(*open.kind, stored.study, again) << own_tables_text(again) << "\n";
  out << (open.record.partial ? std::string("nothing to compare with: the run had not finished this case\n")
                              : text(compare(open.record, again)));
  return exit_done;
}

/// The curve of a case that is marched once.
int print_curve(const OpenCase& open, const StoredStudy& stored, StudyCase study_case, int samples, std::ostream& out,
                const std::atomic<bool>& stop) {
  if (!open.kind->marches_once())
    throw PointRefused(
        fmt::format("a case of kind {} is more than one integration: it has no curve", open.results.kind));
  study_case.samples = samples;
  const CaseRecord again = open.kind->march(study_case, stored.registry, stop);
  if (again.curve.columns.empty() || again.curve.columns.front().empty())
    throw PointRefused(fmt::format("this case leaves no curve: it is {}{}", word(again.status),
                                   again.reasons.empty() ? "" : ", " + again.reason()));
  out << curve_csv(again.curve);
  std::cerr << word(again.status) << (again.reasons.empty() ? "" : ": " + again.reason())
            << (samples > again.steps ? fmt::format("; it takes {} steps, and has no more samples", again.steps) : "")
            << "\n";
  return exit_done;
}

/// Snapshots of a case that is marched once, kept in the store.
int keep_snapshots(const OpenCase& open, const StoredStudy& stored, StudyCase study_case, int instants,
                   std::ostream& out, const std::atomic<bool>& stop) {
  if (!open.kind->marches_once())
    throw PointRefused(
        fmt::format("a case of kind {} is more than one integration: it has no film", open.results.kind));
  if (study_case.settings.is_null()) study_case.settings = Json::object();
  study_case.settings["snapshots"] = instants;
  const CaseRecord again = open.kind->march(study_case, stored.registry, stop);
  const NumberTable* table = find_table(again.numbers, snapshots_name);
  if (!table)
    throw PointRefused(fmt::format("this case leaves no snapshots: it is {}{}", word(again.status),
                                   again.reasons.empty() ? "" : ", " + again.reason()));
  keep_numbers(open.folder, open.record.id, *table);
  const Snapshots kept = snapshots_of(*table).value();
  out << fmt::format("kept beside the case {}: {} instants at {} places, {} forces; `ricochet report {}` shows them\n",
                     open.record.id, kept.t.size(), kept.x.size(), kept.force.size(), open.folder.string());
  return exit_done;
}

int print_study(const OpenCase& open, std::ostream& out) {
  constexpr int indent = 2;
  out << single_study(open.results, open.record)
             .dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
      << "\n";
  return exit_done;
}

int show_case(const Arguments& arguments, std::ostream& out) {
  if ((arguments.samples > 0) + (arguments.snapshots > 0) + (arguments.study ? 1 : 0) > 1)
    throw UsageError(
        "case prints a curve, keeps snapshots or prints a study: expected one of --samples, --snapshots and --study");
  const OpenCase open(arguments);
  if (!open.kind)
    throw PointRefused(fmt::format("{} holds a study of kind {}, which this program does not have",
                                   arguments.operands[0], open.results.kind));
  if (arguments.study) return print_study(open, out);
  if (open.kind->only_points())
    throw PointRefused(
        fmt::format("a case of kind {} is many orbits: `ricochet point {} {}` marches one of them again; "
                    "with --study this prints the study of the case alone",
                    open.results.kind, arguments.operands[0], open.record.id));
  const StoredStudy stored(open.results, arguments.plugins);
  const StudyCase& study_case = stored.find(open.record.id);
  if (study_case.excluded) throw PointRefused(fmt::format("the study excludes this case: {}", *study_case.excluded));
  const StopSignal signals;
  try {
    if (arguments.samples > 0)
      return print_curve(open, stored, study_case, arguments.samples, out, signals.requested());
    if (arguments.snapshots > 0)
      return keep_snapshots(open, stored, study_case, arguments.snapshots, out, signals.requested());
    return print_again(open, stored, study_case, out, signals.requested());
  } catch (const Interrupted&) {
    return exit_interrupted;
  }
}

}  // namespace

int command_case(const Arguments& arguments, std::ostream& out) {
  return march_apart(arguments, out, [&](std::ostream& to) {
    try {
      return show_case(arguments, to);
    } catch (const PointRefused& refused) {
      throw UsageError(refused.what());
    }
  });
}

}  // namespace ricochet
