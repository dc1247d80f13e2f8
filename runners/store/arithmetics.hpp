#pragma once
#include <string>

#include "runners/store/record.hpp"

namespace ricochet {

/// The entry of an environment that is the digest of the processor's arithmetic (arithmetic_digest.hpp).
inline constexpr const char* kArithmetic = "arithmetic";

/// Puts in the environment what arithmetic the finished cases were computed with, in the place of what runs have said
/// of themselves: the digest, or all of them with their numbers of cases. Nothing where no case says.
void tell_arithmetics(StudyResults& results);

/// Under which key motions of runs of one arithmetic are stored: those of another are not found.
std::string motion_key(const std::string& arithmetic, const std::string& key);

}  // namespace ricochet
