#include "runners/json/json_text.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

std::string place(const std::string& text, const std::string& pointer) {
  const auto where = locate(text, pointer);
  return where ? std::to_string(where->line) + ":" + std::to_string(where->column) : "none";
}

std::string syntax(const std::string& text) {
  try {
    parse_json(text);
  } catch (const SyntaxError& error) {
    return std::to_string(error.where().line) + ":" + std::to_string(error.where().column) + ": " + error.what();
  } catch (const InputError& error) {
    return error.pointer() + ": " + error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A pointer leads to the line and column of its key or list element") {
  const std::string text =
      "{\n"
      "  \"a\": {\"b\": [1,\n"
      "    {\"c\": \"} ] , \\\" \"},\n"
      "    [2, 3]]},\n"
      "  \"x/y~z\": null, \"é\": 1, \"\\u00e8\": 2\n"
      "}\n";
  CHECK(place(text, "/a") == "2:3");
  CHECK(place(text, "/a/b") == "2:9");
  CHECK(place(text, "/a/b/0") == "2:15");
  CHECK(place(text, "/a/b/1") == "3:5");
  CHECK(place(text, "/a/b/1/c") == "3:6");
  CHECK(place(text, "/a/b/2") == "4:5");
  CHECK(place(text, "/a/b/2/1") == "4:9");
  CHECK(place(text, "/x~1y~0z") == "5:3");
  // Columns count characters, not bytes.
  CHECK(place(text, "/é") == "5:18");
  CHECK(place(text, "/è") == "5:26");
  CHECK(place(text, "") == "none");
}

TEST_CASE("What is missing is told at its nearest ancestor") {
  const std::string text = "{\"a\": {\n\"b\": [1]}}";
  CHECK(place(text, "/a/c") == "1:2");
  CHECK(place(text, "/a/b/7") == "2:1");
  CHECK(place(text, "/a/bb") == "1:2");
  CHECK(place(text, "/z") == "1:1");
  CHECK(place("\n  {}", "/z") == "2:3");
  CHECK(place(" ", "/z") == "none");
}

TEST_CASE("Broken JSON is told with line and column, in words, with the line and a caret") {
  CHECK(syntax("{\n  \"a\": 1\n  \"b\": 2\n}") ==
        "2:9: not valid JSON: a comma is missing after 1\n    \"a\": 1\n          ^");
  const std::vector<std::pair<std::string, std::string>> all = {
      {"{\n  \"a\": 1,\n  \"b\" 2\n}", "3:7: not valid JSON: unexpected number literal; expected ':'"},
      {"{\n  \"a\": 1,\n}", "2:9: not valid JSON: a trailing comma"},
      {"[1, 2,]", "1:6: not valid JSON: a trailing comma"},
      {"{\"a\": 1,, \"b\": 2}", "1:9: not valid JSON: unexpected ','"},
      {"{\"é\" 1}", "1:6: not valid JSON: unexpected number literal; expected ':'"},
      {"{\"a\": 1", "1:8: not valid JSON: unexpected end of input; expected '}'"},
      {"{\"a\": [1, 2\n}", "2:1: not valid JSON: unexpected '}'; expected ']'"},
      {"{\"a\": {\n} \"b\": 1}", "2:2: not valid JSON: a comma is missing after }"},
      {"{\"a\": \"x\" \"b\": 1}", "1:10: not valid JSON: a comma is missing after \"x\""},
      {"{\"a\": NaN}", "1:7: not valid JSON: a text stands in double quotes: \"NaN\"; else write a number"},
      {"{\"a\": -Infinity}", "-Infinity is no number of JSON"},
      {"{\"a\": 0,4}", "1:9: not valid JSON: a key stands in double quotes, found 4; a decimal point"},
      {"{\"a\": .5}", "1:7: not valid JSON: .5 is no number of JSON, as 0.5"},
      {"{\"a\": -.5}", "-.5 is no number of JSON"},
      {"{\"a\": 1.}", "1:9: not valid JSON: invalid number; expected digit after '.'"},
      {"{\"a\": 1e}", "1:9: not valid JSON: invalid number; expected '+', '-', or digit after exponent"},
      {"{\"a\": 01}", "01 is no number of JSON"},
      {"{\"a\": +1}", "+1 is no number of JSON"},
      {"{\"a\": 12mm}", "12mm is no number of JSON, as 0.5 and -2e-3 are; units are not written"},
      {"{\"a\": True}", "else write a number, true, false or null"},
      {"{\"a\": None}", "or null"},
      {"{\"a\": beam}", "a text stands in double quotes: \"beam\""},
      {"{\"a\": 'beam'}", "double quotes (\"), not in '"},
      {"{\"a\": “beam”}", "straight double quotes"},
      {"{a: 1}", "1:2: not valid JSON: a key stands in double quotes: \"a\""},
      {"{\"a\" = 1}", "1:6: not valid JSON: invalid literal; expected ':'"},
      {"{\"a\": }", "1:7: not valid JSON: unexpected '}'; expected '[', '{', or a literal"},
      {"{\"a\": \"beam}\n", "1:7: not valid JSON: this text is not closed"},
      {"{\"a\": \"C:\\x\"}", "forbidden character after backslash"},
      {"{\"a\": 1 // metres\n}", "1:9: not valid JSON: comments are no JSON; write them as a key that begins with //"},
      {"{ # no\n}", "comments are no JSON"},
      {"{\"a\": 1} x", "1:10: not valid JSON: invalid literal; expected end of input"},
      {"", "the file is empty"},
      {" \n\n", "the file is empty"},
      {"{\"a\":\n 1e999}", "2:2: the number 1e999 is too large"},
      {"{\"a\": \"\xff\"}", "1:8: not valid JSON: this byte is no UTF-8"},
      {std::string("{\0\"\0a\0", 6), "the file is UTF-16"},
  };
  for (const auto& [text, part] : all) {
    INFO(text);
    CHECK_THAT(syntax(text), Contains(part));
  }
}

TEST_CASE("A text with any one character cut, gone or replaced is told with its place, or is JSON") {
  const std::string sound = "{\"a\": [1, -2.5e-3, {\"b\": \"x\\n\"}], \"c\": true}";
  for (std::size_t i = 0; i < sound.size(); ++i)
    for (std::string text :
         {sound.substr(0, i), sound.substr(0, i) + sound.substr(i + 1), sound.substr(0, i) + "," + sound.substr(i + 1),
          sound.substr(0, i) + "\"" + sound.substr(i)}) {
      INFO(text);
      CHECK(syntax(text).empty() == Json::accept(text));
    }
}

TEST_CASE("A long line is shown around its fault") {
  const std::string line = "[" + std::string(300, '1') + "é" + std::string(300, '2') + "]";
  const std::string shown = shown_line(line, 301);
  const auto caret = shown.find('\n');
  CHECK(caret < 130);
  CHECK_THAT(shown, Contains("…1") && Contains("é2") && Contains("2…"));
  CHECK(shown.substr(caret + 1) == "  " + std::string(51, ' ') + "^");
}

TEST_CASE("Remarks and $schema are no part of a text, at any level") {
  const Json parsed = parse_json(
      "{\"$schema\": \"s\", \"//\": \"one\", \"//\": \"two\", \"a\": [{\"// of b\": {\"x\": 1}, \"b\": {\"//\": 1, "
      "\"c\": 2}}]}");
  CHECK(parsed == Json::parse("{\"a\": [{\"b\": {\"c\": 2}}]}"));
  CHECK(place("{\"//\": 1,\n\"a\": 2}", "/a") == "2:1");
}

TEST_CASE("A key given twice is an error, at any depth") {
  CHECK_THAT(syntax("{\"a\": 1, \"b\": {\"c\": 1, \"d\": [], \"c\": 2}}"), Contains("/b/c: this key is given twice"));
  CHECK(syntax("{\"a\": {\"c\": 1}, \"b\": {\"c\": 1}}").empty());
  CHECK(place("{\"a\": 1,\n \"a\": 2}", "/a") == "2:2");
}

TEST_CASE("Nesting that would exhaust the stack is refused") {
  CHECK_THAT(syntax(std::string(1000000, '[')), Contains("1:101: nested deeper"));
  CHECK(syntax(std::string(50, '[') + std::string(50, ']')).empty());
}

TEST_CASE("Messages quote long values cut short, at a character") {
  CHECK(quote(Json(0.25)) == "0.25");
  CHECK(quote(Json("a\"b")) == "\"a\\\"b\"");
  std::string many;
  for (int i = 0; i < 100; ++i) many += "é";
  const std::string cut = quote(Json(many));
  // 80 characters of two bytes, and what says that there are more.
  CHECK(cut.size() <= 80 * 2 + 4);
  CHECK_NOTHROW(Json::parse(cut.substr(0, cut.size() - 3) + "\""));
}

TEST_CASE("The nearest name is told where it is another one") {
  CHECK(did_you_mean("ful", {"poor", "full"}) == "; did you mean \"full\"?");
  CHECK(did_you_mean("full", {"poor", "full"}).empty());
}

TEST_CASE("A list of names tells of many that differ in numbers alone the first and the last") {
  CHECK(quoted_list({}).empty());
  CHECK(quoted_list({"p1", "p2", "p3", "p4"}) == R"("p1", "p2", "p3", "p4")");
  CHECK(quoted_list({"a", "p1", "p2", "p3", "p4", "p5", "q1"}) == R"("a", "p1" … "p5", "q1")");
  CHECK(quoted_list({"at_0.5Hz", "at_1Hz", "at_1.5Hz", "at_2Hz", "at_10Hz"}) == R"("at_0.5Hz" … "at_10Hz")");
  // Numbers alone are no family, nor is one name five times.
  CHECK(quoted_list({"1", "2", "3", "4", "5"}) == R"("1", "2", "3", "4", "5")");
  CHECK(quoted_list({"a", "a", "a", "a", "a"}) == R"("a", "a", "a", "a", "a")");
}
