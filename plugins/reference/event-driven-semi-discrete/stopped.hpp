#pragma once
#include <string>

namespace ricochet::reference {

/// Thrown inside a solve, a Refusal outside.
struct Stopped {
  std::string sentence;
};

}  // namespace ricochet::reference
