#pragma once
#include "runners/answers/answer.hpp"

namespace ricochet {

/// What a study of basins says: which share of the starts ends in which motion, whether methods move the border, and
/// whether it is fractal.
answers::Answer basins_answer(const answers::Compared& study);

}  // namespace ricochet
