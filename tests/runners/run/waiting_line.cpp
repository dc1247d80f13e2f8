// A person who waits is told what for, and nobody who does not.
#include "runners/run/waiting_line.hpp"

#include <catch2/catch.hpp>

#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace std::chrono_literals;

namespace {

// What stands in a log, or came to a terminal, until it holds `awaited`; a minute is far beyond any delay of a thread.
std::string told(bool terminal, std::chrono::milliseconds after, const std::string& awaited) {
  const ScratchFolder scratch;
  std::FILE* file = std::fopen((scratch / "told").c_str(), "w");
  {
    WaitingLine line("reading a study", file, terminal, after);
    line.done(3, 8);
    const auto limit = std::chrono::steady_clock::now() + 1min;
    while (read_text(scratch / "told").find(awaited) == std::string::npos && std::chrono::steady_clock::now() < limit)
      std::this_thread::sleep_for(1ms);
  }
  std::fclose(file);
  return read_text(scratch / "told");
}

}  // namespace

TEST_CASE("waiting line: a short wait says nothing") {
  CHECK(told(true, 1h, "").empty());
  CHECK(told(false, 1h, "").empty());
}

TEST_CASE("waiting line: a terminal's line is erased at the end, a log has one line") {
  const std::string terminal = told(true, 0ms, "3 of 8"), log = told(false, 0ms, "\n");
  CHECK_THAT(terminal,
             Catch::StartsWith("\rreading a study, ") && Catch::Contains(", 3 of 8, ") && Catch::EndsWith("\r\x1b[K"));
  // The line may be said before a part is done.
  CHECK_THAT(log, Catch::Matches("reading a study(, 3 of 8)?, [0-9]+ s\n"));
}
