#pragma once
#include <functional>
#include <memory>

#include "runners/workers/host_messages.hpp"
#include "runners/workers/transport.hpp"

namespace ricochet {

/// The life of an agent: tells the coordinator (rank 0) what its machine is, starts workers there and passes on what
/// they and the coordinator say, until it is sent home; false where nothing was heard of the coordinator for `silence`
/// seconds. It computes nothing itself: nothing that a plugin does can end it. All workers are gone when it returns.
bool serve_as_agent(Transport& transport, const HostFacts& facts,
                    const std::function<std::unique_ptr<Worker>()>& start_worker, double silence = lost_after);

}  // namespace ricochet
