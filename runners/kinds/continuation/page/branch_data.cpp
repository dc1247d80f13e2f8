#include "runners/kinds/continuation/page/branch_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/kinds/continuation/continuation_tables.hpp"
#include "runners/kinds/continuation/points_beneath.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {
namespace {

constexpr size_t most_rows = 60'000;

/// Rows of a case that the page draws: those that it needs, and every `stride`-th.
std::vector<size_t> rows_to_draw(const std::vector<BranchRow>& rows, size_t stride) {
  std::vector<size_t> out;
  for (size_t k = 0; k < rows.size(); ++k) {
    const bool first = k == 0 || rows[k - 1].branch != rows[k].branch,
               last = k + 1 == rows.size() || rows[k + 1].branch != rows[k].branch;
    const bool changes =
        (!first && rows[k - 1].unstable != rows[k].unstable) || (!last && rows[k + 1].unstable != rows[k].unstable);
    if (first || last || changes || rows[k].point || rows[k].row % static_cast<long long>(stride) == 0)
      out.push_back(k);
  }
  return out;
}

void put_exact(CurveData& curves, const std::string& key, const std::vector<double>& values) {
  curves.put(key, "f64", {reinterpret_cast<const unsigned char*>(values.data()), values.size() * sizeof(double)});
}

/// Writes the blocks of a case; what the script reads beside them.
nlohmann::ordered_json put_case(const CaseRecord& record, const std::vector<BranchRow>& rows,
                                const std::vector<size_t>& kept, CurveData& curves) {
  nlohmann::ordered_json branches = nlohmann::ordered_json::array();
  std::vector<std::string> names;
  size_t multipliers = 0;
  for (const BranchRow& row : rows) {
    multipliers = std::max(multipliers, row.multipliers.size());
    if (std::find(names.begin(), names.end(), row.branch) != names.end()) continue;
    names.push_back(row.branch);
    branches.push_back({{"name", row.branch}, {"period", row.period}, {"symmetric", row.symmetric.value_or(false)}});
  }
  const auto column = [&](auto of) {
    std::vector<double> values;
    for (const size_t k : kept) {
      const std::optional<double> value = of(rows[k]);
      values.push_back(value.value_or(NAN));
    }
    return values;
  };
  const std::string key = record.id + "/branch/";
  curves.put_floats(key + "of", column([&](const BranchRow& row) {
                      return static_cast<double>(std::find(names.begin(), names.end(), row.branch) - names.begin());
                    }));
  put_exact(curves, key + "parameter", column([](const BranchRow& row) { return row.parameter; }));
  put_exact(curves, key + "tip", column([](const BranchRow& row) { return row.tip_displacement; }));
  curves.put_floats(key + "velocity", column([](const BranchRow& row) { return row.tip_velocity; }));
  put_exact(curves, key + "arc", column([](const BranchRow& row) { return row.arc; }));
  const auto whole = [](const auto& value) { return value ? std::optional<double>(*value) : std::nullopt; };
  curves.put_floats(key + "unstable", column([&](const BranchRow& row) { return whole(row.unstable); }));
  curves.put_floats(key + "point", column([&](const BranchRow& row) { return whole(row.point); }));
  curves.put_floats(key + "runs", column([&](const BranchRow& row) { return whole(row.contact_runs); }));
  curves.put_floats(key + "impacts", column([](const BranchRow& row) { return row.impacts_per_period; }));
  curves.put_floats(key + "residual", column([](const BranchRow& row) { return row.residual; }));
  for (size_t m = 0; m < multipliers; ++m) {
    const auto part = [m](double (*take)(const std::complex<double>&)) {
      return [m, take](const BranchRow& row) -> std::optional<double> {
        return m < row.multipliers.size() && row.multipliers[m] ? std::optional(take(*row.multipliers[m]))
                                                                : std::nullopt;
      };
    };
    curves.put_floats(fmt::format("{}re{}", key, m + 1),
                      column(part([](const std::complex<double>& value) { return value.real(); })));
    curves.put_floats(fmt::format("{}im{}", key, m + 1),
                      column(part([](const std::complex<double>& value) { return value.imag(); })));
  }
  return {{"branches", std::move(branches)}, {"multipliers", multipliers}};
}

}  // namespace

namespace {

/// Writes the points of a bifurcation study; what is said of them, "" where the study names none.
std::string put_beneath(const nlohmann::ordered_json& study, CurveData& curves) {
  const auto found = study.find("beneath");
  if (found == study.end()) return "";
  constexpr size_t most_points = 40'000;
  const std::string folder = found->get<std::string>();
  try {
    const PointsBeneath points = points_beneath(study, most_points);
    curves.put_floats("beneath/parameter", points.parameter);
    curves.put_floats("beneath/tip", points.tip);
    return fmt::format("Grey: {} of {} points of the section of {}.", points.tip.size(), points.stored, folder);
  } catch (const InputError& error) {
    return fmt::format("Points of {} are not drawn: {}.", folder, error.what());
  }
}

}  // namespace

nlohmann::ordered_json branch_data(const CaseView& view, CurveData& curves) {
  std::vector<std::pair<const CaseRecord*, std::vector<BranchRow>>> all;
  size_t stored = 0, drawn = 0;
  for (const CaseRecord* record : view.all()) {
    const Table* table = find_table(record->tables, branches_name);
    if (!table || table->rows.empty()) continue;
    all.emplace_back(record, branch_rows_in(*table));
    stored += all.back().second.size();
  }
  if (all.empty()) return nullptr;
  const Quantity parameter = swept_parameter(view.results());
  nlohmann::ordered_json out = {{"parameter", {parameter.name, parameter.unit}}};
  nlohmann::ordered_json cases = nlohmann::ordered_json::object();
  const size_t stride = (stored + most_rows - 1) / most_rows;
  for (const auto& [record, rows] : all) {
    const std::vector<size_t> kept = rows_to_draw(rows, stride);
    drawn += kept.size();
    cases[record->id] = put_case(*record, rows, kept, curves);
  }
  out["cases"] = std::move(cases);
  const std::string beneath = put_beneath(view.results().study, curves);
  out["said"] = drawn < stored ? fmt::format("{} of {} orbits are drawn; all are in branches.csv.", drawn, stored) : "";
  if (!beneath.empty()) out["beneath"] = beneath;
  return out;
}

}  // namespace ricochet::report
