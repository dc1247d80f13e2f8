#pragma once
#include "runners/report/kind_page.hpp"
#include "runners/table/table_reader.hpp"

/// \file
/// What a report of kind `trajectory` shows: energies over time and at the end.
namespace ricochet::report {

KindPage trajectory_page();

/// What the energy of each case ends at, told from its start: |E(T)/E(0) − 1|, whether it was a gain, and whether
/// nothing but contact changes energies in this study.
Table energy_changes(const CaseView& view);

/// A row of the table `energy_trends` in words.
std::string trend_sentence(const TableReader& trends, size_t row);

/// Whether nothing but contact changes the energy of the finished cases: then its start is the reference.
bool conservative(const CaseView& view);

/// Who kept, lost or gained energy: one sentence per mass matrix, methods × steps, what each choice is worth.
std::string energy_answer(const CaseView& view);

}  // namespace ricochet::report
