#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// The environment of a resumed run: `now`, plus one entry "NAME (earlier cases)" for each value that was another when
/// the kept cases ran.
Environment merge_environments(const Environment& now, const Environment& earlier);

}  // namespace ricochet
