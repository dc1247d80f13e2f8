#include "runners/table/number_table.hpp"

#include <catch2/catch.hpp>
#include <numeric>

using namespace ricochet;

namespace {

constexpr std::size_t count = 10, piece = 4;

/// 0, 1, … in pieces of four, with how often each piece was read.
struct Counted {
  std::vector<int> reads = std::vector<int>(3);
  Series series() {
    return Series(Series::Source{count, piece, [this](std::size_t number) {
                                   ++reads.at(number);
                                   std::vector<double> out(std::min(piece, count - number * piece));
                                   std::iota(out.begin(), out.end(), static_cast<double>(number * piece));
                                   return out;
                                 }});
  }
};

}  // namespace

TEST_CASE("a stored series is read when it is asked for, once, and copies share it") {
  Counted source;
  const Series series = source.series();
  const Series copy = series;
  CHECK(series.size() == count);
  CHECK(source.reads == std::vector<int>{0, 0, 0});
  CHECK(copy.back() == 9);
  CHECK(series.get().size() == count);
  CHECK(&series.get() == &copy.get());
  CHECK(source.reads == std::vector<int>{1, 1, 1});
}

TEST_CASE("of a stored series that is looked at in one place the piece is read, and kept until another one is") {
  Counted source;
  const Series series = source.series();
  for (const std::size_t place : {4U, 7U, 5U}) CHECK(series.at(place) == static_cast<double>(place));
  CHECK(source.reads == std::vector<int>{0, 1, 0});
  CHECK(series.at(9) == 9);
  CHECK(series.at(4) == 4);
  CHECK(source.reads == std::vector<int>{0, 2, 1});
  CHECK_THROWS(series.at(10));
}

TEST_CASE("going through a series, or sharing it, keeps nothing, and what was kept is not read again") {
  Counted source;
  const Series series = source.series();
  std::vector<double> met;
  const auto note = [&](std::size_t place, double value) {
    CHECK(static_cast<double>(place) == value);
    met.push_back(value);
  };
  series.each(note);
  series.each(note);
  CHECK(met.size() == 2 * count);
  CHECK(source.reads == std::vector<int>{2, 2, 2});
  const auto shared = series.share();
  CHECK(*shared == std::vector<double>(met.begin(), met.begin() + count));
  CHECK(source.reads == std::vector<int>{3, 3, 3});
  series.get();
  series.each(note);
  CHECK(*series.share() == *shared);
  CHECK(series.at(8) == 8);
  CHECK(source.reads == std::vector<int>{4, 4, 4});
}

TEST_CASE("a series that is changed is its own from then on") {
  Counted source;
  const Series series = source.series();
  Series other = series;
  other.push_back(10);
  CHECK(other.size() == count + 1);
  CHECK(series.size() == count);
  CHECK_FALSE(other == series);
  other.own().pop_back();
  CHECK(other == series);
  CHECK(Series{0.5, 1} == Series(std::vector<double>{0.5, 1}));
  CHECK(Series().empty());
}
