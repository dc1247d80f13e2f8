#include "runners/kinds/basins/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "runners/json/json_text.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/report/quantity.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::report {

KindPage basins_page(std::shared_ptr<const BasinAnalysis> basins) {
  KindPage page;
  page.scripts = scripts({"basins"});
  page.tables = {"basin_counts", "basin_failures"};
  page.derived = {[basins](const Choices&) { return basin_counts(*basins); },
                  [basins](const Choices&) { return basin_failures(*basins); }};
  page.answer = [basins](const Choices& choices) { return basins_html(choices, *basins); };
  page.data_key = "basins";
  page.data = [basins](const Choices& choices, CurveData& blocks) { return basin_data(choices, *basins, blocks); };
  page.masses = false;
  return page;
}

nlohmann::ordered_json basin_data(const Choices& choices, const BasinAnalysis& basins, CurveData& blocks) {
  std::set<std::string> shown;
  for (const CaseRecord& record : choices.results().cases) shown.insert(record.id);
  Json labels = Json::array(), grids = Json::array();
  for (const BasinLabel& label : basins.labels)
    labels.push_back({label.name, label.colour, label.decided, label.start});
  for (const BasinImage& image : basins.images) {
    if (!shown.contains(image.record->id)) continue;
    blocks.put(image.record->id + "/cells", "u8", image.cells);
    grids.push_back(image.record->id);
  }
  Quantity x{"x", ""}, y{"y", ""};
  const nlohmann::ordered_json& study = choices.results().study;
  if (const auto axes = study.find("axes"); axes != study.end() && axes->is_array() && axes->size() == 2) {
    x = swept_quantity(choices.results(), (*axes)[0], x.name);
    y = swept_quantity(choices.results(), (*axes)[1], y.name);
  }
  return {{"x", {x.name, x.unit}}, {"y", {y.name, y.unit}},       {"xs", basins.xs},
          {"ys", basins.ys},       {"labels", std::move(labels)}, {"grids", std::move(grids)}};
}

Table basin_counts(const BasinAnalysis& basins) {
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
  if (basins.images.empty()) return out;
  const BasinImage& first = basins.images.front();
  const auto decided = [&](std::uint8_t cell) { return cell != BasinImage::absent && basins.labels[cell].decided; };
  const auto starts = [&](std::uint8_t cell) { return cell == BasinImage::absent || basins.labels[cell].start; };
  for (const BasinImage& grid : basins.images) {
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

Table basin_failures(const BasinAnalysis& basins) {
  Table out{"basin_failures",
            "One row per case and reason: cells whose orbit failed.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"reason", "", "What became of the cells."},
             {"cells", "1", "Cells that it happened to."}},
            {}};
  for (const BasinImage& grid : basins.images)
    for (const auto& [reason, count] : grid.reasons) out.rows.push_back({grid.record->id, reason, count});
  return out;
}

namespace {

/// Attractors × cases: share of the cells.
std::string fractions_html(const Choices& choices, const std::vector<FractionRow>& rows) {
  if (rows.empty()) return "";
  InOrderMet<std::string, bool> cases;
  InOrderMet<int, std::map<std::string, const FractionRow*>> attractors;  // by case
  for (const FractionRow& row : rows) {
    cases[row.id] = true;
    attractors[row.attractor][row.id] = &row;
  }
  HtmlTable table("Share of the decided cells that ends in each attractor, with its 95 % interval.",
                  {{"ends in"}, {"class"}});
  for (const auto& [one, met] : cases.list()) table.add({choices.name_of(one)});
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

std::string uncertainty_html(const Choices& choices, const std::vector<UncertaintyRow>& rows) {
  HtmlTable table(
      "Uncertainty exponent s, with its 95 % interval: the share of cells with an uncertain end falls as "
      "(uncertainty)<sup>s</sup>. 1 is a smooth boundary, 0 one that no accuracy resolves (Grebogi, McDonald, Ott and "
      "Yorke 1983).",
      {{"case"}, {"cells at the boundary", true}, {"s"}, {""}});
  for (const auto& [id, share, value, low, high] : rows) {
    std::string text = "too few scales to say";
    if (value) text = number_text(*value, 3);
    if (value && low && high) text += fmt::format(" ({} to {})", number_text(*low, 3), number_text(*high, 3));
    const char* said = !value || !high ? "–" : *high < 1 ? "fractal boundary" : "a smooth boundary is not excluded";
    table.row(choices.name_of(id)).number(share ? share_text(*share) : "–").text(text).text(said);
  }
  return table.html();
}

std::string differences_html(const Choices& choices, const std::vector<BasinDifferenceRow>& rows) {
  HtmlTable table(
      "Cells that end elsewhere with another method: in another motion, or on another orbit of that motion.",
      {{"case"},
       {"and"},
       {"decided in both", true},
       {"another motion", true},
       {"another orbit", true},
       {"share", true}});
  std::set<std::pair<std::string, std::string>> said;
  for (const auto& [one, other, cells, differ, motions, share] : rows) {
    if (one == other || !said.emplace(std::min(one, other), std::max(one, other)).second) continue;  // each pair once
    table.row(choices.name_of(one)).text(choices.name_of(other)).number(number_text(cells));
    table.number(number_text(motions)).number(number_text(differ)).number(share ? share_text(*share) : "–");
  }
  return table.html();
}

}  // namespace

std::string basins_html(const Choices& choices, const BasinAnalysis& basins) {
  if (basins.images.empty()) return "";
  return fractions_html(choices, basins.fractions) + differences_html(choices, basins.differences) +
         uncertainty_html(choices, basins.uncertainty);
}

}  // namespace ricochet::report
