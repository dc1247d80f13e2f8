#pragma once
#include <string>

#include "runners/store/record.hpp"

namespace ricochet {

/// The entry of this name; "" where there is none.
std::string environment_entry(const Environment& environment, const std::string& name);

/// The value of an entry without the place of a library: of a plugin's, "…/libricochet-x.so (hash)", the hash, for the
/// same library is the same wherever it lies.
std::string without_place(const std::string& name, const std::string& value);

/// The entry of an environment that is the digest of the processor's arithmetic (runners/march/study_identity.hpp).
inline constexpr const char* kArithmetic = "arithmetic";

/// Puts in the environment what arithmetic the finished cases were computed with, in the place of what runs have said
/// of themselves: the digest, or all of them with their numbers of cases. Nothing where no case says.
void tell_arithmetics(StudyResults& results);

/// Under which key motions of runs of one arithmetic are stored: those of another are not found.
std::string motion_key(const std::string& arithmetic, const std::string& key);

/// The environment of a resumed run: `now`, plus one entry "NAME (earlier cases)" for each value that was another when
/// the kept cases ran.
Environment merge_environments(const Environment& now, const Environment& earlier);

}  // namespace ricochet
