#pragma once
#include <filesystem>
#include <string>

namespace ricochet {

/// The processors that this process may keep busy: the least of four numbers. They are those online, its affinity
/// (taskset, cpusets, a scheduler that binds), the quota of its control group, and what Slurm allocated.
struct AllowedProcessors {
  int count = 1;
  int online = 1;
  std::string limit;  ///< what allows fewer than are online: "the affinity of this process"; "": nothing does

  /// "8", or "4 of 64 (SLURM_CPUS_PER_TASK)".
  std::string text() const;
};

/// Asks anew each time. The quota of a control group (version 1 and 2, the group's own and those above it) is rounded
/// up to whole processors. `root` is where /proc and /sys are looked for. Throws InputError where SLURM_CPUS_PER_TASK
/// or SLURM_CPUS_ON_NODE is set to something else than a number of processors.
AllowedProcessors allowed_processors(const std::filesystem::path& root = "/");

}  // namespace ricochet
