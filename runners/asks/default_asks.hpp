#pragma once
#include <string>
#include <vector>

#include "runners/asks/evidence.hpp"

namespace ricochet::asks {

/// What a study that asks nothing is asked: what becomes of its cases, where `runs`; the value of each of these
/// measures, four at most; the effect of the choice that it compares on the first of them.
std::vector<Ask> asks_of_measures(const Evidence& evidence, const std::vector<std::string>& measures, bool runs);

/// Entries of `ask` that such a study could have, to be copied: three at most.
std::vector<std::string> proposals(const Evidence& evidence, const std::vector<std::string>& measures);

}  // namespace ricochet::asks
