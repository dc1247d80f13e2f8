#include "runners/run/environment.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "runners/store/fingerprint.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

TEST_CASE("environment: every entry says something, and plugin libraries come with a hash") {
  const ScratchFolder scratch;
  write_text(scratch / "mass-x.so", "code");
  const Environment environment = describe_environment({scratch / "mass-x.so"});
  std::map<std::string, std::string> entries(environment.entries.begin(), environment.entries.end());
  for (const char* name : {"program", "commit", "compiler", "contract", "lanes", "build type", "flags", "processor", "cores",
                           "instruction sets", "kernel", "libraries", "plugin mass-x.so", "started"}) {
    INFO(name);
    CHECK_FALSE(entries[name].empty());
  }
  CHECK_THAT(entries["libraries"], Catch::Contains("Eigen 3.4") && Catch::Contains("SQLite 3."));
  CHECK_THAT(entries["plugin mass-x.so"], Catch::Contains("mass-x.so ("));
}

TEST_CASE("environment: values that changed between two runs are both told, once") {
  const Environment old{{{"processor", "a"}, {"kernel", "k"}, {"started", "1"}}};
  const Environment now{{{"processor", "b"}, {"kernel", "k"}, {"started", "2"}}};
  using Entries = std::vector<std::pair<std::string, std::string>>;
  const Environment merged = merge_environments(now, old);
  CHECK(merged.entries ==
        Entries{{"processor", "b"}, {"kernel", "k"}, {"started", "2"}, {"processor (earlier cases)", "a"}});
  CHECK(merge_environments(now, merged).entries == merged.entries);
}
