// Where the files of a study may lie, what their names may be, and that nothing is said of those that lie elsewhere.
#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>

#include "runners/json/json_text.hpp"
#include "runners/study/study_files.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace data_files_tests {
namespace {

const std::string secret = "root:x:0:0";

/// A study in its folder; beside that, another one with files of somebody else.
struct Folders {
  ScratchFolder scratch;
  Folders() {
    fs::create_directories(scratch / "study/sub");
    fs::create_directories(scratch / "elsewhere");
    write_text(scratch / "study/a.csv", "t,F\n0,0\n1,1\n");
    write_text(scratch / "elsewhere/a.csv", "t,F\n0,0\n1,1\n");
    write_text(scratch / "elsewhere/passwd", secret + "\n");
  }
  fs::path folder() const { return scratch / "study"; }
};

Json with_table(const std::string& file) {
  Json study = small_study();
  study["scene"]["load"] =
      Json::parse(R"json([{"at": 1.5, "force": {"file": "a.csv", "value": "F", "after": "hold"}}])json");
  study["scene"]["load"][0]["force"]["file"] = file;
  return study;
}

std::string fault(const Json& json, const fs::path& folder) {
  Registry registry = stand_ins();
  Catalogue catalogue{"/nonexistent", {}, {}};
  return testing::input_error([&] { parse_study(json.dump(1), catalogue, registry, folder); }, "");
}

}  // namespace

TEST_CASE("a file lies in the study's folder, links followed, unless the study allows another place") {
  const Folders folders;
  const fs::path folder = folders.folder();
  CHECK(fault(with_table("a.csv"), folder).empty());
  // A link within the folder is one of its files.
  fs::create_symlink("a.csv", folder / "inside.csv");
  CHECK(fault(with_table("inside.csv"), folder).empty());
  fs::create_symlink(folders.scratch / "elsewhere/a.csv", folder / "link.csv");
  fs::create_directory_symlink(folders.scratch / "elsewhere", folder / "linked");
  fs::create_symlink(folders.scratch / "elsewhere/passwd", folder / "passwd.csv");
  for (const std::string& name :
       std::vector<std::string>{"link.csv", "linked/a.csv", "passwd.csv", "sub/../../elsewhere/passwd",
                                "linked/../linked/passwd", (folders.scratch / "elsewhere/a.csv").string()}) {
    const std::string said = fault(with_table(name), folder);
    CHECK_THAT(said, Contains("is outside the folder of the study") && !Contains(secret));
  }
  for (const std::string name : {"link.csv", "linked/a.csv"}) {
    Json study = with_table(name);
    study["outside"] = true;
    CHECK(fault(study, folder).empty());
  }
}

TEST_CASE("a plan that lies elsewhere and is none is refused without what it says") {
  const Folders folders;
  fs::create_symlink(folders.scratch / "elsewhere/passwd", folders.folder() / "plan.json");
  for (const std::string name : {"plan.json", "../elsewhere/passwd", "/etc/passwd"}) {
    Json study = small_study();
    study["methods"]["time"] = {{"name", "plan"}, {"file", name}};
    CHECK_THAT(fault(study, folders.folder()), Contains("lies outside the folder of the study") && !Contains("root"));
  }
}

TEST_CASE("names of files have no zero, no control characters, and are UTF-8") {
  const Folders folders;
  for (const std::string& name : {std::string("a.csv\0x", 7), std::string("a\x1b[2J.csv"), std::string("a\n\r.csv"),
                                  std::string("a\u202E.csv")}) {
    const std::string said = fault(with_table(name), folders.folder());
    CHECK_THAT(said, Contains("expected the name of a file without them"));
    CHECK(said.find('\x1b') == std::string::npos);
    CHECK(said.find('\0') == std::string::npos);
    Json study = small_study();
    study["methods"]["time"] = {{"name", "plan"}, {"file", name}};
    CHECK_THAT(fault(study, folders.folder()), Contains("expected the path of a plan without them"));
  }
}

TEST_CASE("what is larger than it may be, or has no size, is refused before it is read") {
  const Folders folders;
  write_text(folders.scratch / "large.json", "{");
  fs::resize_file(folders.scratch / "large.json", largest_text + 1);
  const auto refused = [](const fs::path& file) { return testing::input_error([&] { read_text(file, "a study"); }); };
  CHECK_THAT(refused(folders.scratch / "large.json"), Contains("has more than 32 MiB"));
  CHECK_THAT(refused("/dev/zero"), Contains("is a pipe, a socket or a device"));
  fs::resize_file(folders.folder() / "a.csv", std::uintmax_t{1} << 33U);  // takes no room
  CHECK_THAT(fault(with_table("a.csv"), folders.folder()), Contains("has 8192 MiB; the limit is 256 MiB"));
  Json study = with_table("/dev/zero");
  study["outside"] = true;
  CHECK_THAT(fault(study, folders.folder()), Contains("is no file; expected one that can be read"));
}

TEST_CASE("a file that has changed since a study was opened, or is gone, is told as changed") {
  const Folders folders;
  Registry registry = stand_ins();
  Catalogue catalogue{"/nonexistent", {}, {}};
  const Json stored = parse_study(with_table("a.csv").dump(), catalogue, registry, folders.folder()).resolved;
  CHECK(fault(stored, {}).empty());
  write_text(folders.folder() / "a.csv", "t,F\n0,0\n1,2\n");
  CHECK_THAT(fault(stored, {}), Contains(std::string("a.csv ") + changed_since));
  fs::remove(folders.folder() / "a.csv");
  CHECK_THAT(fault(stored, {}), Contains(std::string("a.csv ") + changed_since));
}

TEST_CASE("whatever stands in the place of a value, a study is read or refused") {
  Json study = with_table("a.csv");
  study["observe"] = {"status", "impulse"};
  study["exclude"] = Json::parse(R"json([{"mass": "poor", "why": "as it is"}])json");
  study["window"] = {{"from", 0.01}, {"to", 0.02}};
  study["snapshots"] = 5;
  const Folders folders;
  const std::vector<Json> values = {nullptr,
                                    true,
                                    -1,
                                    0.5,
                                    1e300,
                                    "",
                                    "x",
                                    Json::array(),
                                    Json::object(),
                                    Json::array({nullptr}),
                                    Json::array({"x", nullptr}),
                                    Json::array({Json::array({1})}),
                                    Json{{"a", nullptr}},
                                    Json{{"name", nullptr}}};
  int refused = 0, read = 0;
  const std::function<void(const std::string&)> visit = [&](const std::string& pointer) {
    const Json here = study.at(Json::json_pointer(pointer));
    for (const Json& value : values) {
      Json changed = study;
      changed[Json::json_pointer(pointer)] = value;
      CAPTURE(pointer, value);
      std::string said;
      CHECK_NOTHROW(said = fault(changed, folders.folder()));
      (said.empty() ? read : refused) += 1;
    }
    if (!here.is_structured()) return;
    for (const auto& [key, ignored] : here.items())
      visit(here.is_array() ? pointer + "/" + key : pointer_to(pointer, key));
  };
  for (const auto& [key, ignored] : study.items()) visit(pointer_to("", key));
  CHECK(refused > 200);
  CHECK(read > 20);
}

}  // namespace data_files_tests
