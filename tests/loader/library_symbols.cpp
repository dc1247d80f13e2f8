#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <ricochet/contract/abi.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/loader/catalogue.hpp>

#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

const fs::path library = fs::path(RICOCHET_PLUGIN_DIR) / "reference.so";

}  // namespace

TEST_CASE("the exported symbols of a library are read without loading it") {
  std::vector<std::string> names;
  for (const auto& symbol : exported_symbols(library, "ricochet_"))
    if (!symbol.name.starts_with("ricochet_layout__")) names.push_back(symbol.name);
  CHECK(std::is_sorted(names.begin(), names.end()));
  CHECK(names == std::vector<std::string>{abi_tag(), "ricochet_provides__reference__event_driven",
                                          "ricochet_provides__reference__event_driven_semi_discrete",
                                          "ricochet_provides__reference__exact", "ricochet_register"});
  CHECK(exported_symbols(library, "ricochet_provides__").size() == 3);
  CHECK(exported_symbols(library, "no_such_prefix").empty());
}

TEST_CASE("the size of a symbol is that of its object") {
  const auto stage = exported_symbols(library, "ricochet_layout__Stage");
  REQUIRE(stage.size() == 1);
  CHECK(stage.front().size == sizeof(Stage));
  CHECK(exported_symbols(library, "ricochet_provides__").front().size == 1);
}

TEST_CASE("symbols that a library only uses are not its own") {
  // Every plugin calls the registry, whose mangled name begins like this.
  CHECK(exported_symbols(library, "_ZN8ricochet8Registry").empty());
}

TEST_CASE("a file that is no shared library says why") {
  const ScratchFolder here;
  write_text(here / "text.so", "not a library");
  CHECK_THROWS_WITH(exported_symbols(here / "text.so", ""), "not a shared library");
  write_text(here / "empty.so", "");
  CHECK_THROWS_WITH(exported_symbols(here / "empty.so", ""), "not a shared library");
  write_text(here / "short.so",
             "\x7f"
             "ELF");
  CHECK_THROWS_WITH(exported_symbols(here / "short.so", ""), Contains("damaged"));
  fs::create_directory(here / "folder.so");
  CHECK_THROWS_WITH(exported_symbols(here / "folder.so", ""), "not a file");
  CHECK_THROWS_WITH(exported_symbols(here / "absent.so", ""), "not a file");

  std::string other = read_text(library);
  other[18] = '\x28';  // e_machine: ARM
  other[19] = 0;
  write_text(here / "arm.so", other);
  CHECK_THROWS_WITH(exported_symbols(here / "arm.so", ""), "built for another processor");
  other = read_text(library);
  other[16] = 1;  // e_type: an object file
  write_text(here / "object.so", other);
  CHECK_THROWS_WITH(exported_symbols(here / "object.so", ""), Contains("another kind of binary"));
}

TEST_CASE("a truncated library is damaged, wherever it was cut") {
  const ScratchFolder here;
  const std::string whole = read_text(library);
  for (int part = 1; part < 64; ++part) {
    write_text(here / "cut.so", whole.substr(0, whole.size() * static_cast<std::size_t>(part) / 64));
    CHECK_THROWS_WITH(exported_symbols(here / "cut.so", "ricochet_"), Contains("damaged"));
  }
}

TEST_CASE("whatever its bytes, a file is read or refused, never more") {
  const ScratchFolder here;
  const std::string whole = read_text(library);
  std::mt19937 random(20240611);
  // The header and the section table, which everything else is found through, and a few bytes anywhere.
  const std::size_t sections = whole.size() > 4096 ? whole.size() - 4096 : 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::string bytes = whole;
    for (int k = 0; k < 4; ++k) {
      bytes[random() % 64] =
          static_cast<char>(trial % 3 == 0 && k < 2 ? random() : static_cast<unsigned char>(bytes[0]));
      bytes[sections + random() % (whole.size() - sections)] = static_cast<char>(random());
      bytes[random() % whole.size()] = static_cast<char>(random());
    }
    bytes.replace(0, 20, whole, 0, 20);
    write_text(here / "flipped.so", bytes);
    try {
      exported_symbols(here / "flipped.so", "ricochet_");
    } catch (const std::runtime_error& error) {
      CHECK_FALSE(std::string(error.what()).empty());
    }
  }
}
