// What `ricochet new` makes, taken as it comes: built, described and run by the commands that it prints, against the
// installed package alone.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/places.hpp"
#include "tests/plugins/installed.hpp"

using Catch::Matchers::Contains;
using ricochet::tests::places;

namespace {

/// The commands that it prints, one per indented line.
std::vector<std::string> commands_of(const std::string& text) {
  std::vector<std::string> commands;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("    ")) commands.push_back(line.substr(4));
  return commands;
}

/// Runs a printed command as a person would whose tools are those of this build.
Outcome obey(const fs::path& folder, const std::string& command) {
  const std::string tools = fs::path(places().cmake).parent_path().string();
  return shell(folder, "export PATH='" + tools + "':\"$PATH\" CXX='" + places().compiler + "' CXXFLAGS='" +
                           places().flags + "' CMAKE_GENERATOR='" + places().generator + "' RICOCHET_PLUGIN_PATH=; " +
                           command);
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& item : fs::directory_iterator(folder))
    if (const std::string name = item.path().filename().string(); name != ".out" && name != ".err")
      names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

struct Made {
  std::string role, name, example;
  std::string plugin() const { return name + "/build/plugins/" + role + "-" + name + ".so"; }
};

using Rows = std::vector<std::map<std::string, std::string>>;

/// A number in the row of a method, found by one more column.
double number(const Rows& rows, const Made& made, const std::string& method, const std::string& column,
              const std::string& value, const std::string& wanted) {
  for (const auto& row : rows)
    if (row.at(made.role) == method && (column.empty() || row.at(column) == value)) return std::stod(row.at(wanted));
  FAIL("no row of " + method + " with " + column + " = " + value);
  return 0;
}

/// What each example states of itself, seen in results. (That of time is held against the scheme that it is a case of
/// by the driver of plugins out of the tree.)
void see_what_it_states(const Prefix& installed, const fs::path& here, const Made& made) {
  const auto again = [&](const char* parameter, const std::vector<double>& values) {
    auto study = nlohmann::ordered_json::parse(read_text(here / made.name / "study.json"));
    for (auto& method : study["methods"][made.role])
      if (method.is_object() && method["name"] == made.name) method[parameter] = values;
    write_text(here / "again.json", study.dump());
    const Outcome run = installed.run(here, "run again.json --out again --fresh --plugin " + made.plugin());
    INFO(run.out << run.err);
    REQUIRE(run.code == 0);
    return read_cases(here / "again/cases.csv");
  };
  if (made.role == "contact") {
    // Without stiffening it is the penalty; another way to the same efforts, over 2000 steps of a motion below 0.2 m.
    const Rows rows = again("depth", {1e9});
    const double spring = number(rows, made, made.name, "step", "1e-04", "tip_displacement_end");
    CHECK(std::abs(spring - number(rows, made, "penalty", "step", "1e-04", "tip_displacement_end")) <= 1e-10);
    CHECK(number(rows, made, made.name, "step", "1e-04", "impacts") > 0);
  }
  if (made.role == "mass") {
    const Rows orders = read_cases(here / "results" / made.name / "orders.csv");
    // Four meshes, the order of the last is asymptotic to some hundredths.
    CHECK(number(orders, made, "consistent", "error", "tip-linf", "order") == Approx(2).margin(0.1));
    for (const auto& row : orders)
      if (row.at("mass.share") == "0.5" && row.at("error") == "tip-linf")
        CHECK(std::stod(row.at("order")) == Approx(4).margin(0.1));
    const Rows rows = again("share", {0, 1});
    for (const auto& [share, same] : {std::pair("0", "consistent"), std::pair("1", "lumped")})
      CHECK(number(rows, made, made.name, "mass.share", share, "error.tip-linf") ==
            Approx(number(rows, made, same, "", "", "error.tip-linf")).epsilon(1e-9));
  }
  if (made.role == "friction") {
    // The thicker film creeps from 0.0331 m to the same place as exact friction, within what it creeps back.
    const Rows rows = again("viscosity", {1e7});
    CHECK(std::abs(number(rows, made, made.name, "step", "1e-04", "tip_displacement_end") -
                   number(rows, made, "coulomb", "step", "1e-04", "tip_displacement_end")) <= 1e-6);
  }
  if (made.role == "reference") {
    // The two closed forms differ by their rounding, of motions below 0.2 m.
    for (const auto& one : read_cases(here / "results" / made.name / "cases.csv"))
      CHECK(std::stod(one.at("floor.tip-linf")) <= 1e-14);
  }
}

}  // namespace

TEST_CASE("what `ricochet new` makes is built, described and run by the commands that it prints") {
  const Prefix& installed = Prefix::once();
  const ScratchFolder here;
  // A digit first and a word of the language are names like any other.
  const Made made = GENERATE(Made{"time", "4th-try", "leap-frog"}, Made{"contact", "new", "stiffening-spring"},
                             Made{"mass", "my-mass", "blended-mass"},
                             Made{"friction", "my-film", "viscous-film"}, Made{"reference", "known", "free-oscillator"});
  CAPTURE(made.role);
  const Outcome told = installed.run(here.path(), "new " + made.role + " " + made.name);
  INFO(told.out << told.err);
  REQUIRE(told.code == 0);
  CHECK(names_in(here.path()) == std::vector<std::string>{made.name});
  std::vector<std::string> expected = {"CMakeLists.txt", "README.md", made.name + ".cpp", "study.json"};
  std::sort(expected.begin(), expected.end());
  CHECK(names_in(here / made.name) == expected);
  for (const std::string& file : expected) {
    CHECK_THAT(read_text(here / made.name / file), !Contains(made.example));
    CHECK_THAT(told.out, Contains(file));
  }
  const std::vector<std::string> commands = commands_of(told.out);
  REQUIRE(commands.size() == 3);

  const Outcome built = obey(here.path(), commands[0]);
  INFO(built.out << built.err);
  REQUIRE(built.code == 0);
  const std::string plugin = made.plugin();
  REQUIRE(fs::exists(here / plugin));
  const Outcome described = installed.run(here.path(), "describe " + made.name + " --plugin " + plugin);
  CHECK(described.code == 0);
  CHECK_THAT(described.out, Contains(made.name + " (" + made.role + ")"));

  const Outcome checked = obey(here.path(), commands[1]);
  INFO(checked.out << checked.err);
  CHECK(checked.code == 0);
  const Outcome run = obey(here.path(), commands[2]);
  INFO(run.out << run.err);
  REQUIRE(run.code == 0);
  const fs::path results = here / "results" / made.name;
  int mine = 0;
  for (const auto& one : read_cases(results / "cases.csv")) {
    if (made.role != "reference" && one.at(made.role) != made.name) continue;
    if (one.at("status") == "refused") continue;
    CHECK(one.at("status") == "done");
    ++mine;
  }
  CHECK(mine > 0);
  see_what_it_states(installed, here.path(), made);

  // Not twice, and not over another method.
  const Outcome again = installed.run(here.path(), "new " + made.role + " " + made.name);
  CHECK(again.code == 2);
  CHECK_THAT(again.err, Contains("\"" + made.name + "\" is here already"));
  const fs::path folder = (here / plugin).parent_path();
  fs::create_directory(here / "elsewhere");
  const Outcome shadowed = installed.run(here / "elsewhere", "new " + made.role + " " + made.name, folder.string());
  CHECK(shadowed.code == 2);
  CHECK_THAT(shadowed.err, Contains("would be shadowed") && Contains(plugin));
  CHECK(names_in(here / "elsewhere").empty());
}

TEST_CASE("a method that cannot be made is told, and nothing is written") {
  const Prefix& installed = Prefix::once();
  const ScratchFolder here;
  fs::create_directory(here / "full");
  fs::create_symlink("nowhere", here / "dangling");
  write_text(here / "file", "");
  const std::vector<std::string> before = names_in(here.path());
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"new", "an argument of new is missing"},
      {"new time", "an argument of new is missing"},
      {"new time a b", "does not expect \"b\""},
      {"new tine mine", "did you mean \"time\"?"},
      {"new law mine", "expected: \"plan\", \"mass\", \"contact\", \"friction\", \"time\", \"reference\""},
      {"new paln mine", "did you mean \"plan\"?"},
      {"new time Mine", "\"Mine\" cannot be the name of a method: expected small letters, digits and '-'"},
      {"new time my_scheme", "cannot be the name of a method"},
      {"new time ../mine", "cannot be the name of a method"},
      {"new time ''", "was given an empty argument"},
      {"new time -- -mine", "no '-' at its beginning"},
      {"new time newmark", "there is a time method \"newmark\" already"},
      {"new contact penalty", "would be shadowed"},
      {"new mass full", "\"full\" is here already"},
      {"new mass dangling", "\"dangling\" is here already"},
      {"new mass file", "\"file\" is here already"},
  };
  for (const auto& [words, part] : wrong) {
    INFO(words);
    const Outcome outcome = installed.run(here.path(), words);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains(part));
    CHECK(names_in(here.path()) == before);
  }
  // A name that only another role has is free.
  const Outcome other = installed.run(here.path(), "new mass newmark");
  CHECK(other.code == 0);
  CHECK(fs::exists(here / "newmark/newmark.cpp"));
}

TEST_CASE("a folder made by the program of a build tree finds that tree") {
  const ScratchFolder here;
  const Outcome told = shell(here.path(), "'" + places().command + "' new mass mine");
  INFO(told.out << told.err);
  REQUIRE(told.code == 0);
  const Outcome configured = obey(here.path(), "cmake -S mine -B mine/build -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF");
  INFO(configured.out << configured.err);
  CHECK(configured.code == 0);
  const Outcome target = shell(here.path(), "grep Ricochet_DIR mine/build/CMakeCache.txt");
  CHECK_THAT(target.out, Contains(places().build));
}
