#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "runners/kinds/basins/page/basins.hpp"
#include "runners/kinds/basins/page/page.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/axis_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/report/html_table.hpp"

namespace ricochet::report {
namespace {

/// Attractors × cases: share of the cells.
std::string fractions_html(const CaseView& view) {
  const AxisRows rows(view.results(), "basin_fractions");
  if (rows.empty()) return "";
  std::map<std::pair<std::string, std::string>, size_t> place;
  std::map<std::string, std::string> classes;
  for (size_t row = 0; row < rows.size(); ++row) {
    place[{rows.text(row, "attractor"), rows.text(row, "case")}] = row;
    const auto period = rows.number(row, "period");
    classes[rows.text(row, "attractor")] = regime_text(rows.text(row, "class"), period);
  }
  const std::vector<std::string> cases = rows.values("case");
  HtmlTable table("Share of the decided cells that ends in each attractor, with its 95 % interval.",
                  {{"ends in"}, {"class"}});
  for (const std::string& one : cases) table.add({view.name_of(one)});
  for (const std::string& attractor : rows.values("attractor")) {
    table.row(attractor.empty() ? "none" : "attractor " + attractor).text(classes[attractor]);
    for (const std::string& one : cases) {
      const auto found = place.find({attractor, one});
      const auto share = found == place.end() ? std::nullopt : rows.number(found->second, "fraction");
      if (!share) {
        table.absent();
        continue;
      }
      const size_t row = found->second;
      table.number(share_text(*share, rows.number(row, "low"), rows.number(row, "high")),
                   number_text(rows.number(row, "cells").value_or(0)) + " cells");
    }
  }
  return table.html();
}

std::string uncertainty_html(const CaseView& view) {
  const AxisRows rows(view.results(), "basin_uncertainty");
  HtmlTable table(
      "Uncertainty exponent s: the share of cells with an uncertain end falls as (uncertainty)<sup>s</sup>; 1 is a "
      "smooth boundary, 0 one that no accuracy resolves (Grebogi, McDonald, Ott and Yorke 1983). With its 95 % "
      "interval.",
      {{"case"}, {"cells at the boundary", true}, {"s"}, {""}});
  for (size_t row = 0; row < rows.size(); ++row) {
    const auto value = rows.number(row, "exponent"), low = rows.number(row, "low"), high = rows.number(row, "high"),
               share = rows.number(row, "boundary_share");
    std::string text = "too few scales to say";
    if (value) text = number_text(*value, 3);
    if (value && low && high) text += fmt::format(" ({} to {})", number_text(*low, 3), number_text(*high, 3));
    const char* said = !value || !high ? "–" : *high < 1 ? "fractal boundary" : "a smooth boundary is not excluded";
    table.row(view.name_of(rows.text(row, "case"))).number(share ? share_text(*share) : "–").text(text).text(said);
  }
  return table.html();
}

std::string differences_html(const CaseView& view) {
  const AxisRows rows(view.results(), "basin_differences");
  HtmlTable table("Cells that end elsewhere with another method.",
                  {{"case"}, {"and"}, {"decided in both", true}, {"differ", true}, {"share", true}});
  std::set<std::pair<std::string, std::string>> said;
  for (size_t row = 0; row < rows.size(); ++row) {
    const std::string one = rows.text(row, "case"), other = rows.text(row, "other_case");
    if (one == other || !said.emplace(std::min(one, other), std::max(one, other)).second) continue;  // each pair once
    const auto share = rows.number(row, "share");
    table.row(view.name_of(one)).text(view.name_of(other));
    table.number(number_text(rows.number(row, "cells").value_or(0)));
    table.number(number_text(rows.number(row, "differ").value_or(0))).number(share ? share_text(*share) : "–");
  }
  return table.html();
}

}  // namespace

std::vector<std::string> basins_said(const CaseView& view) {
  const Basins basins = basins_of(view.results());
  if (basins.grids.empty()) return {};
  size_t attractors = 0, known = 0, decided = 0, fewest = basins.xs.size() * basins.ys.size(), most_beyond = 0;
  for (const BasinLabel& label : basins.labels) attractors += label.decided;
  for (const BasinGrid& grid : basins.grids) {
    fewest = std::min(fewest, grid.no_starts);
    most_beyond = std::max(most_beyond, grid.no_starts);
    for (const std::uint8_t cell : grid.cells) {
      known += cell != BasinGrid::absent && basins.labels[cell].start;
      decided += cell != BasinGrid::absent && basins.labels[cell].decided;
    }
  }
  std::vector<std::string> out = {
      fmt::format("Over {} × {} cells in {}: {}; {} of the {} end in one of them.", basins.xs.size(), basins.ys.size(),
                  count_text(basins.grids.size(), "case", "cases"), count_text(attractors, "attractor", "attractors"),
                  known > 0 ? share_text(static_cast<double>(decided) / static_cast<double>(known)) : "none",
                  most_beyond > 0 ? "starts" : "cells")};
  if (most_beyond > 0)
    out.push_back(
        fmt::format("{} of the {} cells are no starts: they begin beyond a stop, and no share counts them.",
                    fewest == most_beyond ? std::to_string(most_beyond) : fmt::format("{} to {}", fewest, most_beyond),
                    basins.xs.size() * basins.ys.size()));
  double most = -1;
  std::string who;
  const AxisRows differences(view.results(), "basin_differences");
  for (size_t row = 0; row < differences.size(); ++row)
    if (const auto share = differences.number(row, "share"); share && *share > most) {
      most = *share;
      who = view.name_of(differences.text(row, "case")) + " and " + view.name_of(differences.text(row, "other_case"));
    }
  if (most >= 0 && basins.grids.size() > 1)
    out.push_back(fmt::format("At most {} of them depend on the method ({}).", share_text(most), who));
  const AxisRows exponents(view.results(), "basin_uncertainty");
  for (size_t row = 0; row < exponents.size(); ++row)
    if (const auto high = exponents.number(row, "high"); high && *high < 1)
      out.push_back(fmt::format("The boundary of basins is fractal in {}: uncertainty exponent {} (95 %: {} to {}).",
                                view.name_of(exponents.text(row, "case")),
                                number_text(exponents.number(row, "exponent").value_or(0), 2),
                                number_text(exponents.number(row, "low").value_or(0), 2), number_text(*high, 2)));
  return out;
}

std::string basins_html(const CaseView& view) {
  if (basins_of(view.results()).grids.empty()) return "";
  return fractions_html(view) + differences_html(view) + uncertainty_html(view);
}

}  // namespace ricochet::report
