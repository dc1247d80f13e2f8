#include "runners/workers/allowed_processors.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <catch2/catch.hpp>
#include <thread>

#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/variable.hpp"

using namespace ricochet;
using Catch::Contains;

namespace {

/// What a tree of /proc and /sys grants, with no other limit than that of the machine.
AllowedProcessors under(const std::string& cgroup, const std::vector<std::pair<std::string, std::string>>& files) {
  const ScratchFolder root;
  std::filesystem::create_directories(root / "proc/self");
  write_text(root / "proc/self/cgroup", cgroup);
  for (const auto& [file, text] : files) {
    const auto path = root / ("sys/fs/cgroup/" + file);
    std::filesystem::create_directories(path.parent_path());
    write_text(path, text);
  }
  return allowed_processors(root.path());
}

}  // namespace

TEST_CASE("allowed processors: without limits they are those of the machine, and nothing is said") {
  const Variable task("SLURM_CPUS_PER_TASK", {}), node("SLURM_CPUS_ON_NODE", "");
  const ScratchFolder nothing;
  const AllowedProcessors found = allowed_processors(nothing.path());
  CHECK(found.count >= 1);
  CHECK(found.count <= found.online);
  if (found.count == found.online) {
    CHECK(found.limit.empty());
    CHECK(found.text() == std::to_string(found.online));
  }
}

TEST_CASE("allowed processors: the affinity of the process counts") {
  const Variable task("SLURM_CPUS_PER_TASK", {}), node("SLURM_CPUS_ON_NODE", {});
  AllowedProcessors found;
  std::thread([&] {  // an affinity is that of a thread
    cpu_set_t before, one;
    REQUIRE(::sched_getaffinity(0, sizeof before, &before) == 0);
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++i)
      if (CPU_ISSET(i, &before)) CPU_SET(i, &one);
    REQUIRE(::sched_setaffinity(0, sizeof one, &one) == 0);
    found = allowed_processors();
  })
      .join();
  CHECK(found.count == 1);
  if (found.online > 1) CHECK(found.text() == fmt::format("1 of {} (the affinity of this process)", found.online));
}

TEST_CASE("allowed processors: the quota of a control group and of those above it, of both versions, rounded up") {
  const Variable task("SLURM_CPUS_PER_TASK", {}), node("SLURM_CPUS_ON_NODE", {});
  const std::string none = "max 100000\n", half = "50000 100000\n";
  const int free = under("", {}).count;
  const std::string v2 = "0::/slurm/job_1/step_0\n", v1 = "9:memory:/job\n4:cpu,cpuacct:/slurm/job\n0::/\n";
  CHECK(under(v2, {{"slurm/job_1/step_0/cpu.max", none}}).count == free);
  CHECK(under(v2, {{"slurm/job_1/step_0/cpu.max", half}}).count == 1);
  CHECK(under(v2, {{"slurm/job_1/step_0/cpu.max", none}, {"slurm/job_1/cpu.max", half}}).count == 1);
  CHECK(under(v2, {{"unified/slurm/cpu.max", half}}).count == 1);
  CHECK(under(v2, {{"slurm/job_2/cpu.max", half}}).count == free);
  CHECK(under(v2, {{"cpu.max", half}}).count == 1);  // a container
  CHECK(under(v2, {{"cpu.max", "oddly 100000\n"}}).count == free);
  const auto files = [](const std::string& folder, int quota) {
    return std::vector<std::pair<std::string, std::string>>{{folder + "/cpu.cfs_quota_us", std::to_string(quota)},
                                                            {folder + "/cpu.cfs_period_us", "100000"}};
  };
  CHECK(under(v1, files("cpu,cpuacct/slurm/job", 30000)).count == 1);
  CHECK(under(v1, files("cpu/slurm", 30000)).count == 1);
  CHECK(under(v1, files("cpu/slurm", -1)).count == free);
  CHECK(under(v1, files("memory/job", 30000)).count == free);
  if (free > 1) {
    CHECK(under(v2, {{"slurm/cpu.max", "110000 100000"}}).count == 2);
    const AllowedProcessors one = under(v2, {{"slurm/cpu.max", half}});
    CHECK(one.text() == fmt::format("1 of {} (a quota of its control group, 0.5)", one.online));
  }
}

TEST_CASE("allowed processors: what Slurm allocated, the lesser of task and node, nonsense is not guessed at") {
  const ScratchFolder nothing;
  const Variable node("SLURM_CPUS_ON_NODE", "100000");
  {
    const Variable task("SLURM_CPUS_PER_TASK", "1");
    const AllowedProcessors found = allowed_processors(nothing.path());
    CHECK(found.count == 1);
    if (found.online > 1) CHECK(found.limit == "SLURM_CPUS_PER_TASK");
  }
  for (const char* wrong : {"0", "-2", "two", "2.5", "4(x2)", "99999999999"}) {
    const Variable task("SLURM_CPUS_PER_TASK", wrong);
    CHECK_THROWS_WITH(allowed_processors(nothing.path()),
                      Contains("SLURM_CPUS_PER_TASK") && Contains(wrong) && Contains("expected a number"));
  }
}
