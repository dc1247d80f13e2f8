// The names of the files of figures.
#include "runners/command/figure_files.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;

TEST_CASE("a figure's file has the sign of its value, and a name of its own") {
  std::set<std::string> taken;
  CHECK(figure_file_name("tip, penalty, initial.velocity −1 m/s", taken) == "tip-penalty-initial.velocity-minus-1-m-s");
  CHECK(figure_file_name("tip, penalty, initial.velocity -1 m/s", taken) ==
        "tip-penalty-initial.velocity-minus-1-m-s-2");
  CHECK(figure_file_name("tip, penalty, initial.velocity 1 m/s", taken) == "tip-penalty-initial.velocity-1-m-s");
  CHECK(figure_file_name("final-energy-step", taken) == "final-energy-step");
}
