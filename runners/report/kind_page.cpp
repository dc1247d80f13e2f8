#include "runners/report/kind_page.hpp"

#include <stdexcept>

#include "runners/report/assets.hpp"
#include "runners/report/effects.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {

std::vector<std::string_view> scripts(std::initializer_list<const char*> names) {
  std::vector<std::string_view> out;
  for (const std::string name : names) {
    out.push_back(asset("kinds/" + name + ".js"));
    if (out.back().empty()) throw std::logic_error("no kind has a script " + name + ".js");
  }
  return out;
}

std::vector<Table> page_tables(const StudyResults& results, const KindPage& page) {
  const CaseView view(results);
  std::vector<Table> out;
  const auto add = [&](Table table) {
    if (!find_table(results.derived, table.name) && !table.rows.empty()) out.push_back(std::move(table));
  };
  for (const auto make : page.derived) add(make(view));
  add(effects_said(view));
  return out;
}

}  // namespace ricochet::report
