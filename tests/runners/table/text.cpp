#include "runners/table/text.hpp"

#include <catch2/catch.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "runners/table/plain_output.hpp"

using namespace ricochet;

TEST_CASE("Columns are aligned by characters, and empty ones are left out") {
  TextTable table({"a", "none", "b"});
  table.add({"é", "", "1"});
  table.add({"long", "", "2"});
  CHECK(table.text(1) == " a     b\n é     1\n long  2\n");
}

TEST_CASE("Times are told in the unit that a person would choose") {
  CHECK(duration_text(2.4e-3) == "2.4 ms");
  CHECK(duration_text(0.3) == "300 ms");
  CHECK(duration_text(3) == "3.0 s");
  CHECK(duration_text(42.3) == "42 s");
  CHECK(duration_text(59.7) == "1 min 00 s");
  CHECK(duration_text(185) == "3 min 05 s");
  CHECK(duration_text(7800) == "2 h 10 min");
}

TEST_CASE("Texts are shown without what steers a terminal, and as UTF-8") {
  for (const char* same : {"", "plain\ttext\n", "é µ ∞ 😀 ê€", "x̂"}) {
    CHECK(is_plain(same));
    CHECK(plain_text(same) == same);
  }
  for (const auto& [raw, shown] : std::vector<std::pair<std::string, std::string>>{
           {"\x1b[31mred", "<U+001B>[31mred"},
           {std::string(1, '\0'), "<U+0000>"},
           {"a\rb\x7f", "a<U+000D>b<U+007F>"},
           {"\xC2\x9B", "<U+009B>"},
           {"\u202Etxt\u2066", "<U+202E>txt<U+2066>"},
           {"caf\xE9", "caf\uFFFD"},
           {"\xC0\x80\xED\xA0\x80\xF4\x90\x80\x80", "\uFFFD\uFFFD\uFFFD\uFFFD\uFFFD\uFFFD\uFFFD\uFFFD\uFFFD"},
           {"\xE2\x82", "\uFFFD\uFFFD"}}) {
    CHECK_FALSE(is_plain(raw));
    CHECK(plain_text(raw) == shown);
    CHECK(is_plain(plain_text(raw)));
  }
  CHECK(csv_field("a\x1b,b") == "\"a<U+001B>,b\"");
}

TEST_CASE("A stream is plain as long as that is asked for, whatever pieces a text comes in") {
  std::ostringstream out;
  {
    const PlainOutput plain(out);
    for (const char c : std::string("é\x1b[1m€\xE9 ")) out << c;
    out << "\x9B" << std::flush;
  }
  out << "\x1b";
  CHECK(out.str() == "é<U+001B>[1m€\uFFFD \uFFFD\x1b");
}

TEST_CASE("Any double is read back from its text, and rounded within what doubles hold") {
  const double extremes[] = {0.0, -0.0, 5e-324, 8e-312, 2.2250738585072014e-308, 1.7976931348623157e308, -1e308, 0.1};
  for (const double value : extremes) {
    CHECK(number_in(csv_number(value)) == value);
    CHECK(to_digits(value, 17) == value);
  }
  CHECK(to_digits(1.7976931348623157e308, 3) == 1.7976931348623157e308);
  CHECK(to_digits(0.123456, 3) == 0.123);
  CHECK(to_digits(4.94e-324, 1) == 5e-324);
  CHECK_FALSE(number_in("1e999"));
  CHECK_FALSE(number_in("1x"));
  CHECK_FALSE(number_in(""));
}

TEST_CASE("a text is one word of a shell whatever stands in it") {
  CHECK(shell_quoted("") == "''");
  CHECK(shell_quoted("a b$c") == "'a b$c'");
  CHECK(shell_quoted("it's") == "'it'\\''s'");
  std::string text = "aaa-a";
  replace_all(text, "a", "aa");
  CHECK(text == "aaaaaa-aa");
}
