#pragma once
#include "runners/table/table.hpp"

namespace ricochet {

/// `curves`, without rows: the sampled series of one trajectory, curves/ID.csv.
Table curves_head();

}  // namespace ricochet
