#include "runners/table/number_table.hpp"

#include <algorithm>
#include <limits>
#include <mutex>

namespace ricochet {

struct Series::Later {
  static constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

  Source source;
  std::mutex mutex;
  Piece all, last;  // null: not read
  std::size_t number = nowhere;

  Piece whole(bool keep) {
    const std::lock_guard guard(mutex);
    if (all) return all;
    auto read = std::make_shared<std::vector<double>>();
    read->reserve(source.size);
    for (std::size_t k = 0; k * source.piece < source.size; ++k) {
      const std::vector<double> more = source.read(k);
      read->insert(read->end(), more.begin(), more.end());
    }
    if (!keep) return read;
    last.reset();
    number = nowhere;
    return all = std::move(read);
  }
  // Of what is read whole all of it, and then `first` is where it begins.
  Piece piece(std::size_t wanted, bool keep, std::size_t& first) {
    const std::lock_guard guard(mutex);
    first = all ? 0 : wanted * source.piece;
    if (all) return all;
    if (wanted == number) return last;
    auto read = std::make_shared<const std::vector<double>>(source.read(wanted));
    if (!keep) return read;
    last = read;
    number = wanted;
    return read;
  }
};

Series::Series(Source source) : later_(std::make_shared<Later>()) {
  later_->source = std::move(source);
}

std::size_t Series::size() const {
  return later_ ? later_->source.size : values_.size();
}

const std::vector<double>& Series::get() const {
  return later_ ? *later_->whole(true) : values_;
}

Series::Piece Series::share() const {
  return later_ ? later_->whole(false) : Piece(Piece(), &values_);
}

double Series::at(std::size_t place) const {
  if (!later_) return values_.at(place);
  std::size_t first = 0;
  const Piece piece = later_->piece(place / later_->source.piece, true, first);
  return piece->at(place - first);
}

Series::Piece Series::piece_at(std::size_t place, std::size_t& first) const {
  first = 0;
  return later_ ? later_->piece(place / later_->source.piece, false, first) : Piece(Piece(), &values_);
}

std::vector<double>& Series::own() {
  if (later_) {
    values_ = get();
    later_.reset();
  }
  return values_;
}

void NumberTable::add(std::initializer_list<double> row) {
  std::size_t column = 0;
  for (const double value : row) values.at(column++).push_back(value);
}

const Series* NumberTable::series(std::string_view column) const {
  const auto place = find_column(columns, column);
  return place && *place < values.size() ? &values[*place] : nullptr;
}

const std::vector<double>* NumberTable::numbers(std::string_view column) const {
  const Series* found = series(column);
  return found ? &found->get() : nullptr;
}

const std::vector<std::string>* NumberTable::words_of(std::string_view column) const {
  const auto found = std::find_if(words.begin(), words.end(), [&](const auto& one) { return one.first == column; });
  return found == words.end() ? nullptr : &found->second;
}

NumberTable number_table(std::string name, Columns columns) {
  NumberTable table;
  table.name = std::move(name);
  table.values.resize(columns.size());
  table.columns = std::move(columns);
  return table;
}

const NumberTable* find_table(const std::vector<NumberTable>& tables, std::string_view name) {
  const auto found =
      std::find_if(tables.begin(), tables.end(), [&](const NumberTable& table) { return table.name == name; });
  return found == tables.end() ? nullptr : &*found;
}

}  // namespace ricochet
