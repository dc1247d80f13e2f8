#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/report/quantity.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {

/// What orbits are coloured by. The list, its order and its colours are the same for every study.
struct RegimeGroup {
  const char* name;
  const char* colour;
};
inline constexpr std::array<RegimeGroup, 12> regime_groups = {{{"no contact", "#5B5B5B"},
                                                               {"at rest", "#B8A200"},
                                                               {"period 1", "#0072B2"},
                                                               {"period 2", "#56B4E9"},
                                                               {"period 3", "#009E73"},
                                                               {"period 4", "#E69F00"},
                                                               {"periods 5–8", "#CC79A7"},
                                                               {"periods 9–64", "#6A3D9A"},
                                                               {"quasi-periodic", "#6B4C2A"},
                                                               {"chaotic", "#D55E00"},
                                                               {"undecided", "#B3B3B3"},
                                                               {"failed", "#111111"}}};
inline constexpr size_t undecided_group = 10, failed_group = 11;
inline constexpr size_t repeating_groups = 8;  ///< the first ones, of what repeats
/// Index into regime_groups; what did not finish is `failed`.
size_t regime_group(const OrbitRow& orbit);
/// The same for words such as "periodic 3".
size_t regime_group(std::string_view regime, std::optional<int> period);

/// Kinds of starts, told apart by symbols; random states share one.
struct StartKind {
  const char* name;
  const char* symbol;  ///< as the page's legends have it
};
inline constexpr std::array<StartKind, 5> start_kinds = {{{"from rest", "circle"},
                                                          {"from the scene's state", "diamond"},
                                                          {"upwards", "triangle"},
                                                          {"downwards", "triangle-down"},
                                                          {"from random states", "rect"}}};
size_t start_kind(std::string_view start);

/// The starts of some cases: rest, state, up, down, then random states by their number.
std::vector<std::string> starts_in(const Cases& cases);

/// Whether a sweep is drawn on a logarithmic axis: values above zero over a factor of fifty.
inline bool logarithmic_sweep(double low, double high) {
  return low > 0 && high >= 50 * low;
}

/// The parameter that a study of kind `bifurcation` sweeps.
Quantity swept_parameter(const StudyResults& results);

/// What a pointer of the study goes through, as axes of figures name it; a factor of a formula has no unit. `name`
/// where it is no pointer.
Quantity swept_quantity(const StudyResults& results, const nlohmann::ordered_json& where, const std::string& name);

}  // namespace ricochet::report
