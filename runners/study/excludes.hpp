#pragma once
#include "runners/study/study.hpp"

namespace ricochet {

/// Marks the cases that `exclude` names: a list of objects {axis: value or list of values, …, "why": reason}; a case is
/// left out when every axis named has (one of) the value(s) given. Throws InputError for an unknown axis, a value that
/// no case has, a combination that matches nothing, a missing reason, and when nothing remains.
void apply_excludes(const Json& excludes, Study& study);

}  // namespace ricochet
