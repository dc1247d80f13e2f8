#pragma once
#include <bit>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <vector>

#include "runners/table/table.hpp"

namespace ricochet {

/// Whether two numbers are bitwise equal: a NaN is what it is, 0 is not −0.
inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Numbers in order. Those of a stored result are read when they are asked for: from several threads, too; copies share
/// what was read. Reading throws what their source throws.
class Series {
 public:
  /// Where numbers come from, in pieces of `piece` numbers each, the last one shorter.
  struct Source {
    std::size_t size = 0, piece = 0;
    std::function<std::vector<double>(std::size_t number)> read;  ///< a piece, from 0
  };

  Series() = default;
  Series(std::vector<double> values) : values_(std::move(values)) {}
  Series(std::initializer_list<double> values) : values_(values) {}
  explicit Series(Source source);

  std::size_t size() const;
  bool empty() const { return size() == 0; }
  /// All of them, kept from then on.
  const std::vector<double>& get() const;
  /// All of them, for as long as the caller holds them.
  std::shared_ptr<const std::vector<double>> share() const;
  operator const std::vector<double>&() const { return get(); }
  double operator[](std::size_t place) const { return get()[place]; }
  double front() const { return get().front(); }
  double back() const { return get().back(); }
  std::vector<double>::const_iterator begin() const { return get().begin(); }
  std::vector<double>::const_iterator end() const { return get().end(); }
  /// One of them: where they have not been read, its piece is, and kept until another one is.
  double at(std::size_t place) const;
  /// Calls `use(place, number)` for all of them in order, without keeping what is read for it.
  template <class Use>
  void each(Use use) const {
    std::size_t first = 0;
    for (std::size_t place = 0; place < size();)
      for (const Piece piece = piece_at(place, first); place - first < piece->size(); ++place)
        use(place, (*piece)[place - first]);
  }

  /// To be changed: its own, and no longer shared.
  std::vector<double>& own();
  void push_back(double value) { own().push_back(value); }

  friend bool operator==(const Series& a, const Series& b) { return a.get() == b.get(); }

 private:
  using Piece = std::shared_ptr<const std::vector<double>>;
  struct Later;
  /// The piece of this place, or all of them, and the place of its first.
  Piece piece_at(std::size_t place, std::size_t& first) const;

  std::vector<double> values_;
  std::shared_ptr<Later> later_;
};

/// Many numbers in columns of equal length, as they stand in NAME.csv behind the axes of their case: sections, impacts.
/// NaN is an absent number (an empty field).
struct NumberTable {
  std::string name;
  Columns columns;
  std::vector<Series> values;  ///< of each of the columns
  /// Columns that hold words: column name, and the words; the numbers are indices into them.
  std::vector<std::pair<std::string, std::vector<std::string>>> words = {};
  bool exported = true;   ///< false: for the report and for going on, not written as CSV
  std::string text = {};  ///< what a row stands for, one sentence

  std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
  /// Appends a row, a number for each column.
  void add(std::initializer_list<double> row);
  /// A column; null where the table has none of this name.
  const Series* series(std::string_view column) const;
  /// All numbers of a column; null where the table has no such column.
  const std::vector<double>* numbers(std::string_view column) const;
  /// What the numbers of a column stand for; null where they stand for themselves.
  const std::vector<std::string>* words_of(std::string_view column) const;
};

/// An empty table of these columns.
NumberTable number_table(std::string name, Columns columns);

/// The table of this name; null where there is none.
const NumberTable* find_table(const std::vector<NumberTable>& tables, std::string_view name);

}  // namespace ricochet
