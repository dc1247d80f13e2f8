#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// \file
/// Rows of tables, and what is made of them; how both are asked for stands in page_figures.hpp.
namespace ricochet::tests {

/// A table as CSV has it.
struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};
CsvTable read_csv(const std::string& text);

/// The tables of studies, by the names of both. May throw std::runtime_error.
using TablesOf = std::function<const CsvTable&(const std::string& study, const std::string& table)>;

/// The CSV files that studies have in folder/STUDY, where `make`(study) puts them when they are not there yet.
TablesOf tables_in(const std::filesystem::path& folder, std::function<void(const std::string& study)> make);

/// Pieces between `separator`s that are not within quotes or brackets.
std::vector<std::string> pieces_of(const std::string& text, char separator);
std::vector<std::string> words_of(const std::string& text);
std::string trimmed(const std::string& text);

/// Rows of a table of a study.
struct Source {
  std::string study, table;
  std::vector<std::string> conditions;
};
/// "STUDY TABLE column=value …".
Source source_of(const std::string& text);

/// What an expression makes of the rows. Throws std::runtime_error.
double value_of(const TablesOf& tables, const Source& source, const std::string& expression);
/// The text of a column of the one row.
std::string text_of(const TablesOf& tables, const Source& source, const std::string& column);
/// A pattern with the values of its {expression %format} and {column}.
std::string filled(const TablesOf& tables, const Source& source, const std::string& pattern);
/// As printf writes it, an exponent without + and leading 0.
std::string written(double value, const std::string& format);

}  // namespace ricochet::tests
