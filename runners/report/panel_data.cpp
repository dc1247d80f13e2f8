#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "runners/report/page_data.hpp"
#include "runners/store/snapshots.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet::report {
namespace {

using PanelJson = nlohmann::ordered_json;

constexpr size_t most_cases = 200, most_impacts = 20, most_points = 400, most_points_of_all = 40000;

/// In six digits: to be read, not to go on with.
PanelJson rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  constexpr int digits = 6;
  return to_digits(value, digits);
}

PanelJson head_json(const Column& column) {
  return {{"name", column.name}, {"unit", column.unit}, {"text", column.text}};
}

PanelJson ledger_json(const Choices& choices) {
  PanelJson out = PanelJson::object();
  const Table* ledger = find_table(choices.results().derived, "energy_ledger");
  if (!ledger) return out;
  const size_t first = 1 + choices.results().columns.size();
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

PanelJson impacts_json(const Choices& choices) {
  PanelJson out = PanelJson::object();
  for (const CaseRecord* record : all_cases(choices.results())) {
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

PanelJson portraits_json(const Choices& choices, CurveData& blocks) {
  PanelJson out = PanelJson::array();
  const size_t limit =
      std::min(most_points, most_points_of_all / std::max<size_t>(1, all_cases(choices.results()).size()));
  for (const CaseRecord* record : all_cases(choices.results())) {
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

PanelJson panel_data(const Choices& choices, CurveData& blocks) {
  PanelJson out = {{"ledger", ledger_json(choices)}, {"most_impacts", most_impacts}};
  if (all_cases(choices.results()).size() > most_cases) return out;
  out["impacts"] = impacts_json(choices);
  out["portraits"] = portraits_json(choices, blocks);
  return out;
}

namespace {

using PageJson = nlohmann::ordered_json;

constexpr size_t most_bytes = 1'500'000;  // of all cases together, before base64

template <class Whole>
void put_whole(CurveData& blocks, const std::string& key, const std::string& type, const std::vector<Whole>& values) {
  std::vector<unsigned char> bytes;
  for (const Whole value : values)
    for (size_t k = 0; k < sizeof(Whole); ++k)
      bytes.push_back(static_cast<unsigned char>(static_cast<std::uint32_t>(value) >> (8 * k)));
  blocks.put(key, type, bytes);
}

/// Every `stride`th instant.
Snapshots thinned(const Snapshots& all, size_t stride) {
  if (stride == 1) return all;
  Snapshots out = all;
  out.t.clear();
  out.clamp.clear();
  out.displacement.clear();
  const size_t places = all.values(), points = all.point.size();
  for (size_t i = 0; i < all.t.size(); i += stride) {
    out.t.push_back(all.t[i]);
    out.clamp.push_back(all.clamp[i]);
    const auto begin = all.displacement.begin() + static_cast<std::ptrdiff_t>(i * places);
    out.displacement.insert(out.displacement.end(), begin, begin + static_cast<std::ptrdiff_t>(places));
  }
  // A force of instant i is of the time since i − 1: it goes to the first instant kept that is not before it.
  std::map<std::uint32_t, double> sums;
  for (size_t k = 0; k < all.pushed.size(); ++k) {
    const size_t kept = (all.pushed[k] / points + stride - 1) / stride;
    if (kept < out.t.size()) sums[static_cast<std::uint32_t>(kept * points + all.pushed[k] % points)] += all.force[k];
  }
  out.pushed.clear();
  out.force.clear();
  for (const auto& [at, sum] : sums) {
    out.pushed.push_back(at);
    out.force.push_back(static_cast<std::int16_t>(std::lround(sum / static_cast<double>(stride))));
  }
  return out;
}

/// Stops as JSON knows them: null where there is none.
PageJson stops_json(const std::vector<double>& places) {
  PageJson out = PageJson::array();
  for (const double place : places) out.push_back(std::isfinite(place) ? PageJson(place) : PageJson());
  return out;
}

// Stops, and nodes on a plane or points.
void add_drawing(const Snapshots& shots, PageJson& out) {
  if (!shots.names.empty()) out["names"] = shots.names;
  out["stops"] = PageJson::array();
  for (const Snapshots::Stop& stop : shots.stops)
    out["stops"].push_back({{"at", stop.at}, {"to", stop.to}, {"direction", stop.direction}, {"name", stop.name}});
  if (shots.y.empty()) return;
  for (const auto& [name, first] : shots.bodies) out["bodies"].push_back({{"name", name}, {"first", first}});
  static const char* const axes[] = {"x", "y", "z"};
  out["axes"] = {axes[shots.axes[0]], axes[shots.axes[1]]};
  out["y"] = shots.y;
  out["held"] = shots.held;
  out["links"] = shots.links;
}

PageJson one_case(const std::string& id, const Snapshots& shots, CurveData& blocks) {
  const std::string key = id + "/" + snapshots_name + "/";
  blocks.put_floats(key + "t", shots.t);
  blocks.put_floats(key + "clamp", shots.clamp);
  put_whole(blocks, key + "u", "i16", shots.displacement);
  put_whole(blocks, key + "pushed", "u32", shots.pushed);
  put_whole(blocks, key + "force", "i16", shots.force);
  PageJson out = {{"along", shots.along},
                  {"x", shots.x},
                  {"point", shots.point},
                  {"lower", stops_json(shots.lower)},
                  {"upper", stops_json(shots.upper)},
                  {"metres", shots.metres},
                  {"newtons", shots.newtons}};
  add_drawing(shots, out);
  if (!shots.of.empty()) out["of"] = shots.of;
  return out;
}

}  // namespace

PageJson snapshot_data(const Choices& choices, CurveData& blocks) {
  std::vector<std::pair<std::string, Snapshots>> found;
  size_t bytes = 0;
  for (const CaseRecord* record : all_cases(choices.results()))
    if (const NumberTable* table = find_table(record->numbers, snapshots_name))
      if (auto shots = snapshots_of(*table); shots && !shots->t.empty()) {
        bytes += 2 * shots->displacement.size() + 6 * shots->force.size() + 8 * shots->t.size();
        found.emplace_back(record->id, std::move(*shots));
      }
  if (found.empty()) return nullptr;
  const size_t stride = (bytes + most_bytes - 1) / most_bytes;
  PageJson out = {{"stride", stride}, {"cases", PageJson::object()}};
  for (const auto& [id, shots] : found) out["cases"][id] = one_case(id, thinned(shots, stride), blocks);
  const PageJson::json_pointer supports("/scene/structure/supports");
  if (choices.results().study.contains(supports)) {
    out["supports"] = PageJson::array();
    for (const auto& one : choices.results().study.at(supports)) {
      const auto& x = one.at("x");
      out["supports"].push_back({{"x", x.is_array() ? x.front() : x}, {"type", one.at("type")}});
    }
  }
  return out;
}

}  // namespace ricochet::report
