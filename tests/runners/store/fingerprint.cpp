#include "runners/store/fingerprint.hpp"

#include <catch2/catch.hpp>
#include <functional>

#include "runners/run/compare_studies.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/run/fake_study.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/store/sample_results.hpp"

using namespace ricochet;

namespace {

StudyCase sample_case() {
  StudyCase one;
  one.id = "c0123456789";
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
      [](StudyCase& c) { c.id = "c0123456780"; },
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

TEST_CASE("arithmetics: a case keeps that of the run that computed it, also aside and when it is saved again") {
  const ScratchFolder folder;
  StudyResults results = sample_results();
  results.cases[1].status = Status::done;
  const std::vector<ExpectedCase> both = {{results.cases[0].id, "f1"}, {results.cases[1].id, "f2"}};
  {
    Store store(folder.path(), false);
    store.begin(results, both, "aaaa");
    store.save({results.cases.data(), 1});
  }
  Store store(folder.path(), false);
  store.begin(results, both, "bbbb");
  store.save({results.cases.data() + 1, 1});
  StudyResults seen = store.load();
  CHECK(seen.cases[0].arithmetic == "aaaa");
  CHECK(seen.cases[1].arithmetic == "bbbb");
  CHECK(environment_entry(seen.environment, kArithmetic) ==
        "2 that differ in last digits: aaaa (1 case), bbbb (1 case)");
  store.save(seen.cases);  // as when they are timed
  store.begin(results, {}, "bbbb");
  store.begin(results, both, "bbbb");
  seen = store.load();
  CHECK(seen.cases[0].arithmetic == "aaaa");
  // What runs say of themselves is not repeated.
  store.save_environment({{{"program", "p"}, {kArithmetic, "bbbb"}, {"arithmetic (earlier cases)", "aaaa"}}});
  seen = store.load();
  CHECK(seen.environment.entries.size() == 2);
  CHECK(environment_entry(seen.environment, kArithmetic).starts_with("2 that differ"));
}

TEST_CASE("arithmetics: what a case left under way is found by runs of the same arithmetic alone") {
  const ScratchFolder folder;
  const StudyResults results = sample_results();
  Store store(folder.path(), false);
  store.begin(results, {}, "aaaa");
  store.save_motion("orbits", "of a");
  store.begin(results, {}, "bbbb");
  CHECK(store.motion("orbits").empty());
  store.save_motion("orbits", "of b");
  CHECK(read_motion(folder.path(), "orbits", "aaaa") == "of a");
  store.begin(results, {}, "aaaa");
  CHECK(store.motion("orbits") == "of a");
}

TEST_CASE("arithmetics: finished cases of another one are kept, and a comparison says that two made the results") {
  const ScratchFolder scratch;
  const Study study = fake_study(4);
  FakeRun run(scratch);
  run.runner.arithmetic = "aaaa";
  REQUIRE(run(study, {scratch / "one", 1, false}) == 0);
  run.runner.cases.run = [&, done = 0](const StudyCase& one, const std::atomic<bool>& stop) mutable {
    if (++done > 2) const_cast<std::atomic<bool>&>(stop) = true;
    return fake_result(one);
  };
  CHECK(run(study, {scratch / "two", 1, false}) == 130);
  run.runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>&) {
    ++run.runs;
    return fake_result(one);
  };
  run.runner.arithmetic = "bbbb";
  CHECK(run(study, {scratch / "two", 1, false}) == 0);
  CHECK(run.runs == 1);
  CHECK_THAT(run.messages, Catch::Contains("3 cases were computed with other last digits"));
  const StudyComparison found = compare_studies(read_store(scratch / "one"), read_store(scratch / "two"));
  REQUIRE(found.environment.size() == 1);
  CHECK(found.environment[0].where == kArithmetic);
  CHECK(found.environment[0].a == "aaaa");
  CHECK(found.environment[0].b == "2 that differ in last digits: aaaa (3 cases), bbbb (1 case)");
}
