#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "runners/workers/machines.hpp"

namespace ricochet {

/// What a rank of a run on several machines does: rank 0 is the command, with workers on all machines; the others serve
/// it. `lost`: whether a machine was, so that the ranks cannot all be waited for. Returns the exit code of the command,
/// 0 for an agent.
int run_rank(Transport& transport, const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
             bool& lost);

}  // namespace ricochet
