#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/kinds/continuation/branch_orbits.hpp"
#include "runners/kinds/continuation/continuation_study.hpp"
#include "runners/kinds/continuation/continuation_tables.hpp"
#include "runners/kinds/continuation/page/page.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/quantity.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet::report {
namespace {

constexpr size_t most_rows = 60'000, most_samples = 400'000;

using RowName = std::pair<std::string, long long>;  // branch and row

/// Portraits of a case, with where their samples begin.
struct Portraits {
  struct One {
    size_t first = 0, samples = 0;
    double lower = NAN, upper = NAN;
  };
  std::map<RowName, One> orbits;
  BranchSampleColumns samples;

  explicit Portraits(const CaseRecord& record) {
    const auto type = branch_portraits_type();
    const NumberTable *table = type.find(record.numbers), *held = branch_samples_type().find(record.numbers);
    if (!table || !held) return;
    samples = branch_samples_type().read(*held);
    const BranchPortraitColumns of = type.read(*table);
    const auto* names = table->words_of("branch");
    if (!names || !of.branch || !of.row || !of.samples || !samples.displacement || !samples.velocity) return;
    size_t first = 0;
    for (size_t k = 0; k < table->rows(); ++k) {
      const auto count = static_cast<size_t>((*of.samples)[k]);
      if (first + count > held->rows()) return;
      orbits[{names->at(static_cast<size_t>((*of.branch)[k])), std::llround((*of.row)[k])}] = {
          first, count, of.lower ? (*of.lower)[k] : NAN, of.upper ? (*of.upper)[k] : NAN};
      first += count;
    }
  }
};

/// Rows of a case that the page draws: those that it needs, and every `stride`-th.
std::vector<size_t> rows_to_draw(const std::vector<BranchRow>& rows, const Portraits& portraits, size_t stride) {
  std::vector<size_t> out;
  for (size_t k = 0; k < rows.size(); ++k) {
    const bool first = k == 0 || rows[k - 1].branch != rows[k].branch,
               last = k + 1 == rows.size() || rows[k + 1].branch != rows[k].branch;
    const bool changes =
        (!first && rows[k - 1].unstable != rows[k].unstable) || (!last && rows[k + 1].unstable != rows[k].unstable);
    if (first || last || changes || rows[k].point || rows[k].row % static_cast<long long>(stride) == 0 ||
        portraits.orbits.count({rows[k].branch, rows[k].row}) > 0)
      out.push_back(k);
  }
  return out;
}

void put_exact(CurveData& curves, const std::string& key, const std::vector<double>& values) {
  curves.put(key, "f64", {reinterpret_cast<const unsigned char*>(values.data()), values.size() * sizeof(double)});
}

struct Written {
  size_t portraits = 0, samples = 0;
};

/// Writes every `stride`-th portrait, and those of special points, under the places of their rows among the drawn ones.
Written put_portraits(const CaseRecord& record, const Portraits& portraits, const std::vector<BranchRow>& rows,
                      const std::vector<size_t>& kept, size_t stride, CurveData& curves) {
  std::map<RowName, double> place;
  std::vector<double> at, first, lower, upper, u, v;
  for (size_t i = 0; i < kept.size(); ++i) {
    const RowName name{rows[kept[i]].branch, rows[kept[i]].row};
    const auto found = portraits.orbits.find(name);
    if (found == portraits.orbits.end() || (place.size() % stride != 0 && !rows[kept[i]].point)) continue;
    const Portraits::One& one = found->second;
    place[name] = static_cast<double>(i);
    at.push_back(static_cast<double>(i));
    first.push_back(static_cast<double>(u.size()));
    lower.push_back(one.lower);
    upper.push_back(one.upper);
    for (size_t k = one.first; k < one.first + one.samples; ++k) {
      u.push_back((*portraits.samples.displacement)[k]);
      v.push_back((*portraits.samples.velocity)[k]);
    }
  }
  if (at.empty()) return {};
  const std::string key = record.id + "/orbit/";
  for (const auto& [name, values] :
       {std::pair("row", &at), {"first", &first}, {"lower", &lower}, {"upper", &upper}, {"u", &u}, {"v", &v}})
    curves.put_floats(key + name, *values);
  const auto type = branch_runs_type();
  const NumberTable* table = type.find(record.numbers);
  const auto* names = table ? table->words_of("branch") : nullptr;
  if (!names) return {at.size(), u.size()};
  const BranchRunColumns of = type.read(*table);
  const std::pair<const char*, const Series*> columns[] = {
      {"x", of.x}, {"upper", of.upper}, {"bound", of.bound}, {"begin", of.begin}, {"length", of.length}};
  std::vector<double> owner;
  std::vector<size_t> shown;
  for (size_t k = 0; k < table->rows(); ++k) {
    const auto found = place.find({names->at(static_cast<size_t>((*of.branch)[k])), std::llround((*of.row)[k])});
    if (found == place.end()) continue;
    owner.push_back(found->second);
    shown.push_back(k);
  }
  curves.put_floats(key + "run/row", owner);
  for (const auto& [name, series] : columns) {
    std::vector<double> values;
    for (const size_t k : shown) values.push_back(series ? (*series)[k] : NAN);
    curves.put_floats(key + "run/" + name, values);
  }
  return {at.size(), u.size()};
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
  const bool smooth = std::any_of(rows.begin(), rows.end(),
                                  [](const BranchRow& row) { return row.half_step_real || row.half_step_pair; });
  if (smooth) {
    using Pair = std::optional<std::complex<double>>;
    const auto part = [](const Pair& pair, double (*take)(const std::complex<double>&)) {
      return pair ? std::optional(take(*pair)) : std::nullopt;
    };
    curves.put_floats(key + "half", column([](const BranchRow& row) { return row.half_step_real; }));
    curves.put_floats(key + "half_re", column([&](const BranchRow& row) {
                        return part(row.half_step_pair, [](const auto& value) { return value.real(); });
                      }));
    curves.put_floats(key + "half_im", column([&](const BranchRow& row) {
                        return part(row.half_step_pair, [](const auto& value) { return value.imag(); });
                      }));
  }
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

nlohmann::ordered_json branch_data(const Choices& choices, CurveData& curves) {
  std::vector<std::pair<const CaseRecord*, std::vector<BranchRow>>> all;
  std::vector<Portraits> portraits;
  Written written;
  size_t stored = 0, drawn = 0, samples = 0;
  for (const CaseRecord* record : all_cases(choices.results())) {
    const Table* table = find_table(record->tables, branches_name);
    if (!table || table->rows.empty()) continue;
    all.emplace_back(record, branch_rows_in(*table));
    stored += all.back().second.size();
    portraits.emplace_back(*record);
    for (const auto& [name, one] : portraits.back().orbits) samples += one.samples;
  }
  if (all.empty()) return nullptr;
  const Quantity parameter = swept_parameter(choices.results());
  nlohmann::ordered_json out = {{"parameter", {parameter.name, parameter.unit}}};
  nlohmann::ordered_json cases = nlohmann::ordered_json::object();
  const size_t stride = (stored + most_rows - 1) / most_rows;
  const size_t of_portraits = std::max<size_t>(1, (samples + most_samples - 1) / most_samples);
  for (size_t c = 0; c < all.size(); ++c) {
    const auto& [record, rows] = all[c];
    const std::vector<size_t> kept = rows_to_draw(rows, portraits[c], stride);
    drawn += kept.size();
    cases[record->id] = put_case(*record, rows, kept, curves);
    const Written one = put_portraits(*record, portraits[c], rows, kept, of_portraits, curves);
    written = {written.portraits + one.portraits, written.samples + one.samples};
  }
  out["cases"] = std::move(cases);
  const std::string beneath = put_beneath(choices.results().study, curves);
  out["said"] = drawn < stored ? fmt::format("{} of {} orbits are drawn; all are in branches.csv.", drawn, stored) : "";
  // Two numbers of four bytes for each sample, four thirds of that as text.
  if (written.portraits > 0)
    out["portraits"] = fmt::format("The page carries the portraits of {} of {} orbits, {}.", written.portraits, stored,
                                   size_text(static_cast<double>(written.samples) * 8 * 4 / 3));
  if (!beneath.empty()) out["beneath"] = beneath;
  return out;
}

}  // namespace ricochet::report
