#pragma once
#include <functional>

namespace ricochet {

/// Runs `work(worker)` on so many threads, all for the case of this one, and returns the processor seconds that they
/// took. What one of them throws is thrown when all have returned. A worker must not count on the others: there may be
/// fewer threads.
double run_workers(int workers, const std::function<void(int worker)>& work);

}  // namespace ricochet
