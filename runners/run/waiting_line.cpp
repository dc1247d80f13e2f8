#include "runners/run/waiting_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "runners/march/seconds.hpp"
#include "runners/run/say.hpp"

namespace ricochet {
namespace {

constexpr std::chrono::milliseconds on_a_terminal{500}, in_a_log{10000};

// Since when nothing was said: waits one after the other are one wait.
std::atomic<std::chrono::steady_clock::time_point> quiet_since{std::chrono::steady_clock::now()};

std::chrono::milliseconds left_of(std::chrono::milliseconds wait) {
  const auto gone =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - quiet_since.load());
  return std::max(wait - gone, std::chrono::milliseconds(0));
}

}  // namespace

WaitingLine::WaitingLine(std::string what, std::FILE* out)
    : WaitingLine(std::move(what), out, is_terminal(out), left_of(is_terminal(out) ? on_a_terminal : in_a_log)) {}

WaitingLine::WaitingLine(std::string what, std::FILE* out, bool terminal, std::chrono::milliseconds after)
    : what_(std::move(what)), out_(out), terminal_(terminal), after_(after) {
  try {
    teller_ = std::thread([this] { tell(); });
  } catch (const std::system_error&) {
    // Without a thread for it nothing is said.
  }
}

WaitingLine::~WaitingLine() {
  {
    const std::lock_guard guard(mutex_);
    ended_ = true;
  }
  wake_.notify_all();
  if (teller_.joinable()) teller_.join();
  if (!told_) return;
  if (terminal_) say_in_place(out_, "");
  quiet_since = std::chrono::steady_clock::now();
}

std::string WaitingLine::text() const {
  const std::size_t of = of_;
  return what_ + (of > 0 ? fmt::format(", {} of {}", parts_.load(), of) : "") +
         fmt::format(", {:.0f} s", seconds_since(begin_));
}

void WaitingLine::tell() {
  std::unique_lock lock(mutex_);
  const auto is_over = [this] { return ended_; };
  if (wake_.wait_for(lock, after_, is_over)) return;
  told_ = true;
  if (!terminal_) return say(out_, text() + "\n");
  do say_in_place(out_, text());
  while (!wake_.wait_for(lock, redrawn_every, is_over));
}

}  // namespace ricochet
