#pragma once
#include <string>

namespace ricochet {

/// Who runs: which process on which machine, and of which job of a scheduler.
struct RunIdentity {
  std::string host;
  int process = 0;
  std::string started;  ///< UTC
  std::string job;      ///< SLURM_JOB_ID; "" outside of Slurm
  int restart = 0;      ///< SLURM_RESTART_COUNT

  /// "process 4711 on n012, job 815 (restart 2), started 2026-05-01T12:00:00Z".
  std::string text() const;
  /// Whether this is a later start of the same job: the scheduler took the other one for lost, and started it again.
  bool succeeds(const RunIdentity& other) const;

  std::string to_json() const;
  /// What is not there stays as it is above.
  static RunIdentity from_json(const std::string& json);
};

/// Now: "2026-05-01T12:00:00Z".
std::string utc_time();

/// This process, now.
RunIdentity this_run();

}  // namespace ricochet
