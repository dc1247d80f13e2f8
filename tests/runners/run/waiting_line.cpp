// A person who waits is told what for, and nobody who does not.
#include "runners/run/waiting_line.hpp"

#include <catch2/catch.hpp>

#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace std::chrono_literals;

namespace {

// What stands in a log, or came to a terminal, of a wait of so long.
std::string told(bool terminal, std::chrono::milliseconds after, std::chrono::milliseconds wait) {
  const ScratchFolder scratch;
  std::FILE* file = std::fopen((scratch / "told").c_str(), "w");
  {
    WaitingLine line("reading a study", file, terminal, after);
    line.done(3, 8);
    std::this_thread::sleep_for(wait);
  }
  std::fclose(file);
  return read_text(scratch / "told");
}

}  // namespace

TEST_CASE("waiting line: a short wait says nothing") {
  CHECK(told(true, 1h, 0ms).empty());
  CHECK(told(false, 1h, 0ms).empty());
}

TEST_CASE("waiting line: a terminal's line is erased at the end, a log has one line") {
  const std::string terminal = told(true, 0ms, 300ms), log = told(false, 0ms, 300ms);
  CHECK_THAT(terminal, Catch::StartsWith("\rreading a study, 3 of 8, 0 s\x1b[K") && Catch::EndsWith("\r\x1b[K"));
  CHECK(log == "reading a study, 3 of 8, 0 s\n");
}
