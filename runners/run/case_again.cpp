#include "runners/run/case_again.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>

#include "runners/store/record_values.hpp"
#include "runners/table/csv_text.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void compare_series(const std::string& what, const std::vector<double>& stored, const std::vector<double>& again,
                    Comparison& out) {
  ++out.series;
  if (stored.size() != again.size()) {
    out.differences.push_back(fmt::format("{} has {} numbers, stored are {}", what, again.size(), stored.size()));
    return;
  }
  for (std::size_t i = 0; i < stored.size(); ++i)
    if (!same_bits(stored[i], again[i])) {
      out.differences.push_back(fmt::format("{} differs from number {} on: {}, stored is {}", what, i,
                                            csv_number(again[i]), csv_number(stored[i])));
      return;
    }
}

void compare_measures(const CaseRecord& stored, const CaseRecord& again, Comparison& out) {
  const auto of_motion = [](const std::string& name) {
    const MeasureInfo* info = measure_info(name);
    return !info || info->of == MeasureInfo::Of::motion;
  };
  for (const auto& [name, value] : again.measures) {
    if (!of_motion(name)) continue;
    ++out.measures;
    const auto kept = measure(stored, name);
    if (!kept)
      out.differences.push_back(fmt::format("{} is {}, and is not stored", name, csv_number(value)));
    else if (*kept != value)  // the store keeps no sign of a zero
      out.differences.push_back(fmt::format("{} is {}, stored is {}", name, csv_number(value), csv_number(*kept)));
  }
  for (const auto& [name, value] : stored.measures)
    if (of_motion(name) && !measure(again, name))
      out.differences.push_back(fmt::format("{} is stored as {}, and is not measured", name, csv_number(value)));
}

}  // namespace

Comparison compare(const CaseRecord& stored, const CaseRecord& again) {
  Comparison out;
  if (stored.status != again.status)
    out.differences.push_back(fmt::format("it is {}, stored as {}", again.status, stored.status));
  if (stored.steps != again.steps)
    out.differences.push_back(fmt::format("it takes {} steps, stored are {}", again.steps, stored.steps));
  compare_measures(stored, again, out);
  for (std::size_t c = 0; c < again.curve.names.size(); ++c)
    for (std::size_t k = 0; k < stored.curve.names.size(); ++k)
      if (stored.curve.names[k] == again.curve.names[c])
        compare_series("the curve's " + again.curve.names[c], stored.curve.columns[k], again.curve.columns[c], out);
  for (const NumberTable& numbers : again.numbers)
    if (const NumberTable* kept = find_table(stored.numbers, numbers.name))
      for (std::size_t c = 0; c < numbers.columns.size(); ++c)
        if (const auto* series = kept->numbers(numbers.columns[c].name))
          compare_series(numbers.name + "." + numbers.columns[c].name, *series, numbers.values[c], out);
  for (const Table& table : again.tables) {
    const Table* kept = find_table(stored.tables, table.name);
    if (!kept) continue;
    ++out.tables;
    if (kept->rows != table.rows)
      out.differences.push_back(fmt::format("rows of {} differ from those stored", table.name));
  }
  return out;
}

std::string text(const Comparison& comparison) {
  if (comparison.differences.empty())
    return fmt::format("as stored to the last bit: {} measures, {} series of numbers, {} tables\n", comparison.measures,
                       comparison.series, comparison.tables);
  constexpr std::size_t told = 20;
  std::string out = "not as stored, the results are of another build of the program or of its plugins:\n";
  for (std::size_t k = 0; k < comparison.differences.size() && k < told; ++k)
    out += "  " + comparison.differences[k] + "\n";
  if (comparison.differences.size() > told) out += fmt::format("  and {} more\n", comparison.differences.size() - told);
  return out;
}

}  // namespace ricochet
