#pragma once
#include <string>
#include <utility>
#include <vector>

#include "runners/table/number_table.hpp"

namespace ricochet {

/// The columns of a table of numbers, each with the member of `Columns` (const Series*) that it fills. The one
/// declaration makes empty tables and finds the columns of stored ones.
template <class Columns>
class NumberType {
 public:
  /// `text`: what a row stands for. Not exported: for the report and for going on, no CSV.
  explicit NumberType(std::string name, std::string text = "", bool exported = true)
      : head_{std::move(name), {}, {}, {}, exported, std::move(text)} {}
  /// Without a member: a column that nobody reads back.
  NumberType& add(Column column, const Series* Columns::*member = nullptr) {
    head_.columns.push_back(std::move(column));
    members_.push_back(member);
    return *this;
  }

  const std::string& name() const { return head_.name; }
  /// Without rows.
  NumberTable head() const {
    NumberTable table = number_table(head_.name, head_.columns);
    table.exported = head_.exported;
    table.text = head_.text;
    return table;
  }
  const NumberTable* find(const std::vector<NumberTable>& tables) const { return find_table(tables, head_.name); }
  /// Those that the table lacks are null. They last as long as the table.
  Columns read(const NumberTable& table) const {
    Columns found;
    for (std::size_t k = 0; k < members_.size(); ++k)
      if (members_[k]) found.*members_[k] = table.series(head_.columns[k].name);
    return found;
  }

 private:
  NumberTable head_;
  std::vector<const Series * Columns::*> members_;
};

}  // namespace ricochet
