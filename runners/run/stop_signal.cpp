#include "runners/run/stop_signal.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>

namespace ricochet {
namespace {

constexpr std::array<int, 4> kSignals = {SIGINT, SIGTERM, SIGUSR1, SIGXFSZ};

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");
std::atomic<int> signals_seen{0};
std::array<struct sigaction, kSignals.size()> handlers_before;

extern "C" void on_stop(int signal) {
  stop_requested = true;
  // A scheduler's warning is no order, however often it comes.
  if (signal != SIGUSR1 && ++signals_seen > 1) ::_exit(kInterrupted);
}

}  // namespace

StopSignal::StopSignal() {
  stop_requested = false;
  signals_seen = 0;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction action {};
    action.sa_handler = kSignals[i] == SIGXFSZ ? SIG_IGN : on_stop;
    action.sa_flags = SA_RESTART;  // a write to the store goes on
    ::sigaction(kSignals[i], &action, &handlers_before[i]);
  }
}

StopSignal::~StopSignal() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &handlers_before[i], nullptr);
}

std::atomic<bool>& StopSignal::requested() const {
  return stop_requested;
}

}  // namespace ricochet
