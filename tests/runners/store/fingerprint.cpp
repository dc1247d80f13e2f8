#include "runners/store/fingerprint.hpp"

#include <catch2/catch.hpp>
#include <functional>

#include "runners/store/atomic_file.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

namespace {

StudyCase sample_case() {
  StudyCase one;
  one.id = "0123456789";
  one.axes = {{"mass", "consistent"}, {"step", 1e-4}};
  one.scene_json = {{"structure", {{"length", 1.501}}}};
  one.mass.name = "consistent";
  one.contact.name = "signorini";
  one.time = {"newmark", Parameters({{"beta", 0.25}, {"start", std::string("first-order")}})};
  one.elements = 50;
  one.step = 1e-4;
  one.duration = 0.5;
  one.samples = 200;
  return one;
}

std::string print_of(const StudyCase& one, const std::string& kind = "trajectory", const std::string& program = "p",
                     const std::vector<std::filesystem::path>& libraries = {}) {
  return Fingerprints(kind, program).of(one, libraries);
}

}  // namespace

TEST_CASE("fingerprint: the same case has the same one, and any change of it another") {
  const std::string reference = print_of(sample_case());
  CHECK(reference == print_of(sample_case()));
  const std::vector<std::function<void(StudyCase&)>> changes = {
      [](StudyCase& c) { c.id = "0123456780"; },
      [](StudyCase& c) { c.scene_json["structure"]["length"] = 1.5010000000000001; },  // one unit in the last place
      [](StudyCase& c) { c.mass.name = "lumped"; },
      [](StudyCase& c) { c.contact.name = "none"; },
      [](StudyCase& c) { c.time.parameters.set("beta", 0.5); },
      [](StudyCase& c) { c.time.parameters.set("start", std::string("second-order")); },
      [](StudyCase& c) { c.elements = 51; },
      [](StudyCase& c) { c.step = 1.0000000000000002e-4; },
      [](StudyCase& c) { c.duration = 0.4; },
      [](StudyCase& c) { c.samples = 100; },
      [](StudyCase& c) { c.excluded = "too long"; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    INFO("change " << i);
    StudyCase changed = sample_case();
    changes[i](changed);
    CHECK(print_of(changed) != reference);
  }
  CHECK(print_of(sample_case(), "convergence") != reference);
  CHECK(print_of(sample_case(), "trajectory", "another program") != reference);
}

TEST_CASE("fingerprint: the bytes of a plugin count, not its place") {
  const ScratchFolder folder;
  write_text(folder / "a.so", "code 1");
  write_text(folder / "b.so", "code 1");
  const auto with = [&](const char* name) { return print_of(sample_case(), "trajectory", "p", {folder / name}); };
  const std::string first = with("a.so");
  CHECK(first == with("b.so"));
  CHECK(first != print_of(sample_case()));
  write_text(folder / "a.so", "code 2");
  CHECK(first != with("a.so"));
  CHECK_THROWS_AS(with("absent.so"), StoreError);
}

TEST_CASE("fingerprint: methods of the program itself have no library") {
  CHECK(print_of(sample_case(), "trajectory", "p", {"", "", ""}) == print_of(sample_case()));
}

TEST_CASE("fingerprint: the content hash is the SHA-1 of a version 5 UUID") {
  // uuid5(00000000-0000-0000-0000-000000000000, "") and "abc", from Python's uuid module.
  CHECK(content_hash("") == "e129f27c51035c5c844bcdf0a15e160d");
  CHECK(content_hash("abc") == "b01d877968c6576dbef426488c9c9223");
  CHECK(program_hash().size() == 32);
}
