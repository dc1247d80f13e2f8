#pragma once
#include "runners/answers/answer.hpp"

namespace ricochet {

/// What a continuation study says: where the orbits of the reference case have special points, with interval and order,
/// what each choice moves the first of them by, which cases lack it, and what turns a step invents.
answers::Answer continuation_answer(const answers::Compared& study);

}  // namespace ricochet
