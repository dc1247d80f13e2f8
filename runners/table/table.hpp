#pragma once
#include <atomic>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <ricochet/contract/worded.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

/// \file
/// What every result is before it is shown: rows of typed cells under columns that say their unit and their meaning.
namespace ricochet {

/// A text that its copies share, as wide as a pointer. A thread that makes the same short text again and again (a
/// status, a class of motion) makes it once.
class SharedWords {
 public:
  explicit SharedWords(std::string text);
  SharedWords(const SharedWords& other) noexcept : body_(other.body_) {
    if (body_) body_->owners.fetch_add(1, std::memory_order_relaxed);
  }
  SharedWords(SharedWords&& other) noexcept : body_(std::exchange(other.body_, nullptr)) {}
  SharedWords& operator=(SharedWords other) noexcept {
    std::swap(body_, other.body_);
    return *this;
  }
  ~SharedWords() {
    if (body_ && body_->owners.fetch_sub(1, std::memory_order_acq_rel) == 1) delete body_;
  }

  /// Not of one that was moved from.
  const std::string& text() const { return body_->text; }
  friend bool operator==(const SharedWords& a, const SharedWords& b) {
    return a.body_ == b.body_ || a.text() == b.text();
  }

 private:
  struct Body {
    explicit Body(std::string words) : text(std::move(words)) {}
    const std::string text;
    std::atomic<long> owners{1};
  };
  SharedWords() = default;
  friend struct RecentWords;

  Body* body_ = nullptr;
};

/// One entry of a table: nothing, a truth value, a whole number, a number or a text. Made from any of these without
/// being named, so that a row is written as it reads: {0.1, "closed", true, nullptr}. A number that is not finite is
/// nothing: no NaN reaches a row.
class Cell {
 public:
  Cell() = default;
  Cell(std::nullptr_t) {}
  Cell(std::same_as<bool> auto truth) : content_(truth) {}
  template <std::integral Whole>
  requires(!std::same_as<Whole, bool> && !std::same_as<Whole, char>) Cell(Whole whole)
      : content_(static_cast<std::int64_t>(whole)) {}
  Cell(std::floating_point auto number) {
    if (std::isfinite(number)) content_ = static_cast<double>(number);
  }
  Cell(std::string text) : content_(SharedWords(std::move(text))) {}
  Cell(const char* text) : Cell(std::string(text)) {}
  Cell(std::string_view text) : Cell(std::string(text)) {}
  explicit Cell(Worded auto value) : Cell(word(value)) {}
  /// What is absent is nothing.
  template <class Value>
  Cell(const std::optional<Value>& value) {
    if (value) *this = Cell(*value);
  }

  bool is_nothing() const { return content_.index() == 0; }
  std::optional<bool> truth() const;
  /// Nothing for what is no number at all.
  std::optional<double> number() const;
  /// Nothing for what is no whole number.
  std::optional<std::int64_t> whole() const;
  /// The words of a text; null for every other cell.
  const std::string* words() const {
    const auto* shared = std::get_if<SharedWords>(&content_);
    return shared ? &shared->text() : nullptr;
  }
  /// As it stands in a field, not quoted. Words are as they are; numbers have the shortest digits that read back as the
  /// same number. Truth values are "true" or "false"; nothing is "".
  std::string text() const;

  /// The same kind and value; a whole number equals the same number.
  friend bool operator==(const Cell& a, const Cell& b);

  /// Calls `see` with what the cell holds: std::monostate, bool, std::int64_t, double or std::string.
  template <class See>
  decltype(auto) visit(See&& see) const {
    return std::visit(
        [&](const auto& held) -> decltype(auto) {
          if constexpr (std::is_same_v<std::decay_t<decltype(held)>, SharedWords>)
            return see(held.text());
          else
            return see(held);
        },
        content_);
  }

 private:
  // A table may have a million rows: no more than a number and its kind.
  std::variant<std::monostate, bool, std::int64_t, double, SharedWords> content_;
};

using Row = std::vector<Cell>;

/// What a column holds.
struct Column {
  std::string name;
  std::string unit;  ///< SI; "1" for ratios and counts, "" for words and truth values
  std::string text;  ///< what the cells mean, one sentence
};

/// Columns in order, which their copies share: each of ten thousand cases has tables of the same columns.
class Columns {
 public:
  Columns() = default;
  Columns(std::vector<Column> columns) : shared_(std::make_shared<std::vector<Column>>(std::move(columns))) {}
  Columns(std::initializer_list<Column> columns) : Columns(std::vector<Column>(columns)) {}

  const std::vector<Column>& get() const;
  operator const std::vector<Column>&() const { return get(); }
  std::size_t size() const { return get().size(); }
  bool empty() const { return get().empty(); }
  const Column& operator[](std::size_t place) const { return get()[place]; }
  const Column& at(std::size_t place) const { return get().at(place); }
  const Column& front() const { return get().front(); }
  const Column& back() const { return get().back(); }
  std::vector<Column>::const_iterator begin() const { return get().begin(); }
  std::vector<Column>::const_iterator end() const { return get().end(); }

  /// To be changed: its own, and no longer shared.
  std::vector<Column>& own();
  void push_back(Column column) { own().push_back(std::move(column)); }
  /// Whether both are copies of one, neither changed since.
  bool same(const Columns& other) const { return shared_ == other.shared_; }

 private:
  std::shared_ptr<std::vector<Column>> shared_;
};

/// The column that names a case, the key of cases.csv.
inline constexpr char case_name[] = "case";

/// Columns of these names that say nothing more of themselves: what was read back and is still to be described.
std::vector<Column> named_columns(const std::vector<std::string>& names);

/// The columns of `first`, then those of `then`.
std::vector<Column> joined(std::vector<Column> first, const std::vector<Column>& then);

/// Rows under columns; as a file, NAME.csv.
struct Table {
  std::string name;
  std::string text;  ///< what a row stands for, one sentence
  Columns columns;
  std::vector<Row> rows;  ///< each as long as `columns`
};

/// Where the column of this name stands; nothing where the table has none.
std::optional<std::size_t> find_column(const std::vector<Column>& columns, std::string_view name);

/// Takes unit and meaning of each column from those that are declared; a column that is not stays as it is.
void describe(Columns& columns, const Columns& declared);
/// The same for a whole table, with what its rows stand for.
void describe(Table& table, const Table& declared);

}  // namespace ricochet
