#pragma once
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "runners/workers/host_messages.hpp"
#include "runners/workers/remote_hosts.hpp"

namespace ricochet {

/// The life of an agent: tells the coordinator (rank 0) what its machine is, starts workers there and passes on what
/// they and the coordinator say, until it is sent home; false where nothing was heard of the coordinator for `silence`
/// seconds. It computes nothing itself: nothing that a plugin does can end it. All workers are gone when it returns.
bool serve_as_agent(Transport& transport, const HostFacts& facts,
                    const std::function<std::unique_ptr<Worker>()>& start_worker, double silence = lost_after);

/// The facts of the machine that this process runs on. What is wrong with it is their `failure`.
HostFacts facts_of_this_machine(int rank);

/// Workers for each machine: those of ranks that share one share its processors.
std::vector<int> workers_of(const std::vector<HostFacts>& machines);

/// Why these machines cannot march one study together, a line for each that cannot; "" where they can. The first one
/// is the coordinator's.
std::string objections(const std::vector<HostFacts>& machines);

/// What is odd, though it works: a line for each rank that is bound to fewer processors than its machine has.
std::string oddities(const std::vector<HostFacts>& machines, const std::vector<int>& workers);

/// "4 workers on 3 machines: a 2, b 1, c 1".
std::string words_of(const std::vector<HostFacts>& machines, const std::vector<int>& workers);

/// The machines of a run, the coordinator's first. `jobs`: workers of each; 0: what workers_of() says.
std::vector<std::shared_ptr<WorkerHost>> hosts_of(RemoteHosts& remote, const std::vector<HostFacts>& machines,
                                                  int jobs);

}  // namespace ricochet
