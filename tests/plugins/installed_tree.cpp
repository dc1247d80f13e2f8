// What `cmake --install` lays down, used from where it lies and after it was moved.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/plugins/installed.hpp"

using Catch::Matchers::Contains;

TEST_CASE("installed: the links of all pages hold") {
  const fs::path data = Prefix::once().prefix() / "share/ricochet";
  int pages = 0, links = 0;
  for (const auto& item : fs::recursive_directory_iterator(data)) {
    if (item.path().extension() != ".md") continue;
    ++pages;
    const std::string text = read_text(item.path());
    for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
      const std::string target = text.substr(at + 2, text.find(')', at) - at - 2);
      if (target.starts_with("#") || target.starts_with("http")) continue;
      CAPTURE(item.path(), target);
      CHECK(fs::exists(item.path().parent_path() / target.substr(0, target.find('#'))));
      ++links;
    }
  }
  CHECK(pages >= 40);
  CHECK(links >= 100);
}

TEST_CASE("installed: the files that the page about plans names are there") {
  const fs::path prefix = Prefix::once().prefix(), plans = prefix / "share/ricochet/plugins/plan_files";
  const std::string page = read_text(plans.parent_path() / "plan-files.md");
  for (const char* name : {"newmark", "bathe", "moreau-jean", "laursen-love", "kane"}) {
    INFO(name);
    CHECK_THAT(page, Contains(std::string("`") + name + ".json`"));
    CHECK(fs::exists(plans / (std::string(name) + ".json")));
  }
  CHECK_THAT(page, Contains("`ricochet/contract/step_plan.hpp`"));
  CHECK(fs::exists(prefix / "include/ricochet/contract/step_plan.hpp"));
}

TEST_CASE("installed: manual pages and completions are there") {
  const fs::path share = Prefix::once().prefix() / "share";
  for (const char* page : {"man/man1/ricochet.1", "man/man5/ricochet-study.5"}) {
    INFO(page);
    CHECK((fs::exists(share / page) || fs::exists(share / (std::string(page) + ".gz"))));
  }
  for (const char* file : {"bash-completion/completions/ricochet", "zsh/site-functions/_ricochet",
                           "fish/vendor_completions.d/ricochet.fish"}) {
    INFO(file);
    CHECK_THAT(read_text(share / file), Contains("jobs"));
  }
}

TEST_CASE("installed: a study runs, also where the installation was moved to") {
  const ScratchFolder here;
  const fs::path moved = here / "elsewhere";
  fs::copy(Prefix::once().prefix(), moved, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  const Outcome run = shell(here.path(),
                            "RICOCHET_PLUGIN_PATH= elsewhere/bin/ricochet run "
                            "elsewhere/share/ricochet/studies/quick.json");
  INFO(run.out << run.err);
  CHECK(run.code == 0);
  CHECK(fs::exists(here / "results/quick/report.html"));
  const Outcome doctor = shell(here.path(), "RICOCHET_PLUGIN_PATH= elsewhere/bin/ricochet doctor");
  CHECK_THAT(doctor.out, Contains((moved / "lib/ricochet").string()) && Contains((moved / "share/ricochet").string()));
}

TEST_CASE("installed: CMake says at once all that it does not find") {
  const ScratchFolder here;
  const auto& places = ricochet::tests::places();
  const Outcome configured =
      shell(here.path(), "'" + places.cmake + "' -S '" + places.source + "' -B build -G '" + places.generator +
                             "' -DCMAKE_CXX_COMPILER='" + places.compiler +
                             "' -DRICOCHET_TESTS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON "
                             "-DCMAKE_DISABLE_FIND_PACKAGE_LibArchive=ON -DCMAKE_IGNORE_PATH=/usr/include");
  INFO(configured.out << configured.err);
  CHECK(configured.code != 0);
  CHECK_THAT(configured.err, Contains("Ricochet needs, and CMake does not find here:"));
  for (const char* name : {"Eigen 3.4 (Debian: libeigen3-dev)", "libarchive (Debian: libarchive-dev)", "Spectra 1.0",
                           "SQLiteCpp", "cereal", "kainjow mustache"})
    CHECK_THAT(configured.err, Contains(name));
}
