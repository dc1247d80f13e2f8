#pragma once
#include <functional>

namespace ricochet {

/// Runs `body` on so many threads, this one among them, until each has returned; `body` must not throw.
void on_threads(int threads, const std::function<void()>& body);

}  // namespace ricochet
