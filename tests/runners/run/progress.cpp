#include <catch2/catch.hpp>

#include "runners/run/study_runner.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

TEST_CASE("progress: what is said") {
  CHECK(progress_text({0, 4, 0, 10, 0.1, ""}) == "0/4 cases, 0 %");
  CHECK(progress_text({1, 4, 5, 10, 30, ""}) == "1/4 cases, 50 %, 2.0 cases/min, 30 s left");
  CHECK(progress_text({8, 16, 0, 0, 2, ""}) == "8/16 cases, 50 %, 4.0 cases/s, 2.0 s left");
  CHECK(progress_text({4, 4, 10, 10, 20, ""}) == "4/4 cases, 100 %, 12.0 cases/min");
}

TEST_CASE("progress: no time is told that stands still before the end") {
  CHECK(progress_text({99, 100, 9.99, 10, 30, ""}) == "99/100 cases, 99 %, 3.3 cases/s, less than 1 s left");
}

TEST_CASE("progress: many short cases after a few long ones cost what a case costs, not what their march does") {
  CaseCost cost;
  CHECK(cost.seconds(1) == Approx(1.02));
  for (int i = 0; i < 5; ++i) cost.add(2, 4);  // a machine half as fast
  CHECK(cost.seconds(2) == Approx(4).epsilon(0.05));
  for (int i = 0; i < 20; ++i) cost.add(1e-3, 0.05);
  // 700 of them are 35 s, where their marches alone are 1.4 s.
  CHECK(cost.seconds(0.7, 700) == Approx(35).epsilon(0.05));
  CHECK(cost.seconds(2) == Approx(4).epsilon(0.1));
}

TEST_CASE("progress: a case that takes far longer than predicted is named, and no time is promised") {
  CHECK(progress_text({1, 4, 9.9, 10, 30, "case a, 12 s so far, 0.5 s predicted"}) ==
        "1/4 cases, 99 %, 2.0 cases/min, waiting for case a, 12 s so far, 0.5 s predicted");
}

TEST_CASE("progress: the fraction stays within its bounds, and is whole at the end only") {
  CHECK(progress_fraction({0, 0, 0, 0, 0, ""}) == 1);
  CHECK(progress_fraction({1, 2, 30, 10, 0, ""}) == 1);
  CHECK(progress_fraction({2, 2, 0, 10, 0, ""}) == 1);
  CHECK(progress_fraction({0, 2, 0, 10, 0, ""}) == 0);
}

TEST_CASE("progress: the bar fits the terminal") {
  const ProgressState state{1, 4, 5, 10, 30, ""};
  for (const int width : {0, 5, 20, 60, 80, 300}) CHECK(static_cast<int>(progress_bar(state, width).size()) <= width);
  CHECK_THAT(progress_bar(state, 80), Catch::StartsWith("[#") && Catch::EndsWith("30 s left"));
}

TEST_CASE("progress: a terminal's line is erased at the end") {
  const ScratchFolder scratch;
  const std::atomic<bool> stop{false};
  std::FILE* file = std::fopen((scratch / "terminal").c_str(), "w");
  {
    Progress progress(file, true, 2, 2, stop);
    progress.started("a", 1);
    progress.finished("a");
  }
  std::fclose(file);
  const std::string text = read_text(scratch / "terminal");
  CHECK_THAT(text, Catch::Contains("1/2 cases") && Catch::EndsWith("\r\x1b[K"));
}
