#include "runners/kinds/sweep/stored_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <ricochet/measure/orbits/regime.hpp>

#include "runners/table/csv_text.hpp"

namespace ricochet {
namespace {

constexpr int default_periods = 8, default_samples = 200;
constexpr std::size_t neighbours = 5;
constexpr double same_value = 1e-9;  // relative

}  // namespace

const Table& stored_table(const CaseRecord& record, const std::string& name) {
  if (const Table* table = find_table(record.tables, name)) return *table;
  throw PointRefused(fmt::format("the case {} has no {}: it is {}{}", record.id, name, record.status,
                                 record.reason.empty() ? "" : ", " + record.reason));
}

std::string stored_regime(const TableReader& rows, std::size_t row) {
  const std::string name = rows.text(row, "class");
  const auto motion = motion_class(name, rows.number(row, "period"));
  return motion ? text(*motion) : name;
}

SamplePrinter::SamplePrinter(std::ostream& out) : out_(out) {
  out_ << "t,tip_displacement,tip_velocity\n";
}

void SamplePrinter::operator()(const PointSample& sample) {
  out_ << csv_number(sample.time) << ',' << csv_number(sample.displacement) << ',' << csv_number(sample.velocity)
       << '\n';
}

SampleCount wanted_count(const PointRequest& asked) {
  return {asked.periods > 0 ? asked.periods : default_periods, asked.samples > 0 ? asked.samples : default_samples};
}

std::string comparison_text(std::size_t equal, std::size_t compared) {
  if (compared == 0) return "";
  return fmt::format("; {} of {} strobes as stored{}", equal, compared,
                     equal < compared ? ": the results are of another build of the program" : "");
}

std::string nearest_values(const std::vector<double>& values, double wanted) {
  std::vector<double> near = values;
  std::stable_sort(near.begin(), near.end(),
                   [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); });
  near.resize(std::min(near.size(), neighbours));
  std::sort(near.begin(), near.end());
  std::vector<std::string> named;
  for (const double value : near) named.push_back(csv_number(value));
  return fmt::format("{}", fmt::join(named, ", "));
}

bool is_value(double stored, double wanted) {
  return std::abs(stored - wanted) <= same_value * std::max(std::abs(stored), std::abs(wanted));
}

}  // namespace ricochet
