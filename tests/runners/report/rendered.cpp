#include "tests/runners/report/rendered.hpp"

#include "runners/kinds/kind.hpp"
#include "runners/report/report.hpp"

namespace ricochet::synthetic {
namespace {

/// What the kind makes of the cases of results, whatever their tables say.
struct OwnAnalysis {
  explicit OwnAnalysis(const StudyResults& results) : own(results), study(own) {
    own.derived.clear();
    // Sections are long, and only basins are told by them on their page.
    if (own.kind != "basins")
      for (CaseRecord& record : own.cases) record.numbers.clear();
    analysis = find_kind(own.kind)->analysis(own, study);
  }
  StudyResults own;
  Choices study;
  Analysis analysis;
};

StudyResults with_tables_of(const report::KindPage& page, StudyResults results) {
  for (Table& table : report::page_tables(Choices(results), page)) results.derived.push_back(std::move(table));
  return results;
}

}  // namespace

StudyResults with_page_tables(StudyResults results) {
  const OwnAnalysis own(results);
  return with_tables_of(own.analysis.page, std::move(results));
}

std::string rendered(const StudyResults& results) {
  const OwnAnalysis own(results);
  const StudyResults with_tables = with_tables_of(own.analysis.page, results);
  return render_report(Choices(with_tables), own.analysis.page);
}

}  // namespace ricochet::synthetic
