#include "runners/study/case_id.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>

using namespace ricochet;

TEST_CASE("case ids: no reader takes one for a number, and the digits of earlier programs are still known") {
  // Digits alone, digits e digits, what overflows to infinity, words of no value once letters stand alone.
  for (const std::string former :
       {"0168126827", "57593e5944", "0000000000", "1e00000009", "deadbeef00", "abcdefabcd"}) {
    CAPTURE(former);
    CHECK(is_former_id(former));
    const std::string id = id_of_today(former);
    CHECK(id == "c" + former);
    CHECK_FALSE(is_former_id(id));
    CHECK(id_of_today(id) == id);
    CHECK(former_id(id) == former);
    CHECK(former_id(former) == former);
    char* end = nullptr;
    std::strtod(id.c_str(), &end);  // strtod knows inf, nan and hexadecimal numbers, too
    CHECK(end == id.c_str());
    CHECK(begins_id(id, id));
    CHECK(begins_id(id, former));
    CHECK(begins_id(id, former.substr(0, 3)));
    CHECK_FALSE(begins_id(id, "x"));
  }
  for (const std::string other : {"reference", "reference-exact", "0168126827a", "0168126A27", ""}) {
    CAPTURE(other);
    CHECK_FALSE(is_former_id(other));
    CHECK(id_of_today(other) == other);
  }
  CHECK(former_id("reference") == "reference");
}
