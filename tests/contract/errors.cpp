#include <catch2/catch.hpp>
#include <ricochet/contract/errors.hpp>

using namespace ricochet;

TEST_CASE("the nearest name is the one a person meant") {
  const std::vector<std::string> names = {"newmark", "newmark-dumont-paoli", "moreau-jean", "penalty"};
  const auto [word, meant] = GENERATE(table<std::string, std::string>({{"newmrak", "newmark"},
                                                                       {"newmark", "newmark"},
                                                                       {"nwmark", "newmark"},
                                                                       {"newmarkk", "newmark"},
                                                                       {"newmark-dumont", "newmark-dumont-paoli"},
                                                                       {"moreau", "moreau-jean"},
                                                                       {"moreau_jean", "moreau-jean"},
                                                                       {"penlaty", "penalty"}}));
  CHECK(nearest_name(word, names) == meant);
}

TEST_CASE("a word that is like nothing has no nearest name") {
  const std::vector<std::string> names = {"length", "young", "density"};
  CHECK(nearest_name("xqzvb", names).empty());
  CHECK(nearest_name("G", {"t", "F"}).empty());
  CHECK(nearest_name("f", {"t", "F"}) == "F");
  CHECK(nearest_name("", names).empty());
  CHECK(nearest_name("length", {}).empty());
}

TEST_CASE("a swap of neighbours costs less than two substitutions") {
  // "hieght" is one swap from "height" and two substitutions from "hiegxy".
  CHECK(nearest_name("hieght", {"hiegxy", "height"}) == "height");
}

TEST_CASE("among equals the first is named") {
  CHECK(nearest_name("ab1", {"ab2", "ab3"}) == "ab2");
  CHECK(nearest_name("ab1", {"ab3", "ab2"}) == "ab3");
}

TEST_CASE("errors carry what a person needs to act") {
  const InputError input("/scene/structure/lenght", "unknown key");
  CHECK(input.pointer() == "/scene/structure/lenght");
  CHECK(std::string(input.what()) == "unknown key");
  CHECK(std::string(PluginError("time-x.so: no").what()) == "time-x.so: no");
}

TEST_CASE("a text of several lines is one line, cut as any text") {
  CHECK(one_line("") == "");
  CHECK(one_line("one") == "one");
  CHECK(one_line("\n one \r\n\n\ttwo\n") == "one; two");
  CHECK(one_line(std::string(longest_text, 'a') + "\nb") == std::string(longest_text - 3, 'a') + "…");
}

TEST_CASE("a text is quoted whole up to 80 characters, and by its first 80 beyond") {
  CHECK(shortened("") == "");
  CHECK(shortened(std::string(80, 'a')) == std::string(80, 'a'));
  CHECK(shortened(std::string(81, 'a')) == std::string(80, 'a') + "…");
  // Characters, not bytes, are counted, and none is cut.
  std::string umlauts;
  for (int i = 0; i < 80; ++i) umlauts += "ü";
  CHECK(shortened(umlauts) == umlauts);
  CHECK(shortened(umlauts + "ü") == umlauts + "…");
}
