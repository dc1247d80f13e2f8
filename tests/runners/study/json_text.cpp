#include "runners/study/json_text.hpp"

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
  CHECK(place(text, "/z") == "none");
}

TEST_CASE("Broken JSON is told with line and column") {
  CHECK_THAT(syntax("{\n  \"a\": 1,\n  \"b\" 2\n}"), Contains("3:7: not valid JSON"));
  CHECK_THAT(syntax("{\n  \"a\": 1,\n}"), Contains("3:1: not valid JSON"));
  CHECK_THAT(syntax("{\"é\" 1}"), Contains("1:6: not valid JSON"));
  CHECK_THAT(syntax("{\"a\": 1"), Contains("1:8: not valid JSON"));
  CHECK_THAT(syntax("{\"a\": NaN}"), Contains("not valid JSON"));
  CHECK_THAT(syntax("{\"a\": 1} x"), Contains("1:10: not valid JSON"));
  CHECK_THAT(syntax(""), Contains("the file is empty"));
  CHECK_THAT(syntax(" \n\n"), Contains("the file is empty"));
  CHECK_THAT(syntax("{\"a\":\n 1e999}"), Contains("2:2: the number 1e999 is too large"));
  CHECK_THAT(syntax(std::string("{\"a\": \"\xff\"}")), Contains("not valid JSON"));
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
  CHECK(cut.size() <= 63);
  CHECK_NOTHROW(Json::parse(cut.substr(0, cut.size() - 3) + "\""));
}
