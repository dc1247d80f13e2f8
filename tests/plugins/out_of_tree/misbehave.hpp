#pragma once
#include <unistd.h>

#include <cstdlib>
#include <ricochet/contract/plugin.hpp>
#include <string>

/// What a plugin must not do, by name; "none" does nothing.
inline const std::vector<std::string> misdeeds = {"none", "segv", "abort", "exit", "overflow", "loop", "throw"};

[[gnu::noinline]] inline int without_end(int depth) {
  volatile int room[1000] = {};
  room[depth % 1000] = depth;
  return depth < 0 ? 0 : without_end(depth + 1) + room[7];
}

/// A sanitizer of undefined behaviour, which would end the process in its own way, does not look at it.
__attribute__((no_sanitize("undefined"))) inline void misbehave(const std::string& how) {
  if (how == "segv") *static_cast<volatile int*>(nullptr) = 1;
  if (how == "abort") std::abort();
  if (how == "exit") std::exit(0);
  if (how == "overflow") static_cast<void>(without_end(1));
  if (how == "throw") throw 42;
  if (how == "loop")
    for (volatile bool go = true; go;) {
    }
}

inline ricochet::ParameterSpec misdeed_parameter() {
  return ricochet::word_parameter("how", misdeeds, "none", "what it does that no plugin may do");
}
