#include "runners/study/study.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;

TEST_CASE("study part: K/N with 1 ≤ K ≤ N is one, and nothing else is") {
  CHECK(part_from("3/64") == StudyPart{3, 64});
  CHECK(part_from("1/1") == StudyPart{1, 1});
  CHECK_FALSE(part_from("1/1")->whole());
  for (const char* text : {"", "/", "3", "3/", "/64", "0/4", "5/4", "-1/4", "1/-4", "a/b", "1/4 ", " 1/4", "1/4/5",
                           "1.5/4", "1/99999999999", "1/0x4"})
    CHECK_FALSE(part_from(text).has_value());
  CHECK(StudyPart{}.whole());
  CHECK(StudyPart{3, 64}.text() == "part 3 of 64");
}
