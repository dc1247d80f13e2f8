// Values as bytes and back: every bit of them, or a sentence that says why not.
#include "runners/march/bytes.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <limits>
#include <new>

#include "runners/march/case_context.hpp"

using Catch::Matchers::Contains;

namespace bytes_tests {

enum class Colour { red, green };

/// Padding follows `flag` and `count`.
struct Sample {
  bool flag = false;
  double value = 0;
  int count = 0;
};

struct Stored {
  Colour colour = Colour::red;
  std::vector<double> numbers;
  std::vector<Sample> samples;
  std::vector<std::string> words;
  std::optional<double> perhaps;
};

template <class Archive>
void serialize(Archive& archive, Sample& sample) {
  archive(sample.flag, sample.value, sample.count);
}

template <class Archive>
void serialize(Archive& archive, Stored& stored) {
  archive(stored.colour, stored.numbers, stored.samples, stored.words, stored.perhaps);
}

constexpr const char* mark = "things 7";
constexpr std::size_t content_begin = 8 + 32;  // behind the mark and the hash

const double odd_nan = std::bit_cast<double>(0xfff4'0000'dead'beefULL);

Stored full() {
  return {Colour::green, {-0.0, odd_nan, std::numeric_limits<double>::denorm_min()}, {{true, 0.1, 3}}, {"", "épi"}, 2};
}

Stored read_stored(const std::string& bytes) {
  return ricochet::from_bytes<Stored>(bytes, mark);
}

TEST_CASE("bytes: values come back bit for bit, a NaN with its payload") {
  const std::string bytes = ricochet::to_bytes(full(), mark);
  const Stored back = read_stored(bytes);
  CHECK(back.colour == Colour::green);
  REQUIRE(back.numbers.size() == 3);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(std::bit_cast<std::uint64_t>(back.numbers[i]) == std::bit_cast<std::uint64_t>(full().numbers[i]));
  REQUIRE(back.samples.size() == 1);
  CHECK(back.samples[0].value == 0.1);
  CHECK(back.samples[0].count == 3);
  CHECK(back.words == full().words);
  CHECK(back.perhaps == 2.0);
  CHECK((ricochet::to_bytes(back, mark) == bytes));
  CHECK(read_stored(ricochet::to_bytes(Stored{}, mark)).numbers.empty());
}

TEST_CASE("bytes: what lies between the numbers of a value is not written") {
  alignas(Sample) unsigned char ones[sizeof(Sample)], zeros[sizeof(Sample)];
  std::fill(std::begin(ones), std::end(ones), static_cast<unsigned char>(0xff));
  std::fill(std::begin(zeros), std::end(zeros), static_cast<unsigned char>(0));
  std::string bytes[2];
  int which = 0;
  for (unsigned char* place : {ones, zeros}) {
    auto* sample = new (place) Sample;
    *sample = {true, 0.5, 1};
    bytes[which++] = ricochet::to_bytes(*sample, mark);
  }
  CHECK((bytes[0] == bytes[1]));
  CHECK(bytes[0].size() == content_begin + 1 + sizeof(double) + sizeof(int));
}

TEST_CASE("bytes: what is cut short or damaged is refused with a sentence, wherever it is") {
  const std::string bytes = ricochet::to_bytes(full(), mark);
  for (std::size_t size = 8; size < bytes.size(); ++size)
    CHECK_THROWS_WITH(read_stored(bytes.substr(0, size)), "what was stored as things 7 is cut short or damaged");
  for (std::size_t at = 8; at < bytes.size(); ++at) {
    std::string other = bytes;
    other[at] = static_cast<char>(other[at] ^ 4);
    CHECK_THROWS_WITH(read_stored(other), Contains("damaged"));
  }
  CHECK_THROWS_AS(read_stored(bytes + "x"), std::runtime_error);
}

TEST_CASE("bytes: a length that promises more than there is asks for no memory") {
  std::string bytes = ricochet::to_bytes(std::vector<double>{1, 2}, mark);
  for (std::size_t i = content_begin; i < content_begin + 7; ++i) bytes[i] = '\x7f';
  CHECK_THROWS_AS(ricochet::from_bytes<std::vector<double>>(bytes, mark), std::runtime_error);
}

TEST_CASE("bytes: another version is named, whatever follows it") {
  for (const std::string other : {"", "things", "things 8", "thongs 7"})
    CHECK_THROWS_WITH(read_stored(ricochet::to_bytes(full(), other)), Contains("of another version than things 7"));
}

TEST_CASE("bytes: what a store does not keep whole is computed again") {
  const std::string bytes = ricochet::to_bytes(full(), mark);
  ricochet::CheckpointStore checkpoints;
  CHECK_FALSE(ricochet::recall(checkpoints, "key", read_stored));
  std::string kept;
  checkpoints.find = [&](const std::string&) { return kept; };
  CHECK_FALSE(ricochet::recall(checkpoints, "key", read_stored));
  for (const std::string& lost : {bytes.substr(0, 50), ricochet::to_bytes(full(), "things 6")}) {
    kept = lost;
    CHECK_FALSE(ricochet::recall(checkpoints, "key", read_stored));
  }
  kept = bytes;
  REQUIRE(ricochet::recall(checkpoints, "key", read_stored));
  CHECK(ricochet::recall(checkpoints, "key", read_stored)->words == full().words);
}

}  // namespace bytes_tests
