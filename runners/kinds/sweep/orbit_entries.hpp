#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runners/kinds/sweep/orbit_rows.hpp"

namespace ricochet {

/// The most numbers that the entries of one case may take; beyond, none are kept.
constexpr std::size_t most_entry_numbers = 2000000;

/// Numbers `entries` (not exported): parameter, start, index, value: the state of each complete orbit when its kept
/// periods began, from which "ricochet point" marches them again: how many slots, efforts and fastest speeds, then
/// these one after the other, then what the law remembers (see LaneState). Absent, with a note, where they would take
/// too much room.
void add_entries(CaseRecord& record, const std::vector<OrbitView>& views, const std::vector<std::string>& starts);

/// A column of a table of numbers in the rows of one orbit; empty where the case keeps none.
std::vector<double> orbit_numbers(const CaseRecord& record, const char* table, const char* column, double parameter,
                                  const std::string& start);

/// The entry of one orbit of a stored case; none where the case keeps none. Throws std::runtime_error for numbers that
/// add_entries() did not write.
std::optional<LaneState> find_entry(const CaseRecord& record, double parameter, const std::string& start);

}  // namespace ricochet
