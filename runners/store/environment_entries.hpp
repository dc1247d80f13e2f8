#pragma once
#include <string>

#include "runners/store/record.hpp"

namespace ricochet {

/// The entry of this name; "" where there is none.
std::string environment_entry(const Environment& environment, const std::string& name);

/// The value of an entry without the place of a library: of a plugin's, "…/libricochet-x.so (hash)", the hash, for the
/// same library is the same wherever it lies.
std::string without_place(const std::string& name, const std::string& value);

}  // namespace ricochet
