// Files outside the study's folder, influences of supports, structures that are too large, tables that are too coarse.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <numbers>

#include "runners/march/load_changes.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;
using Catch::Matchers::Contains;

namespace files_beyond_tests {
namespace {

const std::string array = "%%MatrixMarket matrix array real symmetric\n2 2\n";

/// Two masses on springs, A and B, whose files lie beside the folder of the study.
struct Files {
  ScratchFolder folder;
  Files() {
    std::filesystem::create_directory(folder / "study");
    write_text(folder / "K.mtx", array + "3\n-1\n3\n");
    write_text(folder / "M.mtx", array + "1\n0\n2\n");
    write_text(folder / "dofs.csv", "dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n2,B,ux,1,0,0,\n");
    write_text(folder / "psi.csv", "dof,value\n1,1\n2,0.5\n");
  }
};

Json study_of(const std::string& files) {
  Json study = small_study();
  study["scene"] = Json::parse(R"json({
    "structure": {"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "dofs.csv"},
    "stops": [{"name": "wall", "at": {"node": "B", "component": "ux"}, "upper": 0.1}]})json");
  study["scene"]["structure"]["folder"] = files;
  study.erase("mesh");
  return study;
}

Study opened(const Json& json, const std::filesystem::path& folder) {
  Registry registry = stand_ins();
  Catalogue catalogue{"/nonexistent", {}, {}};
  return parse_study(json.dump(1), catalogue, registry, folder);
}

std::string refused(const Json& json, const std::filesystem::path& folder) {
  return testing::input_error([&] { opened(json, folder); });
}

std::string all(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += note + "\n";
  return text;
}

TimeTable table(const std::string& name, double every, int count) {
  TimeTable out;
  out.name = name;
  for (int i = 0; i < count; ++i) {
    out.times.push_back(every * i);
    out.values.push_back(0);
  }
  return out;
}

}  // namespace

TEST_CASE("files may lie outside the folder of a study that says so") {
  const Files files;
  Json study = study_of("..");
  CHECK(refused(study, files.folder / "study") ==
        "/scene/structure/dofs: \"../dofs.csv\" is outside the folder of the study; expected a file in it, or a study "
        "that says \"outside\": true");
  study["outside"] = true;
  const Study made = opened(study, files.folder / "study");
  CHECK(made.resolved["outside"] == true);
  // As workers open it.
  CHECK(opened(made.resolved, {}).cases.front().id == made.cases.front().id);
  // What may lie outside, and does not, is the same case.
  CHECK(opened(study_of(""), files.folder.path()).cases.size() == made.cases.size());
  study["outside"] = false;
  CHECK_THAT(refused(study, files.folder / "study"), Contains("is outside the folder of the study"));
  study["outside"] = "yes";
  CHECK(refused(study, files.folder / "study") == "/outside: expected true or false, found \"yes\"");
  CHECK_FALSE(opened(study_of(""), files.folder.path()).resolved.contains("outside"));
}

TEST_CASE("the influence of a support is a file of the structure") {
  const Files files;
  Json study = study_of("");
  study["scene"]["structure"]["influence"] = {{"ground", "psi.csv"}};
  study["scene"]["support"] = {{"amplitude", 0.01}, {"pulsation", 3}};
  const Study made = opened(study, files.folder.path());
  CHECK(made.resolved["files"]["digests"].contains("psi.csv"));
  CHECK(made.cases.front().scene_json["structure"]["digests"].contains("influence/ground"));
  const Json stored = made.resolved;
  CHECK(opened(stored, {}).cases.front().id == made.cases.front().id);
  const auto with = [&](const std::string& text) {
    write_text(files.folder / "psi.csv", text);
    return refused(study, files.folder.path());
  };
  CHECK(with("dof,value\n1,1\n2,0.25\n") == "no error");
  CHECK(refused(stored, {}) == "/scene/structure/influence/ground: psi.csv has changed since the run began");
  const std::string at = "/scene/structure/influence/ground: psi.csv";
  CHECK(with("dof,psi\n1,1\n") == at + " has no column \"value\"; there are dof,psi");
  CHECK(with("dof,value\n3,1\n") == at + ", line 2: \"3\" for dof; expected 1 to 2");
  CHECK(with("dof,value\n1,1\n1,1\n") == at + ", line 3: dof 1 stands a second time");
  CHECK(with("dof,value\n1,x\n") == at + ", line 2: \"x\" for value; expected a finite number");
  study["scene"]["structure"]["influence"]["ground"] = "phi.csv";
  CHECK_THAT(refused(study, files.folder.path()), Contains("/scene/structure/influence/ground: \"phi.csv\": no such"));
  study["scene"]["structure"]["influence"] = "psi.csv";
  CHECK_THAT(refused(study, files.folder.path()), Contains("/scene/structure/influence: expected {\"name\": file"));
  study["scene"]["structure"].erase("influence");
  CHECK(refused(study, files.folder.path()) ==
        "/scene/support/amplitude: the table of dofs names no support that could move; expected an amplitude of 0");
}

TEST_CASE("matrices of more than 100000 dofs are refused with the time of a step") {
  const ScratchFolder folder;
  constexpr int n = 100001;
  std::string K = fmt::format("%%MatrixMarket matrix coordinate real symmetric\n{0} {0} {0}\n", n), M = K,
              dofs = "dof,node,component,x,y,z,held\n";
  for (int i = 1; i <= n; ++i) {
    K += fmt::format("{0} {0} 2\n", i);
    M += fmt::format("{0} {0} 1\n", i);
    dofs += fmt::format("{0},{0},ux,0,0,0,\n", i);
  }
  write_text(folder / "K.mtx", K);
  write_text(folder / "M.mtx", M);
  write_text(folder / "dofs.csv", dofs);
  Json study = study_of("");
  study["scene"]["stops"][0]["at"]["node"] = "1";
  CHECK_THAT(refused(study, folder.path()),
             Contains("/scene/structure: 100001 dofs without mesh.modes: a time integration takes ") &&
                 Contains(" s per step; expected at most 100000, or mesh.modes"));
}

TEST_CASE("a table with many steps of the march between its entries is told, and one that resolves no mode") {
  StudyCase one;
  one.step = 1e-5;
  one.scene.load.terms.emplace_back().table = std::make_shared<const TimeTable>(table("elcentro.csv", 0.02, 100));
  CHECK(all(table_notes(one)) == "elcentro.csv has 2000 steps of the march between entries: linear pieces\n");
  CHECK(all(coarse_tables(one.scene,
                          {2 * std::numbers::pi * 10, 2 * std::numbers::pi * 20, 2 * std::numbers::pi * 91})) ==
        "elcentro.csv: its step 0.02 s resolves nothing above 25 Hz; mode 3 is at 91 Hz\n");
  CHECK(coarse_tables(one.scene, {2 * std::numbers::pi * 10}).empty());
  one.step = 2e-3;
  CHECK(table_notes(one).empty());
  // A few entries are a shape that is meant.
  one.scene.load.terms.front().table = std::make_shared<const TimeTable>(table("pulse.csv", 0.02, 4));
  CHECK(coarse_tables(one.scene, {2 * std::numbers::pi * 91}).empty());
}

TEST_CASE("a spectrum whose highest line the step does not resolve is told") {
  StudyCase one;
  one.scene_json = Json::parse(R"json({"load": [{"at": 1, "force": {"psd": {"to": 200}}}]})json");
  one.step = 1e-3;
  CHECK(table_notes(one).empty());
  one.step = 2e-3;
  CHECK(all(table_notes(one)) == "the spectrum of the load 0 to 200 Hz needs h ≤ 0.001 s, 5 steps per period\n");
}

}  // namespace files_beyond_tests
