#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "runners/kinds/bifurcation/page/page.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/quantity.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::report {
namespace {

using Rows = std::vector<std::uint32_t>;

constexpr double cells_across = 4000;

/// Rows of a table of numbers by the orbit that they belong to; rows of no orbit are left out.
template <class Columns>
std::vector<Rows> rows_by_orbit(const NumberTable& table, const Columns& columns, const std::vector<OrbitRow>& orbits) {
  std::vector<Rows> out(orbits.size());
  const auto* words = table.words_of(start_name);
  if (!columns.parameter || !columns.start || !words) return out;
  const std::vector<double>&parameter = columns.parameter->get(), &start = columns.start->get();
  std::map<std::pair<double, std::string>, size_t> place;
  for (size_t o = 0; o < orbits.size(); ++o) place.emplace(std::pair(orbits[o].parameter, orbits[o].start), o);
  // Rows of one orbit follow one another: the map is asked once for each run of them.
  double last_parameter = std::numeric_limits<double>::quiet_NaN(), last_start = last_parameter;
  Rows* last = nullptr;
  for (size_t i = 0; i < table.rows(); ++i) {
    const double p = parameter[i], s = start[i];
    if (p != last_parameter || s != last_start) {
      last = nullptr;
      if (s >= 0 && s < static_cast<double>(words->size())) {
        const auto found = place.find(std::pair(p, (*words)[static_cast<size_t>(s)]));
        if (found != place.end()) last = &out[found->second];
      }
      last_parameter = p;
      last_start = s;
    }
    if (last) last->push_back(static_cast<std::uint32_t>(i));
  }
  return out;
}

/// What finite values reach; nothing where there are none.
struct Extent {
  double low = INFINITY, high = -INFINITY;
};
Extent extent(const std::vector<double>& values) {
  Extent out;
  for (const double value : values)
    if (std::isfinite(value)) out = {std::min(out.low, value), std::max(out.high, value)};
  return out;
}

/// An even choice of `count` of the rows, the last one among them.
Rows spread(const Rows& rows, size_t count) {
  if (count >= rows.size()) return rows;
  Rows out;
  for (size_t i = 0; i < count; ++i) out.push_back(rows[(i + 1) * rows.size() / count - 1]);
  return out;
}

/// Shares of a total among those who need `wants`: nobody gets more than it needs, what is left goes to the others.
std::vector<size_t> share_out(const std::vector<size_t>& wants, size_t total) {
  std::vector<size_t> order(wants.size()), out(wants.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return wants[a] < wants[b]; });
  for (size_t k = 0; k < order.size(); ++k) {
    const size_t share = total / (order.size() - k);
    out[order[k]] = std::min(wants[order[k]], share);
    total -= out[order[k]];
  }
  return out;
}

/// The sections of one case that are worth drawing.
struct Section {
  const CaseRecord* record = nullptr;
  const std::vector<double>*u = nullptr, *v = nullptr;
  std::vector<Rows> rows;     ///< by orbit
  std::vector<char> repeats;  ///< by orbit: its points are few, and each of them is a branch of the diagram
  size_t stored = 0, count = 0, cloud = 0;
};

std::optional<Section> section_of(const CaseRecord& record) {
  const NumberType<SectionColumns> type = points_type();
  const NumberTable* table = type.find(record.numbers);
  const SectionColumns columns = table ? type.read(*table) : SectionColumns();
  if (!columns.displacement || !columns.velocity) return std::nullopt;
  Section out;
  out.record = &record;
  out.u = &columns.displacement->get();
  out.v = &columns.velocity->get();
  const std::vector<OrbitRow> orbits = orbits_of(record);
  out.rows = rows_by_orbit(*table, columns, orbits);
  const Extent us = extent(*out.u), vs = extent(*out.v);
  const auto cell = [](double value, const Extent& range) {
    return range.high > range.low ? std::llround((value - range.low) / (range.high - range.low) * cells_across) : 0LL;
  };
  for (size_t o = 0; o < orbits.size(); ++o) {
    Rows& rows = out.rows[o];
    out.stored += rows.size();
    std::erase_if(rows, [&](std::uint32_t i) { return !std::isfinite((*out.u)[i]) || !std::isfinite((*out.v)[i]); });
    out.repeats.push_back(regime_group(orbits[o]) < repeating_groups);
    if (out.repeats.back()) {
      std::set<std::pair<long long, long long>> seen;
      std::erase_if(
          rows, [&](std::uint32_t i) { return !seen.emplace(cell((*out.u)[i], us), cell((*out.v)[i], vs)).second; });
    }
    out.count += rows.size();
    if (!out.repeats.back()) out.cloud += rows.size();
  }
  return out;
}

/// Writes integers as the shortest type that holds `most`, floats in single precision.
void put_orbits(CurveData& curves, const std::string& key, const std::vector<std::uint32_t>& values, size_t most) {
  std::vector<unsigned char> bytes;
  const int width = most < 65536 ? 2 : 4;
  for (const std::uint32_t value : values)
    for (int k = 0; k < width; ++k) bytes.push_back(static_cast<unsigned char>(value >> (8 * k)));
  curves.put(key, width == 2 ? "u16" : "u32", bytes);
}

using OrbitJson = nlohmann::ordered_json;

/// Columns of a case's `values` for the page's script: {"name": [cells]}, without columns that say nothing.
OrbitJson columns_of(const Table& table) {
  OrbitJson out = OrbitJson::object();
  for (size_t c = 0; c < table.columns.size(); ++c) {
    OrbitJson column = OrbitJson::array();
    bool says = false;
    for (const auto& row : table.rows) {
      says = says || !row[c].text().empty();
      column.push_back(json_of(row[c]));
    }
    if (says) out[table.columns[c].name] = std::move(column);
  }
  return out;
}

/// Attractors by (case, parameter, start), from the table that was derived of all cases.
std::map<std::tuple<std::string, double, std::string>, std::string> attractors_of(const StudyResults& results) {
  std::map<std::tuple<std::string, double, std::string>, std::string> out;
  const Table* values = find_table(results.derived, values_name);
  if (!values) return out;
  for (const OrbitRow& orbit : orbits_in(*values))
    if (!std::isnan(orbit.parameter) && orbit.attractor)
      out[{orbit.id, orbit.parameter, orbit.start}] = std::to_string(*orbit.attractor);
  return out;
}

/// Half-way to the neighbours of the same start.
void put_intervals(const std::vector<OrbitRow>& orbits, bool logarithmic, OrbitJson& into) {
  std::map<std::string, std::vector<size_t>> by_start;
  for (size_t o = 0; o < orbits.size(); ++o) by_start[orbits[o].start].push_back(o);
  std::vector<double> from(orbits.size()), to(orbits.size());
  const auto middle = [&](double a, double b) { return logarithmic ? std::sqrt(a * b) : 0.5 * (a + b); };
  const auto mirror = [&](double a, double b) { return logarithmic ? a * a / b : 2 * a - b; };
  for (auto& [start, list] : by_start) {
    std::stable_sort(list.begin(), list.end(),
                     [&](size_t a, size_t b) { return orbits[a].parameter < orbits[b].parameter; });
    const size_t n = list.size();
    for (size_t k = 0; k < n; ++k) {
      const double here = orbits[list[k]].parameter;
      const double below =
          k > 0 ? orbits[list[k - 1]].parameter : mirror(here, orbits[list[std::min<size_t>(1, n - 1)]].parameter);
      const double above =
          k + 1 < n ? orbits[list[k + 1]].parameter : mirror(here, orbits[list[k > 0 ? k - 1 : 0]].parameter);
      from[list[k]] = middle(below, here);
      to[list[k]] = middle(here, above);
    }
  }
  into["from"] = from;
  into["to"] = to;
}

}  // namespace

std::string put_points(const Choices& choices, CurveData& curves, const PageBudget& budget) {
  std::vector<Section> sections;
  for (const CaseRecord* record : all_cases(choices.results()))
    if (auto section = section_of(*record)) sections.push_back(std::move(*section));
  std::vector<size_t> wants;
  size_t stored = 0, apart = 0, drawn = 0;
  for (const Section& section : sections) {
    wants.push_back(section.cloud);
    stored += section.stored;
    apart += section.count;
  }
  // Branches are never thinned: a missing one would be a lie. What they leave of the budget goes to the clouds.
  size_t branches = apart;
  for (const size_t cloud : wants) branches -= cloud;
  const std::vector<size_t> shares = share_out(wants, budget.points - std::min(branches, budget.points));
  for (size_t s = 0; s < sections.size(); ++s) {
    const Section& section = sections[s];
    std::vector<std::uint32_t> orbit;
    std::vector<double> u, v;
    const double share = section.cloud > 0 ? static_cast<double>(shares[s]) / static_cast<double>(section.cloud) : 1;
    for (size_t o = 0; o < section.rows.size(); ++o) {
      const Rows& all = section.rows[o];
      const auto even = static_cast<size_t>(std::ceil(share * static_cast<double>(all.size())));
      const size_t keep = section.repeats[o] ? all.size() : std::min(all.size(), std::max<size_t>(1, even));
      for (const std::uint32_t i : spread(all, keep)) {
        orbit.push_back(static_cast<std::uint32_t>(o));
        u.push_back((*section.u)[i]);
        v.push_back((*section.v)[i]);
      }
    }
    drawn += orbit.size();
    put_orbits(curves, section.record->id + "/points/orbit", orbit, section.rows.size());
    curves.put_floats(section.record->id + "/points/u", u);
    curves.put_floats(section.record->id + "/points/v", v);
  }
  if (stored == 0) return "";
  std::string out = fmt::format("{} section points are drawn of {} stored", drawn, stored);
  if (drawn == stored) return fmt::format("All {} section points are drawn.", stored);
  if (apart < stored)
    out += fmt::format("; {} repeat one of their own periodic orbit to 1/{} of the frame", stored - apart,
                       static_cast<int>(cells_across));
  if (drawn < apart)
    out += fmt::format("; {} more are left out of the clouds, evenly of each orbit, so that the page stays quick",
                       apart - drawn);
  return out + ". All are in points.csv.";
}

std::string put_portraits(const Choices& choices, CurveData& curves, const PageBudget& budget) {
  struct Stored {
    const CaseRecord* record;
    PortraitColumns columns;
    std::vector<Rows> rows;
  };
  const NumberType<PortraitColumns> type = portraits_type();
  std::vector<Stored> all;
  size_t samples = 0, count = 0, kept = 0;
  for (const CaseRecord* record : all_cases(choices.results())) {
    const NumberTable* table = type.find(record->numbers);
    const PortraitColumns columns = table ? type.read(*table) : PortraitColumns();
    if (!columns.time || !columns.displacement || !columns.velocity) continue;
    all.push_back({record, columns, rows_by_orbit(*table, columns, orbits_of(*record))});
    for (const Rows& rows : all.back().rows) {
      samples += rows.size();
      count += !rows.empty();
    }
  }
  const size_t every = std::max<size_t>(1, (samples + budget.portraits - 1) / std::max<size_t>(budget.portraits, 1));
  for (const Stored& stored : all) {
    std::vector<std::uint32_t> orbit;
    std::vector<double> columns[3];
    const std::vector<double>* from[] = {&stored.columns.time->get(), &stored.columns.displacement->get(),
                                         &stored.columns.velocity->get()};
    for (size_t o = 0; o < stored.rows.size(); ++o) {
      if (stored.rows[o].empty() || o % every != 0) continue;
      ++kept;
      for (const std::uint32_t i : stored.rows[o]) {
        if (!std::isfinite((*from[0])[i]) || !std::isfinite((*from[1])[i]) || !std::isfinite((*from[2])[i])) continue;
        orbit.push_back(static_cast<std::uint32_t>(o));
        for (int c = 0; c < 3; ++c) columns[c].push_back((*from[c])[i]);
      }
    }
    put_orbits(curves, stored.record->id + "/portrait/orbit", orbit, stored.rows.size());
    const char* names[] = {"/portrait/t", "/portrait/u", "/portrait/v"};
    for (int c = 0; c < 3; ++c) curves.put_floats(stored.record->id + names[c], columns[c]);
  }
  if (kept == count) return "";
  return fmt::format(
      "The page carries the portraits of {} of {} values and starts; the command shown beside a point "
      "makes any other again.",
      kept, count);
}

OrbitJson orbit_data(const Choices& choices, CurveData& curves) {
  const StudyResults& results = choices.results();
  const auto attractors = attractors_of(results);
  const Quantity parameter = swept_parameter(results);
  OrbitJson groups = OrbitJson::array(), kinds = OrbitJson::array();
  for (const RegimeGroup& group : regime_groups) groups.push_back({group.name, group.colour});
  for (const StartKind& kind : start_kinds) kinds.push_back({kind.name, kind.symbol});
  OrbitJson out = {{"parameter", {parameter.name, parameter.unit}}, {"groups", groups}, {"kinds", kinds}};
  OrbitJson cases = OrbitJson::object();
  for (const CaseRecord* record : all_cases(choices.results())) {
    const Table* table = find_table(record->tables, values_name);
    if (!table || table->rows.empty()) continue;
    const std::vector<OrbitRow> orbits = orbits_in(*table);
    OrbitJson one = {{"columns", columns_of(*table)}};
    OrbitJson group = OrbitJson::array(), kind = OrbitJson::array();
    double low = INFINITY, high = -INFINITY;
    for (const OrbitRow& orbit : orbits) {
      group.push_back(regime_group(orbit));
      kind.push_back(start_kind(orbit.start));
      low = std::min(low, orbit.parameter);
      high = std::max(high, orbit.parameter);
    }
    one["group"] = std::move(group);
    one["kind"] = std::move(kind);
    put_intervals(orbits, logarithmic_sweep(low, high), one);
    if (!attractors.empty()) {
      OrbitJson names = OrbitJson::array();
      for (const OrbitRow& orbit : orbits) {
        const auto found = attractors.find({record->id, orbit.parameter, orbit.start});
        names.push_back(found == attractors.end() ? OrbitJson(nullptr) : OrbitJson(found->second));
      }
      one["columns"]["attractor"] = std::move(names);
    }
    if (const NumberTable* points = points_type().find(record->numbers))
      if (const Series* u = points_type().read(*points).displacement)
        if (const Extent reach = extent(u->get()); reach.low <= reach.high) one["extent"] = {reach.low, reach.high};
    cases[record->id] = std::move(one);
  }
  if (cases.empty()) return nullptr;
  out["cases"] = std::move(cases);
  out["said"] = {put_points(choices, curves), put_portraits(choices, curves)};
  return out;
}

}  // namespace ricochet::report
