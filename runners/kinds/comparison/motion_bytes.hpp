#pragma once
#include <ricochet/contract/reference.hpp>
#include <string>

namespace ricochet {

/// A reference motion as bytes, bit for bit.
std::string to_bytes(const ReferenceMotion& motion);

/// The motion that to_bytes() was given; throws std::runtime_error for bytes that are none.
ReferenceMotion motion_from_bytes(const std::string& bytes);

}  // namespace ricochet
