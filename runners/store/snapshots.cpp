#include "runners/store/snapshots.hpp"

#include <cstring>

namespace ricochet {
namespace {

template <class Whole>
std::vector<double> packed(const std::vector<Whole>& values) {
  std::vector<double> bytes((values.size() * sizeof(Whole) + sizeof(double) - 1) / sizeof(double), 0.0);
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), values.size() * sizeof(Whole));
  return bytes;
}

template <class Whole>
bool unpack(const std::vector<double>& bytes, std::size_t count, std::vector<Whole>& values) {
  if (bytes.size() * sizeof(double) < count * sizeof(Whole)) return false;
  values.resize(count);
  if (count > 0) std::memcpy(values.data(), bytes.data(), count * sizeof(Whole));
  return true;
}

}  // namespace

NumberTable table_of(const Snapshots& snapshots) {
  NumberTable table = number_table(snapshots_name, {{"shape", "", ""},
                                                    {"t", "s", ""},
                                                    {"clamp", "m", ""},
                                                    {"x", "m", ""},
                                                    {"displacement", "", ""},
                                                    {"point", "m", ""},
                                                    {"lower", "m", ""},
                                                    {"upper", "m", ""},
                                                    {"pushed", "", ""},
                                                    {"force", "", ""}});
  table.exported = false;
  table.values = {
      {snapshots.along ? 1.0 : 0.0, snapshots.metres, snapshots.newtons, static_cast<double>(snapshots.force.size())},
      snapshots.t,
      snapshots.clamp,
      snapshots.x,
      packed(snapshots.displacement),
      snapshots.point,
      snapshots.lower,
      snapshots.upper,
      packed(snapshots.pushed),
      packed(snapshots.force)};
  return table;
}

std::optional<Snapshots> snapshots_of(const NumberTable& table) {
  Snapshots out;
  const auto column = [&](const char* name) {
    const std::vector<double>* values = table.numbers(name);
    return values ? *values : std::vector<double>();
  };
  const std::vector<double> shape = column("shape");
  constexpr std::size_t shape_numbers = 4;
  if (shape.size() != shape_numbers) return std::nullopt;
  out.along = shape[0] != 0;
  out.metres = shape[1];
  out.newtons = shape[2];
  out.t = column("t");
  out.clamp = column("clamp");
  out.x = column("x");
  out.point = column("point");
  out.lower = column("lower");
  out.upper = column("upper");
  const auto forces = static_cast<std::size_t>(shape[3]);
  const bool whole = out.clamp.size() == out.t.size() && out.lower.size() == out.point.size() &&
                     out.upper.size() == out.point.size() &&
                     unpack(column("displacement"), out.t.size() * out.x.size(), out.displacement) &&
                     unpack(column("pushed"), forces, out.pushed) && unpack(column("force"), forces, out.force);
  if (!whole) return std::nullopt;
  return out;
}

}  // namespace ricochet
