#include "tests/runners/report/rendered.hpp"

#include "runners/report/report.hpp"
#include "runners/run/analysed_results.hpp"

namespace ricochet::synthetic {

StudyResults with_page_tables(StudyResults results) {
  const AnalysedResults own(results);
  for (Table& table : report::page_tables(results, own.analysis.page)) results.derived.push_back(std::move(table));
  return results;
}

std::string rendered(const StudyResults& results, std::string_view library, std::string_view version) {
  const AnalysedResults own(results);
  return report::render_page(with_page_tables(results), own.analysis.page, library, version);
}

}  // namespace ricochet::synthetic
