#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// effects: per measure of the motion, the share of its spread that each choice explains; no rows where fewer than two
/// choices vary.
Table effects_table(const StudyResults& results);

}  // namespace ricochet
