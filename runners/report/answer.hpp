#pragma once
#include <string>

#include "runners/report/case_view.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {

/// A row of the table `energy_trends` in words.
std::string trend_sentence(const TableReader& trends, size_t row);

/// Whether nothing but contact changes the energy of the finished cases: then its start is the reference.
bool conservative(const CaseView& view);

/// The section "Answer" as HTML: sentences and tables made of measured figures only.
std::string answer_html(const CaseView& view);

}  // namespace ricochet::report
