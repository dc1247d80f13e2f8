// Studies whose structure stands in files: what is read, what is refused, and what a stored study remembers.
#include <catch2/catch.hpp>

#include "runners/store/fingerprint.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;
using Catch::Matchers::Contains;

namespace {

const std::string head = "%%MatrixMarket matrix array real symmetric\n2 2\n";

/// Two masses on springs, A and B, and a study of them.
struct Files {
  ScratchFolder folder;
  Files() {
    write_text(folder / "K.mtx", head + "3\n-1\n3\n");
    write_text(folder / "M.mtx", head + "1\n0\n2\n");
    write_text(folder / "dofs.csv", "dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n2,B,ux,1,0,0,\n");
  }
};

Json assembled_study() {
  Json study = small_study();
  study["scene"] = Json::parse(R"json({
    "structure": {"type": "assembled", "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "dofs.csv"},
    "stops": [{"name": "gap", "at": {"node": "A", "component": "ux"}, "to": {"node": "B", "component": "ux"}, "upper": 0.1},
              {"name": "wall", "at": {"dofs": [{"dof": 2}]}, "lower": -0.2, "upper": null}],
    "load": [{"at": {"node": "B", "direction": [2, 0, 0]}, "force": "sin(t)"}]})json");
  study.erase("mesh");
  return study;
}

struct Opened {
  Registry registry = stand_ins();
  Catalogue catalogue{"/nonexistent", {}, {}};
  Study study;
  Opened(const Json& json, const std::filesystem::path& folder)
      : study(parse_study(json.dump(1), catalogue, registry, folder)) {}
};

std::string refused(const Json& json, const std::filesystem::path& folder) {
  return testing::input_error([&] { Opened(json, folder); });
}

}  // namespace

TEST_CASE("a study names files, stops and places, and is complete") {
  const Files files;
  const Opened opened(assembled_study(), files.folder.path());
  const Json& scene = opened.study.resolved["scene"];
  CHECK(scene["structure"]["folder"] == "");
  CHECK(scene["structure"]["length_unit"] == 1.0);
  CHECK(scene["structure"]["tip"].is_null());
  CHECK(scene["stops"][0]["lower"].is_null());
  CHECK(scene["stops"][1]["to"].is_null());
  CHECK(scene["stops"][1]["at"] == Json::parse(R"({"dofs": [{"dof": 2, "weight": 1.0}]})"));
  CHECK(opened.study.resolved["mesh"]["elements"] == 1);
  const StudyCase& one = opened.study.cases.front();
  REQUIRE(one.scene.stops.named.size() == 2);
  CHECK(one.scene.stops.named[0].name == "gap");
  CHECK(one.scene.stops.named[0].to->node == "B");
  CHECK(*one.scene.stops.named[1].lower == -0.2);
  CHECK_FALSE(one.scene.stops.named[1].upper);
  CHECK(one.scene.load.terms.front().place->direction == std::vector<double>{2, 0, 0});
}

TEST_CASE("a stored study finds its files from anywhere, and tells one that has changed") {
  const Files files;
  const Opened opened(assembled_study(), files.folder.path());
  const Json stored = opened.study.resolved;
  CHECK(stored["files"]["folder"] == files.folder.path().string());
  CHECK(stored["files"]["digests"].size() == 3);
  // As workers and reports open it: without a folder.
  const Opened again(stored, {});
  CHECK(again.study.cases.front().id == opened.study.cases.front().id);
  CHECK(again.study.resolved == stored);
  write_text(files.folder / "M.mtx", head + "1\n0\n2.5\n");
  CHECK(refused(stored, {}) == "/scene/structure/mass: M.mtx has changed since the run began");
  // Another run of the study takes it, as other cases.
  const Opened edited(assembled_study(), files.folder.path());
  CHECK(edited.study.cases.front().id != opened.study.cases.front().id);
  const auto fingerprint = [](const Opened& one) {
    return Fingerprints("trajectory", "program").of(one.study.cases.front(), {});
  };
  CHECK(fingerprint(edited) != fingerprint(opened));
}

TEST_CASE("ids and fingerprints do not know where the files lie") {
  const Files here, there;
  const Opened a(assembled_study(), here.folder.path()), b(assembled_study(), there.folder.path());
  CHECK(a.study.cases.front().id == b.study.cases.front().id);
  CHECK(Fingerprints("trajectory", "p").of(a.study.cases.front(), {}) ==
        Fingerprints("trajectory", "p").of(b.study.cases.front(), {}));
}

TEST_CASE("a study keeps where its structure is drawn, and reads it back as it was") {
  const Files files;
  const Opened opened(assembled_study(), files.folder.path());
  const Json layout = opened.study.resolved["files"]["layout"];
  CHECK(layout["nodes"] == Json({"A", "B"}));
  CHECK(layout["x"] == Json({0.0, 1.0}));
  CHECK(layout["links"] == Json::parse("[[0, 1]]"));
  CHECK(layout["stops"][0] == Json::parse(R"({"at": 0, "direction": [1.0, 0.0], "to": 1})"));
  CHECK(layout["loads"][0] == Json::parse(R"({"at": 1, "direction": [1.0, 0.0]})"));
  const Opened again(opened.study.resolved, "/");
  CHECK(again.study.resolved == opened.study.resolved);
}

TEST_CASE("folders are an axis") {
  const Files files;
  for (const char* name : {"coarse", "fine"}) {
    std::filesystem::create_directory(files.folder / name);
    for (const char* file : {"K.mtx", "M.mtx", "dofs.csv"})
      std::filesystem::copy(files.folder / file, files.folder / name / file);
  }
  write_text(files.folder / "fine" / "K.mtx", head + "3.1\n-1\n3\n");
  Json study = assembled_study();
  study["scene"]["structure"]["folder"] = {"coarse", "fine"};
  const Opened opened(study, files.folder.path());
  CHECK(opened.study.columns.back() == "structure.folder");
  CHECK(opened.study.cases.size() == 2 * Opened(assembled_study(), files.folder.path()).study.cases.size());
  CHECK(opened.study.resolved["files"]["digests"].contains("fine/K.mtx"));
}

TEST_CASE("files that are missing, outside or wrong, and places that are none, are told by their key") {
  const Files files;
  const auto with_value = [&](const char* pointer, const Json& value) {
    Json study = assembled_study();
    study[Json::json_pointer(pointer)] = value;
    return refused(study, files.folder.path());
  };
  CHECK(with_value("/scene/structure/stiffness", "Km.mtx") ==
        "/scene/structure/stiffness: \"Km.mtx\": no such file; there are K.mtx, M.mtx, dofs.csv; did you mean "
        "\"K.mtx\"?");
  for (const char* name : {"../K.mtx", "/etc/passwd", "a/../../K.mtx"})
    CHECK_THAT(with_value("/scene/structure/mass", name),
               Contains("/scene/structure/mass: ") && Contains("is outside the folder of the study"));
  CHECK(with_value("/scene/stops/1/name", "gap") == "/scene/stops/1/name: two stops are called \"gap\"");
  CHECK(with_value("/scene/stops/0/at/node", "AA") == "/scene/stops/0/at/node: \"AA\": no such node; nearest A");
  CHECK_THAT(with_value("/scene/stops/0/at", 0.5), Contains("/scene/stops/0/at: expected a place: "));
  CHECK_THAT(with_value("/scene/stops/0/at", Json::parse(R"({"node": "A"})")), Contains("expected one of"));
  CHECK_THAT(with_value("/scene/stops/0/at", Json::parse(R"({"nod": "A"})")), Contains("did you mean \"node\"?"));
  CHECK_THAT(with_value("/scene/stops/0/at", Json::parse(R"({"node": "A", "direction": [1, 0]})")),
             Contains("/scene/stops/0/at/direction: expected three numbers"));
  CHECK_THAT(with_value("/scene/stops/0/uper", 0.1), Contains("did you mean \"upper\"?"));
  CHECK_THAT(with_value("/scene/stops", Json::parse(R"({"upper": 0.1})")), Contains("expected a list of stops"));
  CHECK_THAT(with_value("/scene/support", Json::parse(R"({"amplitude": 0.1, "pulsation": 3})")),
             Contains("/scene/support/amplitude: the table of dofs names no support that could move"));
  write_text(files.folder / "M.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1\n");
  CHECK(refused(assembled_study(), files.folder.path()) ==
        "/scene/structure/mass: M.mtx, line 3: end of file after 1 of 2 entries");
}

TEST_CASE("dofs begin as a file says, by number or by name") {
  const Files files;
  Json study = assembled_study();
  study["scene"]["initial"] = {{"file", "state.csv"}};
  const auto state = [&](const std::string& text) {
    write_text(files.folder / "state.csv", text);
    return Opened(study, files.folder.path()).study.cases.front().scene.initial.dofs;
  };
  for (const std::string& text : std::vector<std::string>{"dof,displacement,velocity\n2,0.01,-3\n",
                                                          "node,component,displacement,velocity\nB,ux,0.01,-3\n"}) {
    const auto dofs = state(text);
    REQUIRE(dofs.size() == 1);
    CHECK((dofs[0].dof == 2 && dofs[0].displacement == 0.01 && dofs[0].velocity == -3));
  }
  const auto wrong = [&](const std::string& text) {
    write_text(files.folder / "state.csv", text);
    return refused(study, files.folder.path());
  };
  CHECK(wrong("dof,displacement,velocity\n3,0,0\n") == "/scene/initial/file: state.csv, line 2: no dof 3 in dofs.csv");
  CHECK(wrong("node,component,displacement,velocity\nB,uy,0,0\n") ==
        "/scene/initial/file: state.csv, line 2: no dof B uy in dofs.csv");
  CHECK(wrong("dof,displacement,velocity\n1,0,0\n1,0,0\n") ==
        "/scene/initial/file: state.csv, line 3: dof 1 stands a second time");
  CHECK_THAT(wrong("dof,displacement,velocity\n1,0.3,0\n"),
             Contains("/scene/initial/file: the initial displacement is 0.3 m at stop gap, beyond the upper stop"));
  // A beam has formulas.
  Json beam = small_study();
  beam["scene"]["initial"]["file"] = "state.csv";
  CHECK_THAT(refused(beam, files.folder.path()),
             Contains("/scene/initial/file: the file of an initial state is one of"));
}

TEST_CASE("the old forms of a study are complete without the new keys") {
  const Study study = parse(small_study());
  CHECK_FALSE(study.resolved.contains("files"));
  CHECK_FALSE(study.resolved["scene"]["initial"].contains("file"));
  CHECK_FALSE(study.cases.front().scene_json["structure"].contains("digests"));
}
