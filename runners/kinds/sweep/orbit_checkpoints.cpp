#include "runners/kinds/sweep/orbit_checkpoints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

constexpr const char* orbits_mark = "orbits 9";
constexpr const char* exponents_mark = "exponents 4";

}  // namespace

std::string to_bytes(const MarchedOrbits& marched) {
  return to_bytes(marched, orbits_mark);
}

MarchedOrbits marched_orbits(const std::string& bytes) {
  return from_bytes<MarchedOrbits>(bytes, orbits_mark);
}

std::string to_bytes(const std::vector<OrbitExponents>& batch) {
  return to_bytes(batch, exponents_mark);
}

std::vector<OrbitExponents> orbit_exponents(const std::string& bytes) {
  return from_bytes<std::vector<OrbitExponents>>(bytes, exponents_mark);
}

std::string OrbitCheckpoints::part(int number) const {
  return fmt::format("orbits/{}/{}", key_, number < 0 ? "now" : std::to_string(number));
}

MarchedOrbits OrbitCheckpoints::find() {
  MarchedOrbits all;
  if (!checkpoints_.find) return all;
  bool whole = true;
  for (; !checkpoints_.find(part(parts_)).empty(); ++parts_) {
    auto some = recall(checkpoints_, part(parts_), marched_orbits);
    whole = whole && some;
    if (some) std::move(some->finished.begin(), some->finished.end(), std::back_inserter(all.finished));
  }
  // An orbit on its way that follows one of a part that is lost would be begun again when that one ends.
  if (!whole) return all;
  if (auto now = recall(checkpoints_, part(-1), marched_orbits)) all.running = std::move(now->running);
  return all;
}

void OrbitCheckpoints::save(const MarchedOrbits& marched) {
  if (!checkpoints_.keep) return;
  // What thousands of workers have ended meanwhile is in memory several times while it becomes bytes.
  constexpr std::ptrdiff_t together = 1024;
  for (auto from = marched.finished.begin(); from != marched.finished.end();) {
    const auto to = from + std::min(together, marched.finished.end() - from);
    checkpoints_.keep(part(parts_++), to_bytes(MarchedOrbits{{from, to}, {}}));
    from = to;
  }
  checkpoints_.keep(part(-1), to_bytes(MarchedOrbits{{}, marched.running}));
}

void OrbitCheckpoints::forget() {
  if (!checkpoints_.keep) return;
  for (int i = 0; i < parts_; ++i) checkpoints_.keep(part(i), "");
  checkpoints_.keep(part(-1), "");
}

std::string ExponentCheckpoints::part(std::size_t batch) const {
  return fmt::format("exponents/{}/{}", key_, batch);
}

void ExponentCheckpoints::note(std::size_t batch) {
  const std::lock_guard guard(mutex_);
  kept_.insert(batch);
}

void ExponentCheckpoints::serve(ExponentTask& task) {
  if (!checkpoints_.find || !checkpoints_.keep) return;
  task.find = [this](std::size_t batch) {
    auto exponents = recall(checkpoints_, part(batch), orbit_exponents);
    if (exponents) note(batch);
    return exponents.value_or(std::vector<OrbitExponents>());
  };
  task.keep = [this](std::size_t batch, const std::vector<OrbitExponents>& exponents) {
    checkpoints_.keep(part(batch), to_bytes(exponents));
    note(batch);
  };
}

void ExponentCheckpoints::forget() {
  for (const std::size_t batch : kept_) checkpoints_.keep(part(batch), "");
}

}  // namespace ricochet
