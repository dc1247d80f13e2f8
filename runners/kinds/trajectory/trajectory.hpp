#pragma once
#include "runners/kinds/kind.hpp"

namespace ricochet {

/// Each case marches its scene once: energies, impacts, a curve over time.
Kind trajectory_kind();

/// "energy 3.61 J → 3.02 J (−16.4 %), 12 impacts, 0.8 µs/step": what a marched case has of these.
std::string energies_text(const CaseRecord& record);

}  // namespace ricochet
