#include "runners/kinds/sweep/orbit_entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "runners/kinds/sweep/sweep_tables.hpp"

namespace ricochet {
namespace {

constexpr std::size_t state_counts = 3, entry_columns = 4;  // numbers in front of a state; columns of the table

std::vector<double> flat(const LaneState& state) {
  std::vector<double> all;
  for (const auto* part : {&state.slots, &state.efforts, &state.fastest})
    all.push_back(static_cast<double>(part->size()));
  for (const auto* part : {&state.slots, &state.efforts, &state.fastest})
    all.insert(all.end(), part->begin(), part->end());
  // What the law remembers stands last: the count of the others says where.
  all.insert(all.end(), state.memory.begin(), state.memory.end());
  return all;
}

LaneState lane_state(const std::vector<double>& all) {
  LaneState state;
  std::array<std::vector<double>*, state_counts> parts = {&state.slots, &state.efforts, &state.fastest};
  std::size_t at = state_counts;
  for (std::size_t k = 0; k < state_counts; ++k) {
    const double count = k < all.size() ? all[k] : -1;
    if (!(count >= 0) || count > static_cast<double>(all.size() - at))
      throw std::runtime_error("a stored state is cut short");
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(at);
    parts[k]->assign(first, first + static_cast<std::ptrdiff_t>(count));
    at += static_cast<std::size_t>(count);
  }
  state.memory.assign(all.begin() + static_cast<std::ptrdiff_t>(at), all.end());
  return state;
}

}  // namespace

void add_entries(CaseRecord& record, const std::vector<OrbitView>& views, const std::vector<std::string>& starts) {
  NumberTable table = entries_head();
  table.words = {{"start", starts}};
  for (const OrbitView& view : views) {
    if (!view.complete()) continue;
    const std::vector<double> state = flat(view.orbit->entry);
    if (entry_columns * (table.rows() + state.size()) > most_entry_numbers) {
      record.notes.push_back(
          fmt::format("the states that \"ricochet point\" begins with would take more than {} numbers: none are kept",
                      most_entry_numbers));
      return;
    }
    for (std::size_t i = 0; i < state.size(); ++i)
      table.add({view.value, static_cast<double>(view.start), static_cast<double>(i), state[i]});
  }
  record.numbers.push_back(std::move(table));
}

std::vector<double> orbit_numbers(const CaseRecord& record, const char* table, const char* column, double parameter,
                                  const std::string& start) {
  std::vector<double> found;
  const NumberTable* numbers = find_table(record.numbers, table);
  const auto* starts = numbers ? numbers->words_of("start") : nullptr;
  const auto *parameters = numbers ? numbers->numbers("parameter") : nullptr,
             *froms = numbers ? numbers->numbers("start") : nullptr,
             *values = numbers ? numbers->numbers(column) : nullptr;
  if (!starts || !parameters || !froms || !values) return found;
  const auto index = static_cast<double>(std::find(starts->begin(), starts->end(), start) - starts->begin());
  for (std::size_t row = 0; row < numbers->rows(); ++row)
    if ((*parameters)[row] == parameter && (*froms)[row] == index) found.push_back((*values)[row]);
  return found;
}

std::optional<LaneState> find_entry(const CaseRecord& record, double parameter, const std::string& start) {
  const std::vector<double> all = orbit_numbers(record, "entries", "value", parameter, start);
  if (all.size() >= state_counts) return lane_state(all);
  return std::nullopt;
}

}  // namespace ricochet
