#pragma once
#include <string>

namespace ricochet {

/// Tells apart processors, and C libraries, that compute other last digits: a hash of all bits of a forced beam at a
/// stop, marched some hundred steps by each kind of operator, and of values of the functions of <cmath>. Equal digests
/// are no proof that all bits are equal; unequal ones say that they are not. Computed once per process, in a few ms.
const std::string& arithmetic_digest();

}  // namespace ricochet
