#include <catch2/catch.hpp>
#include <ricochet/contract/abi.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <sstream>
#include <string>

#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using Catch::Matchers::StartsWith;

namespace {

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  const std::size_t at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), by);
}

std::string mismatch(const std::string& tag) {
  return abi_mismatch(tag).value_or("none");
}

// As a plugin of this tree exports it.
Layout own_layout() {
  const std::string prefix = "ricochet_layout__";
  Layout layout;
  for (const auto& symbol : exported_symbols(tests::places().plugins + "/time.so", prefix))
    layout[symbol.name.substr(prefix.size())] = symbol.size;
  return layout;
}

}  // namespace

TEST_CASE("the tag is a symbol name that tells the four fields in order") {
  const std::string tag = abi_tag();
  CHECK(tag.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos);
  std::size_t before = 0;
  for (const char* field : {"ricochet_abi__contract_", "__eigen_", "__align_", "__cxx11_"}) {
    const std::size_t at = tag.find(field);
    REQUIRE(at != std::string::npos);
    CHECK(at >= before);
    before = at;
  }
  CHECK(tag.find("__align_" + std::to_string(EIGEN_MAX_ALIGN_BYTES)) != std::string::npos);
  CHECK_FALSE(abi_mismatch(tag).has_value());
}

TEST_CASE("the page about plugins built earlier begins with the present tag, and misses none after it") {
  std::istringstream page(read_text(std::filesystem::path(tests::places().source) / "plugins/own.md"));
  std::string line;
  while (std::getline(page, line) && !line.starts_with("| tag |")) {
  }
  std::getline(page, line);
  int rows = 0;
  for (; std::getline(page, line) && line.starts_with("| "); ++rows)
    CHECK_THAT(line, StartsWith("| " + std::to_string(RICOCHET_ABI_CONTRACT - rows) + " | "));
  CHECK(rows > 1);
}

TEST_CASE("each field that differs is named with what was expected and what was found") {
  const std::string tag = "ricochet_abi__contract_10__eigen_3_4__align_32_16__cxx11_1";
  REQUIRE(mismatch(tag) == "none");
  CHECK(mismatch(replaced(tag, "contract_10", "contract_99")) == "contract: expected 10, found 99");
  CHECK(mismatch(replaced(tag, "eigen_3_4", "eigen_3_3")) == "eigen: expected 3.4, found 3.3");
  CHECK(mismatch(replaced(tag, "align_32_16", "align_64_16")) == "align: expected 32.16, found 64.16");
  CHECK(mismatch(replaced(tag, "align_32_16", "align_32_32")) == "align: expected 32.16, found 32.32");
  CHECK(mismatch(replaced(tag, "cxx11_1", "cxx11_0")) == "cxx11: expected 1, found 0");
}

TEST_CASE("the first field that differs is the one told") {
  CHECK(mismatch("ricochet_abi__contract_1__eigen_4_0__align_64_64__cxx11_0") == "contract: expected 10, found 1");
}

TEST_CASE("a tag with fields missing or added does not fit") {
  CHECK(mismatch("ricochet_abi__contract_10__eigen_3_4__align_32_16") == "cxx11: expected 1, found nothing");
  CHECK(mismatch("ricochet_abi__") == "contract: expected 10, found nothing");
  CHECK(mismatch("") == "contract: expected 10, found nothing");
  CHECK(mismatch("ricochet_abi__eigen_3_4") == "contract: expected 10, found nothing");
  CHECK(mismatch(abi_tag() + "__cuda_12") == "cuda: a field that this program does not know");
}

TEST_CASE("a plugin of this build has the sizes of this build") {
  REQUIRE(own_layout().size() > 20);
  CHECK_FALSE(layout_mismatch(own_layout()).has_value());
}

TEST_CASE("a type of another size is named with what was expected and what was found") {
  const std::string expected = std::to_string(sizeof(Stage)), more = std::to_string(sizeof(Stage) + 8);
  Layout layout = own_layout();
  layout["Stage"] = sizeof(Stage) + 8;
  CHECK(layout_mismatch(layout) == "layout: Stage: expected " + expected + " bytes, found " + more);
  layout.erase("Stage");
  CHECK(layout_mismatch(layout) == "layout: Stage: expected " + expected + " bytes, found nothing");
  // What a debugging standard library does: named first, as everything that holds one differs as well.
  layout["vector"] = 56;
  CHECK(layout_mismatch(layout) == "layout: std::vector<double>: expected 24 bytes, found 56");
}

TEST_CASE("a library without sizes, or with one that is not known, does not fit") {
  CHECK_THAT(layout_mismatch({}).value_or(""), StartsWith("layout: std::string: expected "));
  Layout layout = own_layout();
  layout["Wormhole"] = 8;
  CHECK(layout_mismatch(layout) == "layout: Wormhole: a type that this program does not know");
}
