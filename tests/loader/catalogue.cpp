#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <ricochet/contract/abi.hpp>
#include <ricochet/contract/errors.hpp>
#include <ricochet/contract/float_control.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/loader/catalogue.hpp>

#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

namespace {

const fs::path installed = tests::places().plugins;

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
  Catalogue catalogue(tests::places().libraries, {}, {});
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

namespace fs = std::filesystem;

namespace {

const fs::path library = fs::path(tests::places().plugins) / "reference.so";

}  // namespace

TEST_CASE("the exported symbols of a library are read without loading it") {
  std::vector<std::string> names;
  for (const auto& symbol : exported_symbols(library, "ricochet_"))
    if (!symbol.name.starts_with("ricochet_layout__")) names.push_back(symbol.name);
  CHECK(std::is_sorted(names.begin(), names.end()));
  CHECK(names == std::vector<std::string>{abi_tag(), "ricochet_own", "ricochet_provides__reference__event_driven",
                                          "ricochet_provides__reference__event_driven_semi_discrete",
                                          "ricochet_provides__reference__exact", "ricochet_register"});
  CHECK(exported_symbols(library, "ricochet_provides__").size() == 3);
  CHECK(exported_symbols(library, "no_such_prefix").empty());
}

TEST_CASE("the size of a symbol is that of its object") {
  const auto stage = exported_symbols(library, "ricochet_layout__Stage");
  REQUIRE(stage.size() == 1);
  CHECK(stage.front().size == sizeof(Stage));
  CHECK(exported_symbols(library, "ricochet_provides__").front().size == 1);
}

TEST_CASE("the id of a build is that of its code, wherever the file lies, and of no other") {
  const ScratchFolder here;
  const std::string id = build_id(library);
  CHECK(id.size() == 20);  // SHA-1
  fs::copy_file(library, here / "copy.so");
  CHECK(build_id(here / "copy.so") == id);
  CHECK(build_id(fs::path(tests::places().plugins) / "time.so") != id);
  CHECK(build_id("/proc/self/exe").size() == 20);
  write_text(here / "text.so", "not a library");
  CHECK_THROWS_WITH(build_id(here / "text.so"), "not a shared library");
  // A note that says it is longer than its section.
  std::string bytes = read_text(library);
  const std::size_t note = bytes.find(std::string("\x04\0\0\0\x14\0\0\0\x03\0\0\0GNU", 15));
  REQUIRE(note != std::string::npos);
  bytes[note + 7] = '\x7f';
  write_text(here / "long.so", bytes);
  CHECK(build_id(here / "long.so").empty());
}

TEST_CASE("symbols that a library only uses are not its own") {
  // Every plugin calls the registry, whose mangled name begins like this.
  CHECK(exported_symbols(library, "_ZN8ricochet8Registry").empty());
}

TEST_CASE("a file that is no shared library says why") {
  const ScratchFolder here;
  write_text(here / "text.so", "not a library");
  CHECK_THROWS_WITH(exported_symbols(here / "text.so", ""), "not a shared library");
  write_text(here / "empty.so", "");
  CHECK_THROWS_WITH(exported_symbols(here / "empty.so", ""), "not a shared library");
  write_text(here / "short.so",
             "\x7f"
             "ELF");
  CHECK_THROWS_WITH(exported_symbols(here / "short.so", ""), Contains("damaged"));
  fs::create_directory(here / "folder.so");
  CHECK_THROWS_WITH(exported_symbols(here / "folder.so", ""), "not a file");
  CHECK_THROWS_WITH(exported_symbols(here / "absent.so", ""), "not a file");

  std::string other = read_text(library);
  other[18] = '\x28';  // e_machine: ARM
  other[19] = 0;
  write_text(here / "arm.so", other);
  CHECK_THROWS_WITH(exported_symbols(here / "arm.so", ""), "built for another processor");
  other = read_text(library);
  other[16] = 1;  // e_type: an object file
  write_text(here / "object.so", other);
  CHECK_THROWS_WITH(exported_symbols(here / "object.so", ""), Contains("another kind of binary"));
}

TEST_CASE("a truncated library is damaged, wherever it was cut") {
  const ScratchFolder here;
  const std::string whole = read_text(library);
  for (int part = 1; part < 64; ++part) {
    write_text(here / "cut.so", whole.substr(0, whole.size() * static_cast<std::size_t>(part) / 64));
    CHECK_THROWS_WITH(exported_symbols(here / "cut.so", "ricochet_"), Contains("damaged"));
  }
}

TEST_CASE("whatever its bytes, a file is read or refused, never more") {
  const ScratchFolder here;
  const std::string whole = read_text(library);
  std::mt19937 random(20240611);
  // The header and the section table, which everything else is found through, and a few bytes anywhere.
  const std::size_t sections = whole.size() > 4096 ? whole.size() - 4096 : 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::string bytes = whole;
    for (int k = 0; k < 4; ++k) {
      bytes[random() % 64] =
          static_cast<char>(trial % 3 == 0 && k < 2 ? random() : static_cast<unsigned char>(bytes[0]));
      bytes[sections + random() % (whole.size() - sections)] = static_cast<char>(random());
      bytes[random() % whole.size()] = static_cast<char>(random());
    }
    bytes.replace(0, 20, whole, 0, 20);
    write_text(here / "flipped.so", bytes);
    try {
      exported_symbols(here / "flipped.so", "ricochet_");
    } catch (const std::runtime_error& error) {
      CHECK_FALSE(std::string(error.what()).empty());
    }
  }
}
