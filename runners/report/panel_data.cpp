#include "runners/report/panel_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runners/table/table_reader.hpp"

namespace ricochet::report {
namespace {

using PanelJson = nlohmann::ordered_json;

constexpr size_t most_cases = 200, most_impacts = 20, most_points = 400, most_points_of_all = 40000;

/// In six digits: to be read, not to go on with.
PanelJson rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  constexpr int digits = 6;
  return std::stod(fmt::format("{:.{}g}", value, digits));
}

PanelJson head_json(const Column& column) {
  return {{"name", column.name}, {"unit", column.unit}, {"text", column.text}};
}

PanelJson ledger_json(const CaseView& view) {
  PanelJson out = PanelJson::object();
  const Table* ledger = find_table(view.results().derived, "energy_ledger");
  if (!ledger) return out;
  const size_t first = 1 + view.results().columns.size();
  for (size_t c = first; c < ledger->columns.size(); ++c) out["columns"].push_back(head_json(ledger->columns[c]));
  for (const Row& row : ledger->rows) {
    PanelJson cells = PanelJson::array();
    for (size_t c = first; c < row.size(); ++c)
      cells.push_back(row[c].number()  ? rounded(*row[c].number())
                      : row[c].words() ? PanelJson(*row[c].words())
                                       : PanelJson());
    out["cases"][row.front().text()] = std::move(cells);
  }
  return out;
}

PanelJson impacts_json(const CaseView& view) {
  PanelJson out = PanelJson::object();
  for (const CaseRecord* record : view.all()) {
    const NumberTable* impacts = find_table(record->numbers, "impacts");
    // Those of an orbit are another table: its own panel has them.
    if (!impacts || !impacts->numbers("t") || impacts->rows() == 0) continue;
    if (!out.contains("columns"))
      for (const Column& column : impacts->columns) out["columns"].push_back(head_json(column));
    PanelJson& rows = out["cases"][record->id] = PanelJson::array();
    for (size_t r = 0; r < std::min(impacts->rows(), most_impacts); ++r) {
      PanelJson row = PanelJson::array();
      for (size_t c = 0; c < impacts->columns.size(); ++c) {
        const double value = impacts->values[c][r];
        if (const auto* words = impacts->words_of(impacts->columns[c].name); words && std::isfinite(value))
          row.push_back(words->at(static_cast<size_t>(value)));
        else
          row.push_back(rounded(value));
      }
      rows.push_back(std::move(row));
    }
  }
  return out;
}

PanelJson portraits_json(const CaseView& view, CurveData& blocks) {
  PanelJson out = PanelJson::array();
  const size_t limit = std::min(most_points, most_points_of_all / std::max<size_t>(1, view.all().size()));
  for (const CaseRecord* record : view.all()) {
    const auto u = curve_column(record->curve, "tip_displacement"), v = curve_column(record->curve, "tip_velocity");
    if (!u || !v || u->empty() || u->size() != v->size()) continue;
    std::vector<double> some_u, some_v;
    const size_t stride = (u->size() + limit - 1) / limit;
    for (size_t i = 0; i < u->size(); i += stride) {
      some_u.push_back((*u)[i]);
      some_v.push_back((*v)[i]);
    }
    const std::string key = record->id + "/portrait/";
    blocks.put_floats(key + "tip_displacement", some_u);
    blocks.put_floats(key + "tip_velocity", some_v);
    out.push_back(record->id);
  }
  return out;
}

}  // namespace

PanelJson panel_data(const CaseView& view, CurveData& blocks) {
  PanelJson out = {{"ledger", ledger_json(view)}, {"most_impacts", most_impacts}};
  if (view.all().size() > most_cases) return out;
  out["impacts"] = impacts_json(view);
  out["portraits"] = portraits_json(view, blocks);
  return out;
}

}  // namespace ricochet::report
