#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/files/text_file.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace ricochet {
namespace {

struct MatrixEntry {
  int row = 0, column = 0;
  long line = 0;
  double value = 0;
  bool above = false;  // where the file is symmetric: given above the diagonal
};

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

class MatrixReader {
 public:
  MatrixReader(std::string_view content, const std::string& name, int dofs, const std::string& table)
      : lines_(content, name), dofs_(dofs), table_(table) {}

  FileMatrix read() {
    read_header();
    read_sizes();
    if (coordinate_)
      read_entries();
    else
      read_array();
    if (const auto line = content_line())
      lines_.fail(fmt::format("\"{}\" after the last of {} entries", shortened(*line), count_));
    FileMatrix out = assemble();
    say_what_was_met(out);
    return out;
  }

 private:
  void read_header() {
    const auto line = content_line([](std::string_view text) {
      return text.starts_with("%%") || lower_case(text).find("matrixmarket") != std::string::npos;
    });
    const std::string expected =
        "; expected %%MatrixMarket matrix, coordinate or array, real or integer, symmetric or general";
    if (!line) throw FileError(lines_.name() + " is empty" + expected);
    const std::vector<std::string_view> words = words_of(*line);
    std::vector<std::string> lower;
    for (const std::string_view word : words) lower.push_back(lower_case(word));
    const bool right = lower.size() == 5 && lower[0] == "%%matrixmarket" && lower[1] == "matrix" &&
                       (lower[2] == "coordinate" || lower[2] == "array") &&
                       (lower[3] == "real" || lower[3] == "integer") &&
                       (lower[4] == "symmetric" || lower[4] == "general");
    if (!right) {
      const bool skew = !lower.empty() && lower.back() == "skew-symmetric";
      lines_.fail("\"" + shortened(*line) + "\"" + expected + (skew ? std::string(": ") + not_treated : ""));
    }
    comments_ = 0;  // after it they are usual up to the sizes
    coordinate_ = lower[2] == "coordinate";
    symmetric_ = lower[4] == "symmetric";
  }

  /// The next line that says something and is no comment, or is one that is looked for.
  std::optional<std::string_view> content_line(bool (*wanted)(std::string_view) = nullptr) {
    while (const auto line = lines_.next()) {
      const std::string_view text = trimmed(*line);
      if (text.empty()) continue;
      if (!is_comment(text) || (wanted && wanted(text))) return text;
      ++comments_;
    }
    return std::nullopt;
  }

  void read_sizes() {
    const auto line = content_line();
    if (!line) throw FileError(lines_.name() + " ends before its sizes");
    comments_ = 0;
    const std::vector<std::string_view> words = words_of(*line);
    std::vector<long long> sizes;
    for (const std::string_view word : words)
      if (const auto size = whole_number(word)) sizes.push_back(*size);
    if (sizes.size() != words.size() || sizes.size() != (coordinate_ ? 3U : 2U))
      lines_.fail(fmt::format("\"{}\"; expected rows, columns{}", shortened(*line),
                              coordinate_ ? " and number of entries" : ""));
    if (sizes[0] != dofs_ || sizes[1] != dofs_)
      throw FileError(fmt::format("{} is {} × {}; expected {} × {}, the dofs of {}", lines_.name(), sizes[0], sizes[1],
                                  dofs_, dofs_, table_));
    const long long n = dofs_;
    count_ = coordinate_ ? sizes[2] : symmetric_ ? n * (n + 1) / 2 : n * n;
    // Before memory is taken: an entry has at least that many bytes.
    const std::size_t shortest = coordinate_ ? 5 : 1;
    if (static_cast<unsigned long long>(count_) > lines_.left() / shortest + 1)
      throw FileError(fmt::format("{}, line {}: {} entries in the {} bytes that follow", lines_.name(), lines_.line(),
                                  count_, lines_.left()));
    entries_.reserve(static_cast<std::size_t>(count_));
  }

  [[noreturn]] void fail_short(long long found) const {
    lines_.fail(fmt::format("end of file after {} of {} entries", found, count_));
  }

  double value_of(std::string_view word) {
    if (const auto value = plain_number(word)) return *value;
    const auto value = fortran_number(word);
    if (!value) lines_.fail(no_number(word));
    if (fortran_++ == 0) first_fortran_ = word;
    return *value;
  }

  int index_of(std::string_view word, const char* what) const {
    const auto index = whole_number(word);
    if (!index) lines_.fail(fmt::format("\"{}\"; expected a {}, 1 to {}", shortened(word), what, dofs_));
    if (*index < 1 || *index > dofs_) lines_.fail(fmt::format("{} {} of a matrix of {}", what, *index, dofs_));
    return static_cast<int>(*index) - 1;
  }

  void add(int row, int column, double value) {
    const bool above = symmetric_ && column > row;
    if (above) std::swap(row, column);
    above_ += above ? 1 : 0;
    entries_.push_back({row, column, lines_.line(), value, above});
  }

  void read_entries() {
    for (long long k = 0; k < count_; ++k) {
      const auto line = content_line();
      if (!line) fail_short(k);
      const std::vector<std::string_view> words = words_of(*line);
      if (words.size() != 3) lines_.fail(fmt::format("\"{}\"; expected row, column and value", shortened(*line)));
      const int row = index_of(words[0], "row"), column = index_of(words[1], "column");
      add(row, column, value_of(words[2]));
    }
  }

  /// Column by column; of a symmetric matrix from the diagonal down.
  void read_array() {
    long long found = 0;
    for (int column = 0; column < dofs_; ++column)
      for (int row = symmetric_ ? column : 0; row < dofs_; ++row, ++found) {
        const auto line = content_line();
        if (!line) fail_short(found);
        add(row, column, value_of(*line));
      }
  }

  FileMatrix assemble() {
    std::sort(entries_.begin(), entries_.end(), [](const MatrixEntry& a, const MatrixEntry& b) {
      return std::tie(a.row, a.column, a.line) < std::tie(b.row, b.column, b.line);
    });
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(entries_.size() * (symmetric_ ? 2 : 1));
    for (std::size_t k = 0; k < entries_.size();) {
      const MatrixEntry& first = entries_[k];
      double value = 0;
      std::size_t same = 0;
      for (; k < entries_.size() && entries_[k].row == first.row && entries_[k].column == first.column; ++k, ++same) {
        value += entries_[k].value;
        if (entries_[k].above != first.above)
          lines_.fail_at(entries_[k].line,
                         fmt::format("entries {0}, {1} and {1}, {0} both stand in a symmetric file; expected one of "
                                     "the triangles, or general in its first line",
                                     first.row + 1, first.column + 1));
      }
      if (same > 1 && summed_++ == 0) first_summed_ = fmt::format("{}, {}", first.row + 1, first.column + 1);
      if (!std::isfinite(value))
        lines_.fail_at(first.line,
                       fmt::format("the sum of entries {}, {} is not finite", first.row + 1, first.column + 1));
      if (value == 0) continue;
      triplets.emplace_back(first.row, first.column, value);
      if (symmetric_ && first.row != first.column) triplets.emplace_back(first.column, first.row, value);
    }
    FileMatrix out;
    SparseMatrix read(dofs_, dofs_);
    read.setFromTriplets(triplets.begin(), triplets.end());
    if (!symmetric_) {
      const SparseMatrix across = read.transpose();
      const SparseMatrix difference = read - across;
      const double largest = read.nonZeros() > 0 ? read.coeffs().abs().maxCoeff() : 0;
      double worst = 0;
      for (int j = 0; j < difference.outerSize(); ++j)
        for (SparseMatrix::InnerIterator it(difference, j); it; ++it)
          if (it.row() > it.col() && std::abs(it.value()) > worst) {
            worst = std::abs(it.value());
            out.row = static_cast<int>(it.row()) + 1;
            out.column = static_cast<int>(it.col()) + 1;
          }
      if (worst > 0) {
        out.asymmetry = worst / largest;
        out.there = read.coeff(out.row - 1, out.column - 1);
        out.across = read.coeff(out.column - 1, out.row - 1);
        read = 0.5 * (read + across);
      }
    }
    read.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0; });
    read.makeCompressed();
    out.matrix = std::move(read);
    return out;
  }

  void say_what_was_met(FileMatrix& out) const {
    out.notes = lines_.notes();
    const auto say = [&](const std::string& what) { out.notes.push_back(lines_.name() + ": " + what); };
    if (comments_ > 0) say(fmt::format("comments among its entries are left out (lines: {})", comments_));
    if (fortran_ > 0)
      say(fmt::format("exponents of Fortran are read, as {} (entries: {})", shortened(first_fortran_), fortran_));
    if (above_ > 0)
      say(fmt::format("entries of a symmetric file above its diagonal stand for both triangles (entries: {})", above_));
    if (summed_ > 0)
      say(fmt::format("values of an entry that stands more than once are summed, as of {} (entries: {})", first_summed_,
                      summed_));
  }

  TextLines lines_;
  int dofs_;
  const std::string& table_;
  bool coordinate_ = true, symmetric_ = true;
  long long count_ = 0;
  long comments_ = 0, fortran_ = 0, above_ = 0, summed_ = 0;
  std::string first_fortran_, first_summed_;
  std::vector<MatrixEntry> entries_;
};

}  // namespace

FileMatrix read_matrix_market(std::string_view content, const std::string& name, int dofs, const std::string& table) {
  return MatrixReader(content, name, dofs, table).read();
}

}  // namespace ricochet
