#pragma once
#include <signal.h>

#include <array>
#include <string>
#include <vector>

namespace ricochet {

/// The program that workers are: this one, found even where its file was replaced meanwhile; never one that is an MPI
/// rank.
const std::string& worker_program();

/// The environment variables of a worker, "NAME=value": those of this process without what a parallel launcher put
/// there for its own ranks, and with one thread for its BLAS where nothing else is said.
std::vector<std::string> worker_environment();

/// Signals that are for the coordinator, which tells its workers: schedulers send them to every process of a job. A
/// worker is born with them held back, and ignores them from its first line on.
inline constexpr std::array<int, 4> signals_of_coordinator = {SIGINT, SIGTERM, SIGUSR1, SIGHUP};
/// These, as a set.
sigset_t coordinator_signals();

}  // namespace ricochet
