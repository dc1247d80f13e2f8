#pragma once
#include "runners/asks/ask.hpp"

/// \file
/// One function per verb, each in a file of its own name.
namespace ricochet::asks {

const Verb& value_verb();
const Verb& rank_verb();
const Verb& limit_verb();
const Verb& effect_verb();
const Verb& threshold_verb();
const Verb& cheapest_verb();
const Verb& order_verb();
const Verb& enough_verb();
const Verb& motions_verb();
const Verb& points_verb();
const Verb& steps_verb();
const Verb& runs_verb();

}  // namespace ricochet::asks
