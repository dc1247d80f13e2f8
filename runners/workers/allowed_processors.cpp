#include "runners/workers/allowed_processors.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <ricochet/contract/errors.hpp>
#include <string_view>
#include <vector>

namespace ricochet {
namespace {

namespace fs = std::filesystem;

constexpr double unlimited = std::numeric_limits<double>::infinity();

int online_processors() {
  return static_cast<int>(std::max(1L, ::sysconf(_SC_NPROCESSORS_ONLN)));
}

/// Those that the scheduler of the system may run this process on; all that are online where it does not say.
int affine_processors(int online) {
  constexpr int most = 1 << 20;
  for (int size = 1024; size <= most; size *= 2) {  // the kernel refuses a set that is smaller than its own
    cpu_set_t* set = CPU_ALLOC(size);
    if (set == nullptr) return online;
    const std::size_t bytes = CPU_ALLOC_SIZE(size);
    const bool known = ::sched_getaffinity(0, bytes, set) == 0;
    const int count = known ? CPU_COUNT_S(bytes, set) : 0;
    const bool small = !known && errno == EINVAL;
    CPU_FREE(set);
    if (known) return std::max(1, count);
    if (!small) break;
  }
  return online;
}

/// Processor seconds per second that files of one group grant.
double quota_of_group(const fs::path& group) {
  double quota = 0, period = 0;
  if (std::ifstream both(group / "cpu.max"); both >> quota >> period)  // version 2; "max" is no number
    return quota > 0 && period > 0 ? quota / period : unlimited;
  std::ifstream first(group / "cpu.cfs_quota_us"), second(group / "cpu.cfs_period_us");  // version 1; -1: no quota
  if (first >> quota && second >> period) return quota > 0 && period > 0 ? quota / period : unlimited;
  return unlimited;
}

/// The least of a group and all above it; a container sees itself at the top, whatever its path says.
double quota_of_path(const fs::path& hierarchy, fs::path group) {
  double least = quota_of_group(hierarchy);
  for (group = group.relative_path(); !group.empty(); group = group.parent_path())
    least = std::min(least, quota_of_group(hierarchy / group));
  return least;
}

double control_group_quota(const fs::path& root) {
  const fs::path mounted = root / "sys/fs/cgroup";
  double least = unlimited;
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {  // "4:cpu,cpuacct:/path", or "0::/path" of version 2
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
    std::vector<fs::path> hierarchies;
    if (controllers.empty())
      hierarchies = {mounted, mounted / "unified"};
    else if (("," + controllers + ",").find(",cpu,") != std::string::npos)
      hierarchies = {mounted / controllers, mounted / "cpu"};
    for (const fs::path& hierarchy : hierarchies) least = std::min(least, quota_of_path(hierarchy, path));
  }
  return least;
}

/// What a variable of Slurm allows; 0 where it is not set.
int allocated(const char* variable) {
  const char* set = std::getenv(variable);
  const std::string_view text = set != nullptr ? set : "";
  if (text.empty()) return 0;
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 1)
    throw InputError("", fmt::format("{} is \"{}\"; expected a number of processors", variable, text));
  return count;
}

}  // namespace

std::string AllowedProcessors::text() const {
  return limit.empty() ? std::to_string(count) : fmt::format("{} of {} ({})", count, online, limit);
}

AllowedProcessors allowed_processors(const fs::path& root) {
  AllowedProcessors found;
  found.count = found.online = online_processors();
  const auto limit = [&](int count, const std::string& what) {
    if (count >= found.count) return;
    found.count = count;
    found.limit = what;
  };
  limit(affine_processors(found.online), "the affinity of this process");
  if (const double quota = control_group_quota(root); quota < found.count)
    limit(static_cast<int>(std::ceil(quota)), fmt::format("a quota of its control group, {:.3g}", quota));
  for (const char* variable : {"SLURM_CPUS_PER_TASK", "SLURM_CPUS_ON_NODE"})
    if (const int count = allocated(variable); count > 0) limit(count, variable);
  return found;
}

}  // namespace ricochet
