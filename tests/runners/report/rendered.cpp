#include "tests/runners/report/rendered.hpp"

#include "runners/kinds/kind.hpp"
#include "runners/report/report.hpp"

namespace ricochet::synthetic {

StudyResults with_page_tables(StudyResults results) {
  for (Table& table : report::page_tables(results, page_of(results.kind))) results.derived.push_back(std::move(table));
  return results;
}

std::string rendered(const StudyResults& results, std::string_view library, std::string_view version) {
  return report::render_page(with_page_tables(results), page_of(results.kind), library, version);
}

}  // namespace ricochet::synthetic
