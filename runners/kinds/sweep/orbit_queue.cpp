#include "runners/kinds/sweep/orbit_queue.hpp"

#include <algorithm>

namespace ricochet {

int OrbitQueue::add(OrbitTask task) {
  const int number = count();
  if (task.after >= 0) tasks_[static_cast<std::size_t>(task.after)].follower = number;
  tasks_.push_back(std::move(task));
  orbits_.emplace_back();
  done_.push_back(false);
  return number;
}

void OrbitQueue::restore(MarchedOrbits marched) {
  for (Orbit& orbit : marched.finished) {
    const auto number = static_cast<std::size_t>(orbit.task);
    if (number >= tasks_.size()) continue;
    done_[number] = true;
    if (!orbit.verdict) orbit.lane = tasks_[number].lane;
    orbits_[number] = std::move(orbit);
  }
  for (Orbit& orbit : marched.running) {
    const auto number = static_cast<std::size_t>(orbit.task);
    if (number >= tasks_.size() || done_[number]) continue;
    orbit.lane = tasks_[number].lane;
    waiting_.push_back(std::move(orbit));
  }
}

void OrbitQueue::open() {
  ready_.clear();
  resumed_.clear();
  open_ = 0;
  std::vector<bool> on_its_way(tasks_.size(), false);
  for (Orbit& orbit : waiting_) {
    on_its_way[static_cast<std::size_t>(orbit.task)] = true;
    resumed_.push_back(std::move(orbit));
  }
  waiting_.clear();
  for (std::size_t number = 0; number < tasks_.size(); ++number) {
    if (done_[number]) continue;
    ++open_;
    const int after = tasks_[number].after;
    if (!on_its_way[number] && (after < 0 || done_[static_cast<std::size_t>(after)]))
      ready_.push_back(static_cast<int>(number));
  }
  std::stable_partition(ready_.begin(), ready_.end(), [&](int number) { return chained(number); });
}

bool OrbitQueue::follows(int number) const {
  const int after = task(number).after;
  return after >= 0 && !orbits_[static_cast<std::size_t>(after)].now.slots.empty();
}

// An orbit whose start is another's end.
Orbit OrbitQueue::begin(int number) const {
  const OrbitTask& one = task(number);
  Orbit orbit;
  orbit.task = number;
  orbit.lane = one.lane;
  orbit.now = scenes_.carry(orbits_[static_cast<std::size_t>(one.after)].now, group(one.after), group(number));
  return orbit;
}

std::vector<Orbit> OrbitQueue::resume(int most) {
  std::vector<Orbit> orbits;
  while (!resumed_.empty() && static_cast<int>(orbits.size()) < most) {
    if (!orbits.empty() && group(resumed_.front().task) != group(orbits.front().task)) break;
    orbits.push_back(std::move(resumed_.front()));
    resumed_.pop_front();
  }
  return orbits;
}

OrbitQueue::Batch OrbitQueue::go_on(int lanes, int most) {
  Batch batch{resume(lanes), {}};
  if (batch.empty() || chained(batch.orbits.front().task)) return batch;
  Batch more = take(group(batch.orbits.front().task), most - static_cast<int>(batch.orbits.size()), false);
  batch.fresh = std::move(more.fresh);
  return batch;
}

void OrbitQueue::give_back(std::vector<Orbit> orbits) {
  for (Orbit& orbit : orbits) resumed_.push_back(std::move(orbit));
}

OrbitQueue::Batch OrbitQueue::take(int wanted, int most, std::optional<bool> chains) {
  Batch batch;
  int taken = 0;
  for (auto it = ready_.begin(); it != ready_.end() && taken < most;) {
    const int number = *it;
    if (wanted < 0) wanted = group(number);
    if (group(number) != wanted || (chains && *chains != chained(number))) {
      ++it;
      continue;
    }
    chains = chained(number);
    ++taken;
    it = ready_.erase(it);
    if (follows(number))
      batch.orbits.push_back(begin(number));
    else
      batch.fresh.push_back(number);
  }
  return batch;
}

void OrbitQueue::finish(Orbit orbit) {
  const auto number = static_cast<std::size_t>(orbit.task);
  if (orbit.stage == Orbit::Stage::stopped) {
    // What it began with, for a follower; nothing where that was its own initial state.
    orbit.now = follows(orbit.task) ? begin(orbit.task).now : LaneState{};
    orbit.entry = {};
  }
  fresh_.push_back(orbit.task);
  orbits_[number] = std::move(orbit);
  done_[number] = true;
  --open_;
  const int follower = tasks_[number].follower;
  if (follower >= 0 && !done_[static_cast<std::size_t>(follower)]) ready_.push_front(follower);
}

MarchedOrbits OrbitQueue::stock(const std::vector<std::vector<Orbit>>& marching) {
  MarchedOrbits marched;
  for (const int number : fresh_) marched.finished.push_back(orbits_[static_cast<std::size_t>(number)]);
  fresh_.clear();
  for (const auto& block : marching)
    for (const Orbit& orbit : block)
      if (!done_[static_cast<std::size_t>(orbit.task)]) marched.running.push_back(orbit);
  marched.running.insert(marched.running.end(), resumed_.begin(), resumed_.end());
  return marched;
}

}  // namespace ricochet
