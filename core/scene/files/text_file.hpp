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

/// The lines of a text: line ends LF, CRLF or CR, a byte order mark before the first is left out. UTF-16 with a byte
/// order mark is read as UTF-8, which notes() tells. `content` must outlive it. A line is at most 64 KiB, longer ones
/// throw FileError; so do zero bytes.
class TextLines {
 public:
  TextLines(std::string_view content, std::string name);
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;
  /// The next line without its end; nothing after the last.
  std::optional<std::string_view> next();
  /// Number of the line that next() gave, from 1.
  long line() const { return line_; }
  /// Bytes that follow that line.
  std::size_t left() const { return content_.size(); }
  const std::string& name() const { return name_; }
  /// What was recognised that a reader should know.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Throws FileError: "NAME, line N: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// The same of another line.
  [[noreturn]] void fail_at(long line, const std::string& what) const;

 private:
  std::string decoded_;  // of UTF-16
  std::string_view content_;
  std::string name_;
  std::vector<std::string> notes_;
  long line_ = 0;
};

/// Words of a line, separated by spaces and tabs.
std::vector<std::string_view> words_of(std::string_view line);
/// Text without spaces and tabs at its ends.
std::string_view trimmed(std::string_view text);

/// Whether a line is a comment: # or % is its first sign.
bool is_comment(std::string_view line);

/// A number as std::from_chars reads it, a + before it allowed; nothing where the text is no finite number.
std::optional<double> plain_number(std::string_view text);
/// A number with an exponent that Fortran alone writes: 1.0D+06, 1.0+006. Nothing for every other text.
std::optional<double> fortran_number(std::string_view text);
/// Either.
std::optional<double> finite_number(std::string_view text);
/// A number with its decimal comma as a point; nothing for a text that is none.
std::optional<std::string> pointed(std::string_view text);

/// Why a text is no finite number, and what was expected: "\"1,5\" has a decimal comma; expected a point". `of`: what
/// it stands for.
std::string no_number(std::string_view text, const std::string& of = "");
/// A whole number from 0; nothing where the text is none.
std::optional<long long> whole_number(std::string_view text);

/// Whether a file lies in a folder or below it, links followed. One that cannot be looked at does not.
bool lies_within(const std::filesystem::path& folder, const std::filesystem::path& file);

/// Content of `folder`/`name`. Throws FileError where it is missing (with the nearest name of the folder), is no file
/// or cannot be read. The same where it is larger than the limit: 256 MiB, or RICOCHET_FILE_LIMIT bytes, and where that
/// is no whole number.
std::string read_file(const std::filesystem::path& folder, const std::string& name);

/// A table: a header, then one row per line. Cells are separated by what separates the header: semicolons, tabs, commas
/// or blanks. They may be quoted, blanks around them are left out. Empty lines and comments say nothing.
struct CsvFile {
  struct Row {
    long line = 0;
    std::vector<std::string> cells;  ///< as many as columns
  };
  std::string name;
  std::vector<std::string> columns;  ///< as they stand in the header
  std::vector<Row> rows;
  std::vector<std::string> notes;  ///< what was recognised that a reader should know

  /// Number of a column: of that name, or of that name before a unit, "t [s]". Throws FileError with the nearest column
  /// where there is none.
  std::size_t column(const std::string& key) const;
  /// The unit in the name of a column, "" where it has none.
  std::string unit(std::size_t column) const;
  /// Throws FileError: "NAME, line N: what".
  [[noreturn]] void fail(const Row& row, const std::string& what) const;
  /// A finite number in a cell; FileError where it is none.
  double number(const Row& row, std::size_t column) const;
};

/// Reads a table. Decimal commas are read where no comma separates cells. Throws FileError for no header, a column
/// given twice, a row with too few or too many cells, with the cause where it is known.
CsvFile read_csv(std::string_view content, const std::string& name);

/// What an accelerogram in the format AT2 holds: values `step` (s) apart, the first at t = 0, in a unit ("G").
struct At2File {
  double step = 0;
  std::vector<double> values;
  std::string unit;
  std::vector<std::string> notes;
};

/// Reads one: lines of text, of which one has NPTS and DT, then so many numbers. Nothing where the file has no such
/// line. Throws FileError where DT or NPTS is missing, or the numbers are not as many.
std::optional<At2File> read_at2(std::string_view content, const std::string& name);

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
  std::vector<DofName> dofs;       ///< in the order of their numbers
  std::vector<std::string> notes;  ///< what was recognised that a reader should know
};

/// Reads a CSV with the columns dof,node,component,x,y,z,held in any order, numbers as in the file. Throws FileError
/// for dofs that are missing or stand twice, nodes with two equal components or two places, empty names.
DofTable read_dof_table(std::string_view content, const std::string& name);

/// A symmetric matrix as a file gives it.
struct FileMatrix {
  SparseMatrix matrix;             ///< both triangles, zeros left out, symmetric to the last bit
  double asymmetry = 0;            ///< largest |a_ij − a_ji| over the largest |a_ij|, averaged away
  int row = 0, column = 0;         ///< where that is, from 1
  double there = 0, across = 0;    ///< a_ij and a_ji
  std::vector<std::string> notes;  ///< what was recognised that a reader should know
};

/// What a matrix that is not symmetric would stand for, in a refusal.
inline constexpr const char* not_treated = "gyroscopic and circulatory terms are not treated";

/// The largest asymmetry that is round-off of the program that wrote the matrix.
inline constexpr double most_asymmetry = 1e-10;

/// Reads Matrix Market (coordinate or array; real or integer; symmetric or general), square, with `dofs` rows.
///
/// A general matrix is returned as ½(A + Aᵀ); whether its asymmetry is acceptable is the caller's question. Entries
/// that stand more than once are summed. Those of a symmetric file may stand on either side of the diagonal, not on
/// both. `table` and `dofs`: where the number of rows comes from. Throws FileError with file, line, what was found and
/// what was expected for every other text. That is one with other headers or sizes, entries outside or not finite, or a
/// file that ends early or late.
FileMatrix read_matrix_market(std::string_view content, const std::string& name, int dofs, const std::string& table);

}  // namespace ricochet
