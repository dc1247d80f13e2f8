#include "runners/store/folder_lock.hpp"

#include <catch2/catch.hpp>

#include "runners/store/atomic_file.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
namespace fs = std::filesystem;

TEST_CASE("folder writer: nothing is seen before it is whole, and nothing is left where it never is") {
  const ScratchFolder scratch;
  const fs::path folder = scratch / "deep/down/";
  {
    const FolderWriter writer(folder);
    write_text(writer.place() / "half", "a");
    CHECK_FALSE(fs::exists(folder));
  }
  CHECK(fs::is_empty(scratch / "deep"));
  {
    FolderWriter writer(folder);
    write_text(writer.place() / "whole", "b");
    writer.commit();
  }
  CHECK(read_text(folder / "whole") == "b");
  CHECK(std::distance(fs::directory_iterator(scratch / "deep"), {}) == 1);
}

TEST_CASE("folder writer: two that make the same folder do not meet, and what a killed one left goes") {
  const ScratchFolder scratch;
  fs::path left;
  {
    const FolderWriter writer(scratch / "out");
    left = writer.place();
  }
  fs::create_directory(left);
  write_text(left / "of somebody", "else");
  {
    const FolderLock alive(left);
    CHECK_THROWS_AS(FolderWriter(scratch / "out"), StoreError);
    CHECK(fs::exists(left / "of somebody"));
  }
  FolderWriter writer(scratch / "out");
  CHECK(fs::is_empty(writer.place()));
  fs::create_directory(scratch / "out");
  write_text(scratch / "out/meanwhile", "");
  CHECK_THROWS_AS(writer.commit(), StoreError);
}
