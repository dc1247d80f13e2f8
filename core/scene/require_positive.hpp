#pragma once

namespace ricochet {

/// Throws InputError at /scene/structure/`key` unless the value is finite and above 0; `what` names it in the sentence.
void require_positive(double value, const char* key, const char* what, const char* unit);

}  // namespace ricochet
