#include <fmt/format.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cmath>

#include "runners/march/seconds.hpp"
#include "runners/run/say.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

constexpr double kLineEverySeconds = 2;
constexpr double kElsewhereEverySeconds = 5;
// A case in flight that should have ended is expected to take so much more of what it took.
constexpr double kOverrun = 0.1;
// s that a case takes beside its integration before any was seen: a transaction of the store on a usual disk.
constexpr double kFirstGuess = 0.02;
// s beyond twice the prediction after which a case is waited for.
constexpr double kPatience = 5;

int terminal_width(std::FILE* out) {
  winsize size{};
  constexpr int usual = 80;
  return ::ioctl(::fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

}  // namespace

CaseCost::CaseCost() {
  constexpr double little = 0.1;  // the first cases that are seen outweigh the guess
  note(0, kFirstGuess, little);
}

void CaseCost::note(double predicted, double measured, double weight) {
  w_ += weight;
  wx_ += weight * predicted;
  wy_ += weight * measured;
  wxx_ += weight * predicted * predicted;
  wxy_ += weight * predicted * measured;
}

void CaseCost::add(double predicted, double measured) {
  // Relative to what was measured, no shorter than what a clock and a disk tell.
  constexpr double shortest = 1e-3;
  const double scale = kFirstGuess / std::max(measured, shortest);
  note(predicted, measured, scale * scale);
}

double CaseCost::seconds(double predicted, int cases) const {
  const double spread = w_ * wxx_ - wx_ * wx_;
  double factor = 1, constant = wy_ / w_;
  if (spread > 1e-9 * w_ * wxx_) {
    factor = std::max((w_ * wxy_ - wx_ * wy_) / spread, 0.0);
    constant = (wy_ - factor * wx_) / w_;
    if (constant < 0) {
      constant = 0;
      factor = wxy_ / wxx_;
    }
  }
  return factor * predicted + constant * cases;
}

double progress_fraction(const ProgressState& state) {
  if (state.total == 0 || state.done >= state.total) return 1;
  if (state.work_total > 0) return std::clamp(state.work_done / state.work_total, 0.0, 1.0);
  return static_cast<double>(state.done) / state.total;
}

std::string progress_text(const ProgressState& state) {
  const double fraction = progress_fraction(state);
  std::string text = fmt::format("{}/{} cases, {:.0f} %", state.done, state.total, std::floor(100 * fraction));
  if (state.done > 0 && state.elapsed > 0) {
    const double rate = state.done / state.elapsed;
    text += rate >= 1 ? fmt::format(", {:.1f} cases/s", rate) : fmt::format(", {:.1f} cases/min", 60 * rate);
  }
  if (!state.waits_for.empty()) return text + ", waiting for " + state.waits_for;
  if (fraction > 0 && fraction < 1 && state.elapsed > 1) {
    const double left = state.elapsed * (1 - fraction) / fraction;
    text += fmt::format(", {} left", left < 1 ? "less than 1 s" : duration_text(left));
  }
  return text;
}

std::string progress_bar(const ProgressState& state, int width) {
  const std::string text = progress_text(state);
  constexpr int widest = 40, narrowest = 5, frame = 3;
  const int cells = std::min(widest, width - frame - static_cast<int>(text.size()));
  if (cells < narrowest) return text.substr(0, static_cast<std::size_t>(std::max(width, 0)));
  const int full = static_cast<int>(progress_fraction(state) * cells);
  return fmt::format("[{:#>{}}{:->{}}] {}", "", full, "", cells - full, text);
}

Progress::Progress(std::FILE* out, bool terminal, int total, double predicted_seconds, const std::atomic<bool>& stop,
                   std::function<void(const std::string&)> elsewhere)
    : out_(out),
      terminal_(terminal),
      stop_(stop),
      total_(total),
      waiting_(predicted_seconds),
      elsewhere_(std::move(elsewhere)) {
  refresher_ = std::thread([this] { refresh(); });
}

Progress::~Progress() {
  {
    const std::lock_guard guard(mutex_);
    ended_ = true;
  }
  wake_.notify_all();
  refresher_.join();
  erase();
}

void Progress::started(const std::string& id, double predicted_seconds) {
  const std::lock_guard guard(mutex_);
  in_flight_[id] = {Clock::now(), predicted_seconds};
  waiting_ -= predicted_seconds;
}

void Progress::finished(const std::string& id) {
  const std::lock_guard guard(mutex_);
  const auto found = in_flight_.find(id);
  if (found != in_flight_.end()) {
    const double took = seconds_since(found->second.since);
    cost_.add(found->second.predicted, took);
    measured_ += took;
    in_flight_.erase(found);
  }
  ++done_;
  if (terminal_) {
    draw();
  } else if (done_ < total_ && seconds_since(last_line_) >= kLineEverySeconds) {
    draw();
  }
}

void Progress::waiting(const std::string& id, const std::string& call) {
  const std::lock_guard guard(mutex_);
  if (call.empty())
    calls_.erase(id);
  else
    calls_[id] = call;
}

// The case that is most beyond what was predicted of it, "" where none is by far.
std::string Progress::overdue() const {
  double most = kPatience;
  std::string text;
  for (const auto& [id, flight] : in_flight_) {
    const double seconds = seconds_since(flight.since), predicted = cost_.seconds(flight.predicted);
    if (seconds - 2 * predicted < most) continue;
    most = seconds - 2 * predicted;
    const auto call = calls_.find(id);
    text = fmt::format("case {}, {} so far, {} predicted{}", id, duration_text(seconds), duration_text(predicted),
                       call == calls_.end() ? "" : ": " + call->second);
  }
  return text;
}

ProgressState Progress::state() const {
  double done = measured_, left = 0;
  for (const auto& [id, flight] : in_flight_) {
    const double took = seconds_since(flight.since);
    done += took;
    left += std::max(cost_.seconds(flight.predicted) - took, kOverrun * took);
  }
  // Differences of sums: what is left of it when none waits is round-off.
  const int waiting = total_ - done_ - static_cast<int>(in_flight_.size());
  if (waiting > 0) left += cost_.seconds(std::max(waiting_, 0.0), waiting);
  return {done_, total_, done, done + left, seconds_since(begin_), overdue()};
}

void Progress::draw() {
  last_line_ = Clock::now();
  if (terminal_)
    say_in_place(out_, progress_bar(state(), terminal_width(out_) - 1));
  else
    say(out_, fmt::format("{}\n", progress_text(state())));
}

void Progress::erase() {
  if (terminal_) say_in_place(out_, "");
}

void Progress::refresh() {
  std::unique_lock lock(mutex_);
  while (!ended_) {
    if (stop_ && !stop_told_) {
      stop_told_ = true;
      erase();
      say(out_, "stopping: what is under way is stored as far as it can be (once more ends at once)\n");
    }
    if (terminal_ || seconds_since(last_line_) >= 5 * kLineEverySeconds) draw();
    if (elsewhere_ && seconds_since(told_elsewhere_) >= kElsewhereEverySeconds) {
      told_elsewhere_ = Clock::now();
      const std::string text = progress_text(state());
      lock.unlock();
      elsewhere_(text);
      lock.lock();
      continue;
    }
    wake_.wait_for(lock, redrawn_every);
  }
}

std::string versions_text(const Store& store) {
  const auto counted = [](int count) { return fmt::format("{} result{}", count, count == 1 ? "" : "s"); };
  const int back = store.returned(), aside = store.aside(), others = store.of_other_arithmetic();
  std::string text;
  if (back > 0)
    text += fmt::format("{} that {} kept aside {} back\n", counted(back), back == 1 ? "was" : "were",
                        back == 1 ? "is" : "are");
  if (aside > 0)
    text += fmt::format(
        "{} of an earlier version {} kept aside: {} back when the study (and its plugins) are again as "
        "they were, and {} with --fresh\n",
        counted(aside), aside == 1 ? "is" : "are", aside == 1 ? "it comes" : "they come", aside == 1 ? "goes" : "go");
  if (others > 0)
    text += fmt::format(
        "{} case{} computed with other last digits than those of this processor and C library, and kept; "
        "the environment says which\n",
        others, others == 1 ? " was" : "s were");
  return text;
}

std::string other_part_text(const std::filesystem::path& folder, const std::string& study, const StudyPart& held,
                            const StudyPart& wanted) {
  return fmt::format(
      "{}: this folder holds {} of \"{}\", and {} was asked for: go on with that one, choose another folder with "
      "--out, or forget what is there with --fresh{}",
      folder.string(), held.whole() ? "all the cases" : held.text(), study,
      wanted.whole() ? "the whole study" : wanted.text(), held.whole() ? "" : " (`ricochet merge` joins parts)");
}

std::string interrupted_text(const std::filesystem::path& folder, const StudyResults& results) {
  const auto under_way =
      std::count_if(results.cases.begin(), results.cases.end(), [](const CaseRecord& one) { return one.partial; });
  return fmt::format(
      "interrupted: {} of {} cases are finished{} and kept in {}. Run the same command again to go on; \"ricochet "
      "report {}\" shows what is there\n",
      results.cases.size() - static_cast<std::size_t>(under_way), results.expected_cases,
      under_way > 0 ? fmt::format(", {} under way,", under_way) : "", folder.string(), folder.string());
}

}  // namespace ricochet
