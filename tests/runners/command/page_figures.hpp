#pragma once
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tests/runners/command/page_tables.hpp"

/// \file
/// Figures of a page that are taken from tables of studies. A comment behind a figure says where it comes from, and is
/// not seen where the page is read:
///
///     it ends at 43.117<!--= quick cases mass=consistent step=1e-5; 100 * energy_left; %.3f --> %
///
/// Three parts, separated by semicolons. First the study, the table and the rows of it: those whose columns have these
/// values, `column=value,value` being one of several, `column=` none, `column<2` and `column>2` numbers beyond it; a
/// value with spaces stands in double quotes. Then what is made of the rows, a product or quotient of numbers and
///
///     column            the value of the one row there is
///     count             how many rows there are
///     min column        and max, spread (max − min), mean, median, sum, decades (log₁₀ max/min): of those that have
///     one [column=value …]  in front of one of these: of other rows of the table, those of the first part apart
///     TABLE[…]          the same of another table of the study
///
/// Last how it is written, as printf has it; an exponent has no needless + or 0. Where that is a word, {column}, it is
/// the text of the cell.
///
/// In the head of a column, a comment holds for the whole column; the first cell of each row, "NAME, KEY VALUE, …",
/// stands for AXIS=NAME AXIS.KEY=VALUE:
///
///     | scheme<!--| family-impacts cases time --> | force<!--| mass=consistent; {contact_force_mean %.0f} N; {status}
///     --> |
///
/// Three parts again: rows, what a cell is, and what it is where the row is not done. A study that takes too long to be
/// run again has a date, <!-- run 2026-11-24 -->, in its section.
namespace ricochet::tests {

/// A page beside its tables.
struct PageFigures {
  std::string text;                ///< the page with the figures that the tables give
  std::vector<std::string> wrong;  ///< where it has others: a sentence each, with line, study, table, rows and column
  int figures = 0;                 ///< that were compared
};
/// Of the figures of these studies; of all where none is named.
PageFigures compare_page(const std::string& page, const TablesOf& tables, const std::set<std::string>& studies = {});

/// The studies that a page takes figures from.
std::set<std::string> studies_of(const std::string& page);

/// The pages of studies/findings.
std::vector<std::filesystem::path> pages_of_findings(const std::filesystem::path& source);

}  // namespace ricochet::tests
