#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <ricochet/algebra/infinity.hpp>
#include <ricochet/engine/available_memory.hpp>
#include <string>

namespace ricochet {
namespace {

constexpr double kilobyte = 1024;

// A number that stands alone in a file, or behind a word in it.
std::optional<double> number_in(const char* file, const std::string& word = "") {
  std::ifstream in(file);
  std::string found;
  double number = 0;
  while (!word.empty() && in >> found)
    if (found == word) break;
  if (in >> number) return number;
  return std::nullopt;
}

}  // namespace

double available_memory() {
  double least = infinity;
  if (const auto free = number_in("/proc/meminfo", "MemAvailable:")) least = *free * kilobyte;
  const auto group = number_in("/sys/fs/cgroup/memory.max"), used = number_in("/sys/fs/cgroup/memory.current");
  if (group && used) least = std::min(least, std::max(0.0, *group - *used));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    if (const auto taken = number_in("/proc/self/status", "VmSize:"))
      least = std::min(least, std::max(0.0, static_cast<double>(limit.rlim_cur) - *taken * kilobyte));
  return least;
}

}  // namespace ricochet
