#pragma once
#include "runners/answers/answer.hpp"

namespace ricochet {

/// What a stability study says: who has no largest step, the largest step of each scheme with the level that has it,
/// what a closed contact changes, and whether marches agree.
answers::Answer stability_answer(const answers::Compared& study);

}  // namespace ricochet
