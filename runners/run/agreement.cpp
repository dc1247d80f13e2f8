#include "runners/run/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "runners/answers/limits.hpp"
#include "runners/run/merge_folders.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

/// Reports and answers show four digits of a number: a change in the seventh is none of theirs.
constexpr double share_of_digits = 1e-6;

bool of_motion(const MeasureInfo* info) {
  return !info || info->of == MeasureInfo::Of::motion;
}

}  // namespace

/// What round-off leaves of a number that cancels: as many units in the last place as there are steps.
class RoundOff {
 public:
  explicit RoundOff(const CaseRecord& record) : steps_(static_cast<double>(std::max(record.steps, 1LL))) {
    for (const auto& [name, value] : record.measures)
      if (const MeasureInfo* info = measure_info(name); of_motion(info)) see(info ? info->unit : "", value);
    for (const NumberTable& table : record.numbers)
      for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (const auto* numbers = table.numbers(table.columns[c].name))
          for (const double value : *numbers) see(table.columns[c].unit, value);
  }

  /// |Δ| that is told from none, beside a number of this size.
  double tolerance(const std::string& unit, double size) const {
    const auto largest = largest_.find(unit);
    return share_of_digits * std::abs(size) + (largest == largest_.end() ? 0 : 0x1p-52 * steps_ * largest->second);
  }

 private:
  void see(const std::string& unit, double value) {
    if (unit.empty() || unit == "1" || !std::isfinite(value)) return;
    double& largest = largest_[unit];
    largest = std::max(largest, std::abs(value));
  }

  double steps_;
  std::map<std::string, double> largest_ = {{"1", 1.0}};  // by unit; ratios are beside 1, whatever counts there are
};

namespace {

bool near_columns(const std::vector<double>& stored, const std::vector<double>& again, const std::string& unit,
                  const RoundOff& round_off) {
  if (stored.size() != again.size()) return false;
  double size = 0;
  for (const double value : stored)
    if (std::isfinite(value)) size = std::max(size, std::abs(value));
  const double allowed = round_off.tolerance(unit, size);
  return std::equal(stored.begin(), stored.end(), again.begin(),
                    [&](double a, double b) { return same_bits(a, b) || std::abs(a - b) <= allowed; });
}

bool near_rows(const Table& stored, const Table& again, const RoundOff& round_off) {
  if (stored.rows.size() != again.rows.size() || stored.columns.size() != again.columns.size()) return false;
  for (std::size_t c = 0; c < stored.columns.size(); ++c) {
    std::vector<double> numbers[2];
    for (std::size_t r = 0; r < stored.rows.size(); ++r) {
      const auto a = stored.rows[r][c].number(), b = again.rows[r][c].number();
      if (a && b) {
        numbers[0].push_back(*a);
        numbers[1].push_back(*b);
      } else if (!(stored.rows[r][c] == again.rows[r][c])) {
        return false;
      }
    }
    if (!near_columns(numbers[0], numbers[1], stored.columns[c].unit, round_off)) return false;
  }
  return true;
}

/// The first curve or table that differs by more than round-off and six digits; "" where none does.
std::string apart(const CaseRecord& stored, const CaseRecord& again, const RoundOff& round_off) {
  for (std::size_t k = 0; k < stored.curve.names.size(); ++k)
    for (std::size_t c = 0; c < again.curve.names.size(); ++c)
      if (stored.curve.names[k] == again.curve.names[c] &&
          !near_columns(stored.curve.columns[k], again.curve.columns[c], "", round_off))
        return "the curve's " + again.curve.names[c];
  for (const NumberTable& table : again.numbers)
    if (const NumberTable* kept = find_table(stored.numbers, table.name))
      for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (const auto* numbers = kept->numbers(table.columns[c].name);
            numbers && !near_columns(*numbers, table.values[c], table.columns[c].unit, round_off))
          return table.name + "." + table.columns[c].name;
  for (const Table& table : again.tables)
    if (const Table* kept = find_table(stored.tables, table.name); kept && !near_rows(*kept, table, round_off))
      return table.name + ".csv";
  return "";
}

/// Measures of the motion that one of the two has, by their names.
std::vector<std::string> measures_of(const CaseRecord& stored, const CaseRecord& again) {
  std::vector<std::string> names;
  for (const CaseRecord* record : {&stored, &again})
    for (const auto& [name, value] : record->measures)
      if (of_motion(measure_info(name)) && std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
  return names;
}

}  // namespace

AgreementOf::AgreementOf(const AnalysedResults& results)
    : results_(results), keeps_energy_(answers::keeps_energy(results)) {
  for (const CaseRecord* record : all_cases(results)) methods_[results.choices.key(*record)].push_back(record);
}

StudyResults AgreementOf::of_its_method(const CaseRecord& stored, const CaseRecord& again) const {
  StudyResults alone;
  static_cast<StudyHeader&>(alone) = results_;
  for (const CaseRecord* record : methods_.at(results_.choices.key(stored))) {
    alone.cases.push_back(*record);
    if (record == &stored) alone.cases.back().measures = again.measures;
  }
  return alone;
}

std::optional<double> AgreementOf::left_open(const Choices& method, const std::string& name, double value) const {
  const answers::MeasureLimits limits = answers::limits_of(method, name, keeps_energy_, all_cases(method.results()));
  for (const answers::Method* one : limits.with_limit()) {
    const Limit& limit = *one->limit;
    if (!limit.uncertainty || limit.value == 0) continue;
    const double u = *limit.uncertainty / std::abs(limit.value) * std::abs(value);
    if (std::isfinite(u)) return u;
  }
  return std::nullopt;
}

AgreementOf::Measures AgreementOf::measures(const CaseRecord& stored, const CaseRecord& again,
                                            const RoundOff& round_off) const {
  Measures found;
  const StudyResults method = of_its_method(stored, again);
  const Choices choices(method);
  for (const std::string& name : measures_of(stored, again)) {
    const auto kept = measure(stored, name), value = measure(again, name);
    if (!kept || !value) {
      found.wrong.push_back(kept ? fmt::format("{} is stored as {}, and is not measured", name, csv_number(*kept))
                                 : fmt::format("{} is {}, and is not stored", name, csv_number(*value)));
      continue;
    }
    const MeasureInfo* info = measure_info(name);
    const double off = std::abs(*value - *kept);
    if (off <= round_off.tolerance(info ? info->unit : "", *value)) continue;
    const auto u = left_open(choices, name, *value);
    if (u && off <= *u) {
      ++found.within_u;
      found.largest = std::max(found.largest, off / *u);
      continue;
    }
    found.wrong.push_back(fmt::format("{} is {}, stored is {}; {}", name, csv_number(*value), csv_number(*kept),
                                      u ? fmt::format("u is {:.2g}", *u) : "the study says no u of it"));
  }
  return found;
}

Agreement AgreementOf::operator()(const CaseRecord& stored, const CaseRecord& again, std::string& said) const {
  if (compare(stored, again).differences.empty()) {
    said = "equal to the last bit";
    return Agreement::bits;
  }
  const RoundOff round_off(again);
  auto [wrong, within_u, largest] = measures(stored, again, round_off);
  if (stored.status != again.status)
    wrong.insert(wrong.begin(), fmt::format("it is {}, stored as {}", word(again.status), word(stored.status)));
  if (wrong.empty() && within_u > 0) {
    said = fmt::format("equal within u: {} measure{} beyond six digits, the largest difference is {:.2g} u", within_u,
                       within_u == 1 ? "" : "s", largest);
    return Agreement::within;
  }
  if (stored.steps != again.steps)
    wrong.push_back(fmt::format("it takes {} steps, stored are {}", again.steps, stored.steps));
  if (const std::string what = wrong.empty() ? apart(stored, again, round_off) : ""; !what.empty())
    wrong.push_back(what + " differs from what is stored");
  if (wrong.empty()) {
    said = "equal to six digits";
    return Agreement::digits;
  }
  constexpr std::size_t told = 3;
  said = "not equal:";
  for (std::size_t k = 0; k < std::min(told, wrong.size()); ++k) said += "\n    " + wrong[k];
  if (wrong.size() > told) said += fmt::format("\n    and {} more", wrong.size() - told);
  return Agreement::no;
}

}  // namespace ricochet
