#include <algorithm>
#include <catch2/catch.hpp>
#include <ricochet/contract/errors.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/loader/float_control.hpp>

#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

namespace {

const fs::path installed = RICOCHET_PLUGIN_DIR;

fs::path link(const ScratchFolder& here, const std::string& plugin, const std::string& name) {
  fs::create_directories((here / name).parent_path());
  fs::create_symlink(installed / plugin, here / name);
  return here / name;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

TEST_CASE("methods are known by name before anything is opened") {
  const Catalogue catalogue(installed, {}, {});
  CHECK(catalogue.opened().empty());
  CHECK(catalogue.unusable().empty());
  CHECK(catalogue.folders() == std::vector<fs::path>{installed});
  std::size_t count = 0;
  for (const Role role : all_roles) {
    const auto names = catalogue.names(role);
    CHECK(std::is_sorted(names.begin(), names.end()));
    CHECK_FALSE(names.empty());
    count += names.size();
  }
  CHECK(count == catalogue.provided().size());
  CHECK(contains(catalogue.names(Role::mass), "consistent"));
  CHECK_FALSE(contains(catalogue.names(Role::time), "consistent"));
  // The symbol spells '-' as '_'.
  CHECK(contains(catalogue.names(Role::time), "newmark-dumont-paoli"));
}

TEST_CASE("only the library that is required is opened, and once") {
  Catalogue catalogue(installed, {}, {});
  Registry registry;
  CHECK(catalogue.require(Role::mass, "lumped", registry));
  CHECK(catalogue.opened() == std::vector<fs::path>{installed / "mass.so"});
  CHECK(catalogue.require(Role::mass, "singular", registry));
  CHECK(catalogue.opened().size() == 1);
  CHECK(registry.names(Role::mass) == catalogue.names(Role::mass));
  CHECK(registry.names(Role::time).empty());
  CHECK(registry.file(Role::mass, "lumped") == (installed / "mass.so").string());
  CHECK(catalogue.require(Role::contact, "none", registry));
  CHECK(catalogue.opened().size() == 2);
}

TEST_CASE("a name that no file provides is not required") {
  Catalogue catalogue(installed, {}, {});
  Registry registry;
  CHECK_FALSE(catalogue.require(Role::time, "no-such-scheme", registry));
  CHECK_FALSE(catalogue.require(Role::time, "lumped", registry));
  CHECK(catalogue.unusable_provider(Role::time, "no-such-scheme") == nullptr);
  CHECK(catalogue.opened().empty());
}

TEST_CASE("a method that the process registered itself needs no library") {
  Catalogue catalogue(installed, {}, {});
  Registry registry;
  registry.add_mass({"lumped", "Mine.", "", "", {}}, [](const Parameters&) { return nullptr; });
  CHECK(catalogue.require(Role::mass, "lumped", registry));
  CHECK(catalogue.opened().empty());
  CHECK(registry.manual(Role::mass, "lumped")->summary == "Mine.");
}

TEST_CASE("open_all opens every library, once each") {
  Catalogue catalogue(installed, {}, {});
  Registry registry;
  catalogue.open_all(registry);
  CHECK(catalogue.unusable().empty());
  for (const Role role : all_roles) CHECK(registry.names(role) == catalogue.names(role));
  CHECK(catalogue.opened().size() == all_roles.size());
  catalogue.open_all(registry);
  CHECK(catalogue.opened().size() == all_roles.size());
}

TEST_CASE("the install folder comes first, then folders in order, then single files") {
  const ScratchFolder here;
  link(here, "mass.so", "first/mass.so");
  link(here, "mass.so", "second/mass.so");
  link(here, "time.so", "second/time.so");
  const fs::path file = link(here, "time.so", "file.so");
  const auto provider = [](Catalogue catalogue, Role role, const std::string& name) {
    Registry registry;
    REQUIRE(catalogue.require(role, name, registry));
    CHECK(catalogue.opened().size() == 1);
    return registry.file(role, name);
  };
  const auto lumped = [&](Catalogue catalogue) { return provider(std::move(catalogue), Role::mass, "lumped"); };
  const auto newmark = [&](Catalogue catalogue) { return provider(std::move(catalogue), Role::time, "newmark"); };
  const std::vector<fs::path> folders = {here / "first", here / "second"};
  CHECK(lumped({installed, folders, {file}}) == (installed / "mass.so").string());
  CHECK(lumped({here / "nowhere", folders, {file}}) == (here / "first/mass.so").string());
  CHECK(lumped({here / "second", {here / "first"}, {file}}) == (here / "second/mass.so").string());
  CHECK(newmark({here / "nowhere", folders, {file}}) == (here / "second/time.so").string());
  CHECK(newmark({here / "nowhere", {here / "first"}, {file}}) == file.string());

  const Catalogue catalogue(here / "nowhere", folders, {file});
  const Catalogue own(installed, {}, {});
  CHECK(catalogue.names(Role::mass) == own.names(Role::mass));
  // The later ones are kept, as shadowed.
  CHECK(catalogue.provided().size() == 2 * (own.names(Role::mass).size() + own.names(Role::time).size()));
  CHECK(catalogue.folders().size() == 3);
}

TEST_CASE("files in folders that cannot serve are kept with their reason") {
  const ScratchFolder here;
  write_text(here / "notes.txt", "not looked at");
  write_text(here / "text.so", "not a library");
  write_text(here / "time-my-own.so", "not a library");
  fs::create_directory(here / "folder.so");
  fs::create_symlink(here / "nowhere", here / "dangling.so");
  fs::create_symlink(installed.parent_path() / "libricochet-core.so", here / "core.so");
  const Catalogue catalogue(here.path(), {}, {});
  std::vector<std::string> told;
  for (const Unusable& file : catalogue.unusable()) told.push_back(file.file.filename().string() + ": " + file.reason);
  REQUIRE(told.size() == 5);
  CHECK_THAT(told[0], StartsWith("core.so: a shared library, but no Ricochet plugin"));
  CHECK(told[1] == "dangling.so: no such file");
  CHECK(told[2] == "folder.so: not a file");
  CHECK(told[3] == "text.so: not a shared library");
  CHECK(told[4] == "time-my-own.so: not a shared library");

  SECTION("a file name ROLE-NAME.so says what it was meant to be") {
    const Unusable* meant = catalogue.unusable_provider(Role::time, "my-own");
    REQUIRE(meant != nullptr);
    CHECK(meant->file.filename() == "time-my-own.so");
    CHECK(catalogue.unusable_provider(Role::mass, "my-own") == nullptr);
    CHECK(catalogue.unusable_provider(Role::time, "text") == nullptr);
  }
}

TEST_CASE("a single file that cannot serve is an error at once") {
  const ScratchFolder here;
  write_text(here / "text.so", "not a library");
  CHECK_THROWS_AS(Catalogue(installed, {}, {here / "text.so"}), PluginError);
  CHECK_THROWS_WITH(Catalogue(installed, {}, {here / "text.so"}),
                    (here / "text.so").string() + ": not a shared library");
  CHECK_THROWS_WITH(Catalogue(installed, {}, {here / "absent.so"}), (here / "absent.so").string() + ": no such file");
}

TEST_CASE("a folder that does not exist holds nothing") {
  const Catalogue catalogue("/nonexistent", {"/nonexistent/too"}, {});
  CHECK(catalogue.provided().empty());
  CHECK(catalogue.unusable().empty());
  CHECK(catalogue.folders().size() == 2);
}

TEST_CASE("a library that switches denormal numbers off as it is loaded does so for nobody else") {
  const KeepFloatControl test;
  set_float_control(float_control() & ~flushing_bits());
  const std::uint64_t before = float_control();
  Catalogue catalogue(RICOCHET_TEST_LIBRARIES, {}, {});
  Registry registry;
  CHECK(catalogue.require(Role::time, "flushing", registry));
  CHECK(catalogue.opened().size() == 1);
  CHECK(float_control() == before);
}

TEST_CASE("a file that is no library provides what its reader found in it") {
  const auto stand_in = [](const char* name) {
    Registry methods;
    methods.set_current_file("here.json");
    methods.add_time({name, "A stand-in.", "", "", {}}, [](const Parameters&) { return nullptr; });
    return methods;
  };
  Catalogue catalogue(installed, {}, {});
  catalogue.provide("here.json", stand_in("mine"));
  catalogue.provide("later.json", stand_in("mine"));
  CHECK(contains(catalogue.names(Role::time), "mine"));
  CHECK(catalogue.opened().empty());
  Registry registry;
  REQUIRE(catalogue.require(Role::time, "mine", registry));
  CHECK(registry.file(Role::time, "mine") == "here.json");
  CHECK(catalogue.opened() == std::vector<fs::path>{"here.json"});

  // Before all others, where its reader says so.
  Catalogue explicitly(installed, {}, {});
  explicitly.provide("later.json", stand_in("mine"));
  explicitly.provide("here.json", stand_in("mine"), true);
  Registry other;
  REQUIRE(explicitly.require(Role::time, "mine", other));
  CHECK(other.file(Role::time, "mine") == "here.json");
}
