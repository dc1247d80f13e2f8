#pragma once
#include <string>

#include "runners/report/case_view.hpp"
#include "runners/store/record.hpp"

namespace ricochet::report {

/// All cases with status, reason and every measure: sortable, filterable; units in the header, the measure's text as
/// its tooltip and in a list below. `all`: results of which the view may hold a part; they decide whether there are
/// files of curves.
std::string case_table_html(const CaseView& view, const StudyResults& all);

/// What `compile` left out of the cases, the same item and reason put together.
std::string left_out_html(const CaseView& view);

/// The notes of the cases, put together.
std::string notes_html(const CaseView& view);

/// Compiler, processor, libraries, and the resolved study.
std::string environment_html(const CaseView& view);

/// The derived tables of the results as folded HTML tables that a click on a header sorts; the first rows of each, and
/// how many more its CSV file has. Empty where nothing was derived.
std::string derived_tables_html(const StudyResults& results);

}  // namespace ricochet::report
