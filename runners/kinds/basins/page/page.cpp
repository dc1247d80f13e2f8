#include "runners/kinds/basins/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "runners/json/json_text.hpp"
#include "runners/kinds/basins/cell_scenes.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/html.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::report {

KindPage basins_page() {
  KindPage page;
  page.scripts = scripts({"basins"});
  page.tables = {"basin_counts", "basin_failures"};
  page.derived = {basin_counts, basin_failures};
  page.answer = basins_html;
  page.data_key = "basins";
  page.data = basin_data;
  page.masses = false;
  return page;
}

nlohmann::ordered_json basin_data(const CaseView& view, CurveData& blocks) {
  const Basins basins = basins_of(view.results());
  Json labels = Json::array(), grids = Json::array();
  for (const BasinLabel& label : basins.labels)
    labels.push_back({label.name, label.colour, label.decided, label.start});
  for (const BasinGrid& grid : basins.grids) {
    blocks.put(grid.record->id + "/cells", "u8", grid.cells);
    grids.push_back(grid.record->id);
  }
  return {{"x", {basins.x.name, basins.x.unit}},
          {"y", {basins.y.name, basins.y.unit}},
          {"xs", basins.xs},
          {"ys", basins.ys},
          {"labels", std::move(labels)},
          {"grids", std::move(grids)}};
}

Table basin_counts(const CaseView& view) {
  Table out{"basin_counts",
            "One row per case: its grid of basins beside that of the first case.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"other_case", "", "The first case of the study, which the grid is compared with."},
             {"cells", "1", "Cells of the grid."},
             {"filled", "1", "Cells that take the end of a marched one."},
             {"differ", "1", "Cells decided in both grids that end elsewhere."},
             {"same", "1", "Cells decided in both grids that end alike."},
             {"undecided", "1", "Cells that are starts in one of the two, and undecided in one."},
             {"decided", "1", "Cells that both decide."},
             {"share", "1", "Share of the cells decided in both that differ."},
             {"no_starts", "1", "Cells that begin beyond a stop: no motion begins there."}},
            {}};
  const Basins basins = basins_of(view.results());
  if (basins.grids.empty()) return out;
  const BasinGrid& first = basins.grids.front();
  const auto decided = [&](std::uint8_t cell) { return cell != BasinGrid::absent && basins.labels[cell].decided; };
  const auto starts = [&](std::uint8_t cell) { return cell == BasinGrid::absent || basins.labels[cell].start; };
  for (const BasinGrid& grid : basins.grids) {
    size_t differ = 0, same = 0, neither = 0;
    for (size_t i = 0; i < grid.cells.size(); ++i) {
      neither += !starts(grid.cells[i]) && !starts(first.cells[i]);
      if (!decided(grid.cells[i]) || !decided(first.cells[i])) continue;
      ++(grid.cells[i] == first.cells[i] ? same : differ);
    }
    const size_t both = differ + same;
    const Cell share = both > 0 ? Cell(static_cast<double>(differ) / static_cast<double>(both)) : Cell();
    out.rows.push_back({grid.record->id, first.record->id, grid.cells.size(), grid.filled, differ, same,
                        grid.cells.size() - both - neither, both, share, grid.no_starts});
  }
  return out;
}

Table basin_failures(const CaseView& view) {
  Table out{"basin_failures",
            "One row per case and reason: cells whose orbit failed.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"reason", "", "What became of the cells."},
             {"cells", "1", "Cells that it happened to."}},
            {}};
  for (const BasinGrid& grid : basins_of(view.results()).grids)
    for (const auto& [reason, count] : grid.reasons) out.rows.push_back({grid.record->id, reason, count});
  return out;
}

namespace {

constexpr size_t most_labels = 250;
constexpr std::array attractor_colours = {"#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00",
                                          "#6A3D9A", "#8C6D31", "#F0E442", "#44AA99", "#882255", "#999933"};

/// How a label sorts: attractors by number before everything else.
using Rank = std::pair<long long, std::string>;
constexpr long long no_attractor = 1'000'000'000, not_started = 2 * no_attractor;
constexpr const char* not_started_colour = "#E4DFD2";

struct PlacedCell {
  const CaseRecord* record;
  double x, y;
  Rank rank;
  std::string reason;
  bool filled = false;
};

Rank rank_of(const CellRow& cell) {
  if (cell.attractor) return {*cell.attractor, ""};
  const std::string status = cell.status.value_or("");
  if (status == no_start) return {not_started, no_start};
  if ((status == "failed" || status == "refused" || status == "diverged"))
    return {no_attractor + static_cast<long long>(failed_group), regime_groups[failed_group].name};
  const size_t group = regime_group(cell.regime, cell.period);
  return {no_attractor + static_cast<long long>(group), regime_groups[group].name};
}

std::vector<PlacedCell> cells_of(const StudyResults& results) {
  std::map<std::string, const CaseRecord*> by_id;
  for (const CaseRecord& record : results.cases) by_id[record.id] = &record;
  std::vector<PlacedCell> out;
  const TableType<CellRow> type = cells_type();
  const auto read = [&](const Table& table, const CaseRecord* record) {
    type.rows.each(table, [&](size_t, const CellRow& cell) {
      const CaseRecord* owner = record;
      if (!owner) {
        const auto found = by_id.find(cell.id);
        if (found == by_id.end()) return;
        owner = found->second;
      }
      if (cell.x && cell.y)
        out.push_back({owner, *cell.x, *cell.y, rank_of(cell), cell.reason.value_or(""), !cell.marched.value_or(true)});
    });
  };
  if (const Table* table = type.find(results.derived)) read(*table, nullptr);
  if (!out.empty()) return out;
  for (const CaseRecord& record : results.cases)
    if (const Table* table = type.find(record.tables)) read(*table, &record);
  return out;
}

/// "attractor 2 (periodic 3)".
std::map<long long, std::string> attractor_names(const StudyResults& results) {
  std::map<long long, std::string> out;
  for (const AttractorRow& row : attractors_type().read(results.derived))
    if (row.attractor) out[*row.attractor] = regime_text(row.regime, row.period);
  return out;
}

}  // namespace

Basins basins_of(const StudyResults& results) {
  Basins out;
  const std::vector<PlacedCell> cells = cells_of(results);
  std::set<double> xs, ys;
  std::set<Rank> ranks;
  for (const PlacedCell& cell : cells) {
    xs.insert(cell.x);
    ys.insert(cell.y);
    ranks.insert(cell.rank);
  }
  out.xs.assign(xs.begin(), xs.end());
  out.ys.assign(ys.begin(), ys.end());
  const auto names = attractor_names(results);
  std::map<Rank, std::uint8_t> index;
  size_t attractor = 0;
  for (const Rank& rank : ranks) {
    index[rank] = static_cast<std::uint8_t>(std::min(out.labels.size(), most_labels - 1));
    if (out.labels.size() == most_labels) continue;
    if (rank.first == not_started) {
      out.labels.push_back({rank.second, not_started_colour, false, false});
    } else if (rank.first >= no_attractor) {
      const size_t group = regime_group(rank.second, std::nullopt);
      out.labels.push_back({rank.second, regime_groups[group].colour, false});
      // Groups such as "period 3" are no words of a class: without attractors they tell the cells apart.
      for (size_t g = 0; g < undecided_group; ++g)
        if (rank.second == regime_groups[g].name) out.labels.back() = {rank.second, regime_groups[g].colour, true};
    } else {
      const auto said = names.find(rank.first);
      out.labels.push_back({"attractor " + std::to_string(rank.first) +
                                (said == names.end() || said->second.empty() ? "" : " (" + said->second + ")"),
                            attractor_colours[attractor++ % attractor_colours.size()], true});
    }
  }
  std::map<const CaseRecord*, size_t> place;
  const auto at = [](const std::vector<double>& list, double value) {
    return static_cast<size_t>(std::lower_bound(list.begin(), list.end(), value) - list.begin());
  };
  std::set<const CaseRecord*> with_cells;
  for (const PlacedCell& cell : cells) with_cells.insert(cell.record);
  for (const CaseRecord& record : results.cases)
    if (with_cells.contains(&record)) {
      place[&record] = out.grids.size();
      out.grids.push_back({&record, std::vector<std::uint8_t>(xs.size() * ys.size(), BasinGrid::absent), 0, 0, {}});
    }
  for (const PlacedCell& cell : cells) {
    BasinGrid& grid = out.grids[place.at(cell.record)];
    const std::uint8_t label = index.at(cell.rank);
    grid.cells[at(out.ys, cell.y) * xs.size() + at(out.xs, cell.x)] = label;
    grid.no_starts += cell.rank.first == not_started;
    grid.filled +=
        cell.filled && cell.rank.first != not_started && cell.rank.second != regime_groups[failed_group].name;
    if (cell.rank.second == regime_groups[failed_group].name) ++grid.reasons[cell.reason];
  }
  const auto axes = results.study.find("axes");
  out.x = {"x", ""};
  out.y = {"y", ""};
  if (axes != results.study.end() && axes->is_array() && axes->size() == 2) {
    out.x = swept_quantity(results, (*axes)[0], "x");
    out.y = swept_quantity(results, (*axes)[1], "y");
  }
  return out;
}

namespace {

/// Attractors × cases: share of the cells.
std::string fractions_html(const CaseView& view) {
  const std::vector<FractionRow> rows = basin_fractions_type().read(view.results().derived);
  if (rows.empty()) return "";
  InOrderMet<std::string, bool> cases;
  InOrderMet<int, std::map<std::string, const FractionRow*>> attractors;  // by case
  for (const FractionRow& row : rows) {
    cases[row.id] = true;
    attractors[row.attractor][row.id] = &row;
  }
  HtmlTable table("Share of the decided cells that ends in each attractor, with its 95 % interval.",
                  {{"ends in"}, {"class"}});
  for (const auto& [one, met] : cases.list()) table.add({view.name_of(one)});
  for (const auto& [attractor, of_cases] : attractors.list()) {
    const FractionRow& last = *of_cases.rbegin()->second;
    table.row(fmt::format("attractor {}", attractor)).text(regime_text(last.regime, last.period));
    for (const auto& [one, met] : cases.list()) {
      const auto found = of_cases.find(one);
      if (found == of_cases.end() || !found->second->fraction) {
        table.absent();
        continue;
      }
      const FractionRow& row = *found->second;
      table.number(share_text(*row.fraction, row.low, row.high), number_text(row.cells) + " cells");
    }
  }
  return table.html();
}

std::string uncertainty_html(const CaseView& view) {
  HtmlTable table(
      "Uncertainty exponent s, with its 95 % interval: the share of cells with an uncertain end falls as "
      "(uncertainty)<sup>s</sup>. 1 is a smooth boundary, 0 one that no accuracy resolves (Grebogi, McDonald, Ott and "
      "Yorke 1983).",
      {{"case"}, {"cells at the boundary", true}, {"s"}, {""}});
  for (const auto& [id, share, value, low, high] : basin_uncertainty_type().read(view.results().derived)) {
    std::string text = "too few scales to say";
    if (value) text = number_text(*value, 3);
    if (value && low && high) text += fmt::format(" ({} to {})", number_text(*low, 3), number_text(*high, 3));
    const char* said = !value || !high ? "–" : *high < 1 ? "fractal boundary" : "a smooth boundary is not excluded";
    table.row(view.name_of(id)).number(share ? share_text(*share) : "–").text(text).text(said);
  }
  return table.html();
}

std::string differences_html(const CaseView& view) {
  HtmlTable table("Cells that end elsewhere with another method.",
                  {{"case"}, {"and"}, {"decided in both", true}, {"differ", true}, {"share", true}});
  std::set<std::pair<std::string, std::string>> said;
  for (const auto& [one, other, cells, differ, share] : basin_differences_type().read(view.results().derived)) {
    if (one == other || !said.emplace(std::min(one, other), std::max(one, other)).second) continue;  // each pair once
    table.row(view.name_of(one)).text(view.name_of(other)).number(number_text(cells));
    table.number(number_text(differ)).number(share ? share_text(*share) : "–");
  }
  return table.html();
}

}  // namespace

std::string basins_html(const CaseView& view) {
  if (basins_of(view.results()).grids.empty()) return "";
  return fractions_html(view) + differences_html(view) + uncertainty_html(view);
}

}  // namespace ricochet::report
