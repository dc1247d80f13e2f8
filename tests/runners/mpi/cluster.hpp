#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

#include "tests/runners/mpi/launch.hpp"

namespace launch {

/// A cluster of Slurm on this machine: two nodes of two processors, over the loopback interface alone. It has a key,
/// ports and a folder of its own. It ends with this object, with everything that runs on it.
class Cluster {
 public:
  Cluster();
  ~Cluster();
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  /// Why it is not there; "" where it is.
  const std::string& failure() const { return failure_; }
  /// A line of a shell that speaks to it.
  std::string line(const std::string& words) const;
  /// What such a line writes.
  std::string answer(const std::string& words) const;
  /// Whether both nodes are up and have nothing to do, nor to clear away.
  bool rests() const;
  /// Submits a script; the number of the job.
  std::string submit(const std::string& script) const;
  /// What the submitted job wrote.
  std::string job_output() const { return (scratch_ / "job.out").string(); }
  /// What `scontrol show job` says under a key: "JobState".
  std::string of_job(const std::string& job, const std::string& key) const;
  /// Ends all of a node as if its power had gone: its daemon, the step daemons, then the ranks.
  void cut_off(const std::string& node) const;
  /// The node comes back, with nothing in its temporary folders.
  void switch_on(const std::string& node) const;

 private:
  void start();
  /// Processes of this cluster with this in their environment.
  std::vector<pid_t> processes_with(const std::string& word) const;
  bool daemon(const std::string& words, const std::string& pid_file);

  ScratchFolder scratch_;
  std::string failure_;
  std::vector<std::string> pid_files_;
};

}  // namespace launch
