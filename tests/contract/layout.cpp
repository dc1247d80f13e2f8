#include <catch2/catch.hpp>
#include <ricochet/contract/abi.hpp>
#include <ricochet/loader/library_symbols.hpp>

using namespace ricochet;
using Catch::Matchers::StartsWith;

namespace {

// As a plugin of this tree exports it.
Layout own() {
  const std::string prefix = "ricochet_layout__";
  Layout layout;
  for (const auto& symbol : exported_symbols(std::string(RICOCHET_PLUGIN_DIR) + "/time-newmark.so", prefix))
    layout[symbol.name.substr(prefix.size())] = symbol.size;
  return layout;
}

}  // namespace

TEST_CASE("a plugin of this build has the sizes of this build") {
  REQUIRE(own().size() > 20);
  CHECK_FALSE(layout_mismatch(own()).has_value());
}

TEST_CASE("a type of another size is named with what was expected and what was found") {
  const std::string expected = std::to_string(sizeof(Stage)), more = std::to_string(sizeof(Stage) + 8);
  Layout layout = own();
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
  Layout layout = own();
  layout["Wormhole"] = 8;
  CHECK(layout_mismatch(layout) == "layout: Wormhole: a type that this program does not know");
}
