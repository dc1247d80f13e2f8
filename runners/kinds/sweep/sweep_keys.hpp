#pragma once
#include "runners/study/field.hpp"

/// \file
/// The keys that the kinds which go through a parameter share.
namespace ricochet {

/// How long an orbit is marched and what is read of it: transient, keep, section, phase.
std::vector<Field> orbit_keys();

/// from, to, count; `what`: what count numbers.
ObjectForm swept_range(const char* what);

/// pointer: what the values replace.
Field swept_pointer();

}  // namespace ricochet
