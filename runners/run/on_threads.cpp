#include "runners/run/on_threads.hpp"

#include <system_error>
#include <thread>
#include <vector>

namespace ricochet {

void on_threads(int threads, const std::function<void()>& body) {
  std::vector<std::thread> others;
  try {
    for (int i = 1; i < threads; ++i) others.emplace_back(body);
  } catch (const std::system_error&) {
    // No room for another one: fewer do it all.
  }
  body();
  for (std::thread& one : others) one.join();
}

}  // namespace ricochet
