#pragma once
#include <stdexcept>

namespace ricochet {

/// The results folder cannot serve (exit code 5). The message names the path, says what was found and what was
/// expected, and what to do.
class StoreError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace ricochet
