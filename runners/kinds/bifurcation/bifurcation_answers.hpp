#pragma once
#include "runners/answers/answer.hpp"

namespace ricochet {

/// What a bifurcation study says: which methods give the diagram of the reference, how it converges in the step, where
/// the motion is the same whatever the numerics, which motions these are, and where they change.
answers::Answer bifurcation_answer(const answers::Compared& study);

}  // namespace ricochet
