#include "runners/report/html.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>

using namespace ricochet::report;

TEST_CASE("escaped text holds no markup, and keeps every valid character", "[report]") {
  CHECK(escape("a < b & c > \"d\" 'e'") == "a &lt; b &amp; c &gt; &quot;d&quot; &#39;e&#39;");
  CHECK(escape("½vᵀMv ≤ 𝔼") == "½vᵀMv ≤ 𝔼");
  CHECK(escape("\xc3(") == "\xEF\xBF\xBD(");
  CHECK(escape("\xed\xa0\x80") == "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");  // a surrogate is no character
  CHECK(escape("\xe2\x82") == "\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST_CASE("script text cannot close its element", "[report]") {
  CHECK(script_text("x='</SCRIPT>'+'<!--'+(a<b)") == "x='<\\/SCRIPT>'+'<\\!--'+(a<b)");
  CHECK(script_json({{"a", "</script>"}}) == "{\"a\":\"\\u003c/script>\"}");
}

TEST_CASE("numbers are short, and exact where they must be", "[report]") {
  CHECK(number_text(0) == "0");
  CHECK(number_text(-0.024312) == "−0.02431");
  CHECK(number_text(1.234e-7, 2) == "1.2e-7");
  CHECK(number_text(3e12) == "3e12");
  CHECK(exact_text(1e-7) == "1e-7");
  CHECK(exact_text(0.25) == "0.25");
  for (const double value : {0.1, 1.0 / 3, 5e-324, 1.7976931348623157e308, -2.5e-300})
    CHECK(std::strtod(exact_text(value).c_str(), nullptr) == value);
  CHECK(number_text(std::numeric_limits<double>::quiet_NaN()) == "not a number");
}

TEST_CASE("a share has three digits", "[report]") {
  CHECK(share_text(0.05) == "5 %");
  CHECK(share_text(2.4e-9) == "2.4e-7 %");
}

TEST_CASE("no line ends behind the minus of an exponent", "[report]") {
  CHECK(unbroken("radius 2.5e-4 m <b> moreau-jean") ==
        "radius <span class=\"whole\">2.5e-4</span> m &lt;b&gt; moreau-jean");
  CHECK(unbroken("below 50 1/s") == "below 50 1/s");
}
