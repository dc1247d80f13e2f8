// A folder of a process alone.
#include "runners/store/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include "runners/store/atomic_file.hpp"

using namespace ricochet;

TEST_CASE("a temporary folder is another one each time, and goes with its owner and all in it") {
  std::filesystem::path path;
  {
    const TemporaryFolder one("test"), other("test");
    path = one.path();
    CHECK(path != other.path());
    write_file(path / "file", "text");
    CHECK(std::filesystem::exists(path / "file"));
  }
  CHECK_FALSE(std::filesystem::exists(path));
}
