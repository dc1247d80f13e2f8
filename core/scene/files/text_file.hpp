#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <ricochet/contract/mass_strategy.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Text files of numbers that a study names. Nothing here prints, and nothing depends on a locale.
namespace ricochet {

/// What is wrong with a file: "K.mtx, line 7: row 99 of a matrix of 98".
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The lines of a text: line ends LF or CRLF, a byte order mark before the first is left out. `content` must outlive
/// it. A line is at most 64 KiB, longer ones throw FileError.
class TextLines {
 public:
  TextLines(std::string_view content, std::string name);
  /// The next line without its end; nothing after the last.
  std::optional<std::string_view> next();
  /// Number of the line that next() gave, from 1.
  long line() const { return line_; }
  /// Bytes that follow that line.
  std::size_t left() const { return content_.size(); }
  const std::string& name() const { return name_; }
  /// Throws FileError: "NAME, line N: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// The same of another line.
  [[noreturn]] void fail_at(long line, const std::string& what) const;

 private:
  std::string_view content_;
  std::string name_;
  long line_ = 0;
};

/// Words of a line, separated by spaces and tabs.
std::vector<std::string_view> words_of(std::string_view line);
/// Text without spaces and tabs at its ends.
std::string_view trimmed(std::string_view text);

/// A number as std::from_chars reads it, a + before it allowed; nothing where the text is no finite number.
std::optional<double> finite_number(std::string_view text);
/// A whole number from 0; nothing where the text is none.
std::optional<long long> whole_number(std::string_view text);

/// Content of `folder`/`name`. Throws FileError where it is missing (with the nearest name of the folder), is no file
/// or cannot be read. The same where it is larger than the limit: 2 GiB, or RICOCHET_FILE_LIMIT bytes.
std::string read_file(const std::filesystem::path& folder, const std::string& name);

/// A table in CSV: a header, then one row per line, cells separated by commas, spaces around them left out, no quotes.
/// Empty lines say nothing.
struct CsvFile {
  struct Row {
    long line = 0;
    std::vector<std::string> cells;  ///< as many as columns
  };
  std::string name;
  std::vector<std::string> columns;
  std::vector<Row> rows;

  /// Number of a column. Throws FileError with the nearest column where there is none.
  std::size_t column(const std::string& key) const;
  /// Throws FileError: "NAME, line N: what".
  [[noreturn]] void fail(const Row& row, const std::string& what) const;
  /// A finite number in a cell; FileError where it is none.
  double number(const Row& row, std::size_t column) const;
};

/// Reads a table. Throws FileError for no header, a column given twice, a row with too few or too many cells, quotes.
CsvFile read_csv(std::string_view content, const std::string& name);

/// What one row and column of the matrices stands for.
struct DofName {
  int dof = 0;  ///< number in the file, from 1
  std::string node, component;
  std::array<double, 3> place{};  ///< x, y, z of the node, m
  std::string held;               ///< "" free, "fixed" at rest, else the name of the support that moves it

  bool rotation() const { return component == "rx" || component == "ry" || component == "rz"; }
  bool translation() const { return component == "ux" || component == "uy" || component == "uz"; }
  /// "N3 uy".
  std::string text() const { return node + " " + component; }
};

/// A table of dofs.
struct DofTable {
  std::string name;
  std::vector<DofName> dofs;  ///< in the order of their numbers
};

/// Reads a CSV with the columns dof,node,component,x,y,z,held in any order, numbers as in the file. Throws FileError
/// for dofs that are missing or stand twice, nodes with two equal components or two places, empty names.
DofTable read_dof_table(std::string_view content, const std::string& name);

/// A symmetric matrix as a file gives it.
struct FileMatrix {
  SparseMatrix matrix;           ///< both triangles, zeros left out, symmetric to the last bit
  double asymmetry = 0;          ///< largest |a_ij − a_ji| over the largest |a_ij|, averaged away
  int row = 0, column = 0;       ///< where that is, from 1
  double there = 0, across = 0;  ///< a_ij and a_ji
};

/// The largest asymmetry that is round-off of the program that wrote the matrix.
inline constexpr double most_asymmetry = 1e-10;

/// Reads Matrix Market (coordinate or array; real or integer; symmetric or general), square, with `dofs` rows.
///
/// A general matrix is returned as ½(A + Aᵀ); whether its asymmetry is acceptable is the caller's question. `table` and
/// `dofs`: where the number of rows comes from. Throws FileError with file, line, what was found and what was expected
/// for every other text. That is one with other headers or sizes, entries outside, twice or not finite, or a file that
/// ends early or late.
FileMatrix read_matrix_market(std::string_view content, const std::string& name, int dofs, const std::string& table);

}  // namespace ricochet
