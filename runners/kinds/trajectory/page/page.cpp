#include "runners/kinds/trajectory/page/page.hpp"

#include <fmt/format.h>

#include <cmath>

#include "runners/report/html.hpp"

namespace ricochet::report {

KindPage trajectory_page() {
  KindPage page;
  page.scripts =
      scripts({"along_axis", "over_time", "final_energy", "energy", "tip", "force", "penetration", "impacts"});
  page.tables = {"energy_changes"};
  page.curves = {"energy", "tip_displacement", "contact_force_peak"};
  page.derived = {energy_changes};
  page.answer = energy_answer;
  return page;
}

Table energy_changes(const CaseView& view) {
  Table out{"energy_changes",
            "One row per case: where its energy ends, told from its start.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"change", "1", "Distance of the energy left from 1."},
             {"gained", "", "Whether the energy grew."},
             {"conservative", "", "Whether nothing but contact and the method changes energies in this study."}},
            {}};
  const bool kept = conservative(view);
  for (const CaseRecord* record : view.all())
    if (const auto ratio = ricochet::measure(*record, "energy_left"))
      out.rows.push_back({record->id, std::abs(*ratio - 1), *ratio > 1, kept});
  return out;
}

namespace {

/// Steps of a problem that does not keep its energy: how the ratio moves between neighbours.
std::string moving_sentence(const std::string& trend, double ratio, double last_move) {
  const std::string finest = percent_text(ratio), moved = number_text(last_move / std::abs(ratio), 2);
  if (trend == "two steps only") return fmt::format("{}; the two steps differ by {} of it", finest, moved);
  return fmt::format("{}: {} at the finest step, last move {} of it", trend, finest, moved);
}

}  // namespace

std::string trend_sentence(const TableReader& trends, size_t row) {
  const std::string trend = trends.text(row, "trend");
  const auto number = [&](const char* column) { return trends.number(row, column); };
  if (trend == "nothing finished") return "no finished case";
  if (trend == "one step only") return trend;
  const double ratio = number("ratio").value_or(0), last_move = number("last_move").value_or(0);
  if (!number("last_change")) return moving_sentence(trend, ratio, last_move);
  const auto small = [&](const char* column) { return number_text(number(column).value_or(0), 2); };
  const std::string from_to = fmt::format("|change| {} → {}", small("first_change"), small("last_change"));
  if (trend == "kept")
    return number("steps") == 1.0 ? "kept to the noise floor" : "kept to the noise floor at every step";
  if (trend == "reaches its start") return "reaches its start within the noise floor";
  if (trend == "the same at every step") return "the same change at every step, to 5 %";
  if (trend == "settles")
    return fmt::format("settles near {}: the two finest steps differ by {}", percent_text(ratio), small("last_move"));
  if (trend == "comes closer") return "comes closer to its start: " + from_to;
  if (trend == "gains more" || trend == "loses more") return trend + " as the step shrinks: " + from_to;
  return fmt::format("no steady trend: |change| between {} and {}", small("smallest_change"), small("largest_change"));
}

}  // namespace ricochet::report
