#include "runners/kinds/bifurcation/page/page.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <ricochet/measure/statistics/quantiles.hpp>

#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/report/choices.hpp"

namespace ricochet::report {

KindPage bifurcation_page() {
  KindPage page;
  page.scripts = scripts({"orbits", "orbit_panel", "diagram_panels", "diagram", "distance"});
  page.tables = {"intervals", "exponent_methods", "distance_spreads", "distance_medians"};
  page.own_tables = {"bifurcations"};
  page.derived = {distance_spreads, distance_medians, exponent_methods};
  page.answer = dynamics_answer_html;
  page.methods = dynamics_tables_html;
  page.data_key = "orbits";
  page.data = orbit_data;
  page.masses = false;
  return page;
}

namespace {

struct DistanceKind {
  const char* name;
  std::optional<double> DistanceRow::*distance, DistanceRow::*null;
};
constexpr DistanceKind distance_kinds[] = {{"wasserstein", &DistanceRow::wasserstein, &DistanceRow::null_wasserstein},
                                           {"hausdorff", &DistanceRow::hausdorff, &DistanceRow::null_hausdorff}};

/// Distances of one kind: by case at each value of the parameter; the null level under "".
using Distances = std::map<std::string, std::map<double, std::vector<double>>>;

struct DistanceTable {
  Distances of[2];
  std::string reference;
};

DistanceTable read_distances(const StudyResults& results) {
  DistanceTable out;
  for (const DistanceRow& row : distances_type().read(results.derived)) {
    if (!row.parameter) continue;
    out.reference = row.reference;
    for (int k = 0; k < 2; ++k) {
      auto& own = out.of[k][row.id][*row.parameter];  // a case without distances is still known
      if (const auto value = row.*distance_kinds[k].distance) own.push_back(*value);
      if (const auto null = row.*distance_kinds[k].null) out.of[k][""][*row.parameter].push_back(*null);
    }
  }
  return out;
}

}  // namespace

Table distance_spreads(const Choices& choices) {
  Table out{"distance_spreads",
            "One row per case and kind of distance: the distances to the reference case over all values and starts. "
            "The row without a case is the null level, of two halves of one orbit.",
            {{"case", "", "Identity of the case: its row in cases.csv; nothing for the null level."},
             {"kind", "", "wasserstein or hausdorff."},
             {"reference_case", "", "The case that distances are taken to."},
             {"count", "1", "Values and starts that have a distance."},
             {"zeros", "1", "How many of them are exactly zero."},
             {"low", "1", "Distance below which a tenth of them lies."},
             {"median", "1", "Median distance."},
             {"high", "1", "Distance below which nine tenths of them lie."},
             {"smallest", "1", "Smallest distance above zero."},
             {"largest", "1", "Largest distance."}},
            {}};
  const DistanceTable distances = read_distances(choices.results());
  for (int k = 0; k < 2; ++k)
    for (const auto& [id, by_parameter] : distances.of[k]) {
      std::vector<double> all;
      for (const auto& [parameter, values] : by_parameter) all.insert(all.end(), values.begin(), values.end());
      std::sort(all.begin(), all.end());
      const auto zeros = std::count(all.begin(), all.end(), 0.0);
      const auto above = std::upper_bound(all.begin(), all.end(), 0.0);
      Row row = {id, distance_kinds[k].name, distances.reference, all.size(), zeros};
      for (const double share : {0.1, 0.5, 0.9}) row.push_back(all.empty() ? Cell() : Cell(quantile(all, share)));
      // A logarithmic axis frames what lies above zero.
      row.push_back(above == all.end() ? Cell() : Cell(*above));
      row.push_back(above == all.end() ? Cell() : Cell(all.back()));
      out.rows.push_back(std::move(row));
    }
  return out;
}

Table distance_medians(const Choices& choices) {
  Table out{"distance_medians",
            "One row per case, kind of distance and value of the parameter. Rows without a case are the null level.",
            {{"case", "", "Identity of the case: its row in cases.csv; nothing for the null level."},
             {"kind", "", "wasserstein or hausdorff."},
             {"parameter", swept_columns(choices.results()).parameter.unit, "Value of the swept parameter."},
             {"median", "1", "Median distance over the starts."}},
            {}};
  DistanceTable distances = read_distances(choices.results());
  for (int k = 0; k < 2; ++k)
    for (auto& [id, by_parameter] : distances.of[k])
      for (auto& [parameter, values] : by_parameter) {
        if (values.empty()) continue;
        std::sort(values.begin(), values.end());
        out.rows.push_back({id, distance_kinds[k].name, parameter, quantile(values, 0.5)});
      }
  return out;
}

Table exponent_methods(const Choices& choices) {
  Table out{"exponent_methods",
            "One row per method of exponents: how many orbits it was used for.",
            {{"method", "", "tangent, tangent+jump or twin."},
             {"orbits", "1", "Orbits whose exponents come from it."},
             {"all", "1", "Orbits with exponents, over all methods."},
             {"marginal", "1", "Orbits of all methods that have a root on the unit circle by themselves."}},
            {}};
  std::map<std::string, size_t> counts;
  size_t all = 0, marginal = 0;
  for (const CaseRecord* record : all_cases(choices.results()))
    for (const OrbitRow& orbit : orbits_of(*record)) {
      if (!orbit.largest_exponent()) continue;
      ++counts[orbit.exponent_method];
      ++all;
      marginal += !orbit.marginal.empty();
    }
  for (const auto& [method, count] : counts) out.rows.push_back({method, count, all, marginal});
  return out;
}

}  // namespace ricochet::report
