#include "runners/report/column_info.hpp"

#include <map>

#include "runners/report/case_view.hpp"

namespace ricochet::report {

ColumnInfo column_info(const std::string& name) {
  static const std::map<std::string, ColumnInfo> known = {
      {"case", {"", "Identity of the case: its row in cases.csv"}},
      {"other_case", {"", "The case that it is compared with"}},
      {"reference_case", {"", "The case that all are compared with"}},
      {"run_seconds", {"s", "Time of marching, the median over the repeats"}},
      {"seconds", {"s", "Time of marching, the median over the repeats"}},
      {"microseconds", {"µs", "Time of marching per step"}},
      {"floor", {"", "Errors below it are not told apart: how far two references differ"}},
      {"share", {"1", "Share of the variance, or of what is compared"}},
      {"low", {"", "Lower end of the interval"}},
      {"high", {"", "Upper end of the interval"}},
      {"radius", {"1", "Spectral radius of one step"}},
      {"growth", {"1", "Spectral radius less one"}},
      {"worst", {"1", "Largest radius of the states that a marched scene meets"}},
      {"order", {"1", "Fitted power of the step or of the size of an element"}},
      {"declared", {"1", "What the method says of itself"}},
      {"exponent", {"1/s", "Lyapunov exponent"}},
      {"change", {"1", "|E(T)/E(0) − 1|"}},
      {"gained", {"", "Whether the energy grew"}}};
  if (const MeasureInfo* info = measure_info(name)) return {info->unit, info->text};
  if (const std::string unit = axis_unit(name); !unit.empty()) return {unit, ""};
  const auto found = known.find(name);
  return found == known.end() ? ColumnInfo() : found->second;
}

}  // namespace ricochet::report
