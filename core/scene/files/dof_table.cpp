#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/files/csv_file.hpp>
#include <ricochet/scene/files/dof_table.hpp>
#include <ricochet/scene/files/text_file.hpp>
#include <set>

namespace ricochet {
namespace {

/// Names are words of a study and of tables.
bool is_name(std::string_view text) {
  constexpr std::size_t longest = 64;
  return !text.empty() && text.size() <= longest && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return c > ' ' && c != ',' && c != '"' && c != '/';
  });
}

// The least number from 1 that no row has.
long long first_missing(const CsvFile& file, std::size_t dof) {
  std::set<long long> known;
  for (const CsvFile::Row& row : file.rows)
    if (const auto number = whole_number(row.cells[dof])) known.insert(*number);
  long long missing = 1;
  while (known.count(missing) != 0) ++missing;
  return missing;
}

}  // namespace

DofTable read_dof_table(std::string_view content, const std::string& name) {
  const CsvFile file = read_csv(content, name);
  const std::size_t dof = file.column("dof"), node = file.column("node"), component = file.column("component"),
                    held = file.column("held");
  const std::array<std::size_t, 3> axes = {file.column("x"), file.column("y"), file.column("z")};
  const std::size_t count = file.rows.size();
  DofTable table;
  table.name = name;
  table.dofs.resize(count);
  std::map<std::pair<std::string, std::string>, int> known;
  std::map<std::string, const DofName*> nodes;
  for (const CsvFile::Row& row : file.rows) {
    const auto number = whole_number(row.cells[dof]);
    if (!number || *number < 1)
      file.fail(row, fmt::format("\"{}\" for dof; expected a whole number from 1", shortened(row.cells[dof])));
    if (static_cast<std::size_t>(*number) > count)
      file.fail(row, fmt::format("dof {} of a table of {}; expected 1 to {}, each once: {} is missing", *number, count,
                                 count, first_missing(file, dof)));
    DofName& one = table.dofs[static_cast<std::size_t>(*number) - 1];
    if (one.dof != 0) file.fail(row, fmt::format("dof {} stands a second time", *number));
    one.dof = static_cast<int>(*number);
    one.node = row.cells[node];
    one.component = row.cells[component];
    one.held = row.cells[held];
    for (const auto& [text, what] : {std::pair(&one.node, "node"), {&one.component, "component"}})
      if (!is_name(*text))
        file.fail(row, fmt::format("\"{}\" for {}; expected a word without spaces", shortened(*text), what));
    if (!one.held.empty() && !is_name(one.held))
      file.fail(row,
                fmt::format("\"{}\" for held; expected nothing, fixed or the name of a support", shortened(one.held)));
    for (std::size_t axis = 0; axis < axes.size(); ++axis) one.place[axis] = file.number(row, axes[axis]);
    const auto [first, fresh] = known.emplace(std::pair(one.node, one.component), one.dof);
    if (!fresh) file.fail(row, fmt::format("{} is dof {} and dof {}", one.text(), first->second, one.dof));
    const auto [other, new_node] = nodes.emplace(one.node, &one);
    if (!new_node && other->second->place != one.place)
      file.fail(row, fmt::format("node {} has two places; expected the same x, y, z in its rows", one.node));
  }
  // Each number is at most the count and stands once: none is missing.
  if (count == 0) throw FileError(name + " has no dofs; expected one row per row of the matrices");
  return table;
}

}  // namespace ricochet
