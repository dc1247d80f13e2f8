#include "runners/store/atomic_file.hpp"

#include <signal.h>
#include <sys/resource.h>

#include <catch2/catch.hpp>

#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

namespace {

std::string message_of(const std::filesystem::path& file, const std::string& content) {
  try {
    write_file(file, content);
  } catch (const StoreError& error) {
    return error.what();
  }
  return "";
}

std::size_t files_in(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

}  // namespace

TEST_CASE("atomic file: a file is replaced whole") {
  const ScratchFolder folder;
  write_file(folder / "a.csv", "old");
  write_file(folder / "a.csv", "new, longer");
  CHECK(read_text(folder / "a.csv") == "new, longer");
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("atomic file: pieces are seen together, or not at all") {
  const ScratchFolder folder;
  write_file(folder / "a.csv", "old");
  {
    FileWriter writer(folder / "a.csv");
    writer.write("half");
    CHECK(read_text(folder / "a.csv") == "old");
  }
  CHECK(read_text(folder / "a.csv") == "old");
  CHECK(files_in(folder.path()) == 1);
  FileWriter writer(folder / "a.csv");
  writer.write("one, ");
  writer.write("");
  writer.write("two");
  writer.commit();
  CHECK(read_text(folder / "a.csv") == "one, two");
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("atomic file: a folder that is not there is named") {
  const ScratchFolder folder;
  CHECK_THAT(message_of(folder / "absent/a.csv", "x"),
             Catch::Contains("absent/a.csv") && Catch::Contains("No such file"));
}

TEST_CASE("atomic file: a write that does not fit leaves the old file and nothing else") {
  const ScratchFolder folder;
  write_file(folder / "a.csv", "old");
  rlimit former{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &former) == 0);
  const auto handler = signal(SIGXFSZ, SIG_IGN);
  rlimit small = former;
  small.rlim_cur = 4096;  // bytes; the content below is larger
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = message_of(folder / "a.csv", std::string(10000, 'x'));
  setrlimit(RLIMIT_FSIZE, &former);
  signal(SIGXFSZ, handler);
  CHECK_THAT(message, Catch::Contains("a.csv") && Catch::Contains("File too large"));
  CHECK(read_text(folder / "a.csv") == "old");
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("atomic file: what a killed process left is removed, other files stay") {
  const ScratchFolder folder;
  write_text(folder / "cases.csv.part-123", "half");
  write_text(folder / "my.part-time", "mine");
  write_text(folder / "cases.csv", "whole");
  remove_leftovers(folder.path());
  CHECK_FALSE(std::filesystem::exists(folder / "cases.csv.part-123"));
  CHECK(std::filesystem::exists(folder / "my.part-time"));
  CHECK(std::filesystem::exists(folder / "cases.csv"));
}
