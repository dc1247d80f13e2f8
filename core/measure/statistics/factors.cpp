#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ricochet/measure/statistics/effects.hpp>
#include <set>

namespace ricochet {
namespace {

/// "time" of "time.beta" where there is such a column; else the column itself.
std::string role_of(const std::string& column, const std::vector<std::string>& columns) {
  const std::string prefix = column.substr(0, column.find('.'));
  return std::find(columns.begin(), columns.end(), prefix) == columns.end() ? column : prefix;
}

using CellRows = std::vector<std::vector<std::string>>;

std::size_t distinct(const CellRows& cells, const std::vector<std::size_t>& columns) {
  std::set<std::vector<std::string>> seen;
  for (const auto& cell : cells) {
    std::vector<std::string> key;
    for (const std::size_t k : columns) key.push_back(cell[k]);
    seen.insert(std::move(key));
  }
  return seen.size();
}

/// Whether the parameter does not exist, or does not take all its values, for every method.
bool nested(const CellRows& cells, std::size_t method, std::size_t parameter) {
  for (const auto& cell : cells)
    if (cell[parameter].empty()) return true;
  return distinct(cells, {method, parameter}) < distinct(cells, {method}) * distinct(cells, {parameter});
}

Factor factor_of(const std::string& name, const std::vector<std::size_t>& group,
                 const std::vector<std::string>& columns, const CellRows& cells) {
  Factor out{name, {}, {}};
  std::map<std::string, std::size_t> place;
  for (const auto& cell : cells) {
    std::string text = cell[group.front()];
    for (std::size_t k = 1; k < group.size(); ++k)
      if (const std::string& value = cell[group[k]]; !value.empty())
        text += fmt::format(", {} {}", columns[group[k]].substr(columns[group[k]].find('.') + 1), value);
    const auto [found, fresh] = place.emplace(text, out.levels.size());
    if (fresh) out.levels.push_back(text);
    out.level.push_back(found->second);
  }
  return out;
}

}  // namespace

FactorSet factors_of(const std::vector<std::string>& columns, const CellRows& cells) {
  std::vector<std::vector<std::size_t>> groups(columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (role_of(columns[k], columns) == columns[k]) groups[k].push_back(k);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::string role = role_of(columns[k], columns);
    const auto method = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), role) - columns.begin());
    if (method == k) continue;
    groups[nested(cells, method, k) ? method : k].push_back(k);
  }
  FactorSet out;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (groups[k].empty()) continue;
    out.factors.push_back(factor_of(columns[k], groups[k], columns, cells));
    const auto& levels = out.factors.back().levels;
    if (levels.size() == distinct(cells, {k})) continue;
    std::vector<std::string> names;
    for (std::size_t j = 1; j < groups[k].size(); ++j) names.push_back(columns[groups[k][j]]);
    out.notes.push_back(fmt::format("{0} stands for {0} with {1}, which {2} not vary freely beside it: {3}", columns[k],
                                    fmt::join(names, " and "), names.size() == 1 ? "does" : "do",
                                    fmt::join(levels, "; ")));
  }
  return out;
}

}  // namespace ricochet
