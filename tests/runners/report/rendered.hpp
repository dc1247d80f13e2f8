#pragma once
#include <string>

#include "runners/kinds/kind.hpp"
#include "runners/report/page.hpp"

namespace ricochet::synthetic {

/// Results with the tables that their kind's page derives, as a run leaves them.
inline StudyResults with_page_tables(StudyResults results) {
  for (Table& table : report::page_tables(results, page_of(results.kind))) results.derived.push_back(std::move(table));
  return results;
}

inline std::string rendered(const StudyResults& results, std::string_view library, std::string_view version) {
  return report::render_page(with_page_tables(results), page_of(results.kind), library, version);
}

}  // namespace ricochet::synthetic
