#include "runners/kinds/sweep/distributed_orbits.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <stdexcept>

#include "runners/kinds/sweep/block_orders.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"

namespace ricochet {
namespace {

using What = BlockStatus::What;
using Clock = std::chrono::steady_clock;

constexpr double block_seconds = 2;    // of predicted work
constexpr double poll_interval = 0.1;  // s between two readings of `stop`
constexpr int most_attempts = 2;

}  // namespace

DistributedOrbits::DistributedOrbits(OrbitQueue& queue, const ForcedScenes& scenes, const ScheduleOptions& options)
    : queue_(queue), scenes_(scenes), options_(options), service_(*options.blocks, options.case_id) {
  const double steps =
      static_cast<double>(options_.section.transient + options_.section.keep) * options_.section.steps_per_period;
  const double one = steps * scenes_.predicted_step_seconds(0, options_.lanes) / options_.lanes;
  timed_ = static_cast<int>(std::clamp(std::ceil(block_seconds / std::max(one, 1e-12)), 1.0, 4096.0));
}

// Orbits of a block: as many as take some seconds, at most half of a fair share of those that wait. It is at least 1.5
// times the lanes, where a fair share has so many. The last half of the lanes marches with the orbits of another block.
int DistributedOrbits::block_size() const {
  const int share = options_.blocks->share(), waiting = std::max(1, queue_.waiting());
  const int fair = (waiting + share - 1) / share, half = (waiting + 2 * share - 1) / (2 * share);
  return std::max(std::min(options_.lanes + options_.lanes / 2, fair), std::min(half, timed_));
}

void DistributedOrbits::send(OrbitQueue::Batch batch, bool alone) {
  BlockOrders orders(scenes_, options_.section);
  Block block;
  block.alone = alone;
  const auto add = [&](int number) {
    const OrbitTask& task = queue_.task(number);
    block.tasks.push_back(number);
    return orders.add(task.scene, task.lane);
  };
  for (Orbit& orbit : batch.orbits) {
    orders.order().marched.running.push_back(orbit);
    orders.order().marched.running.back().task = add(orbit.task);
  }
  for (const int number : batch.fresh) add(number);
  block.running = std::move(batch.orbits);
  orders.order().lanes = options_.lanes;
  orders.order().ends_only = options_.ends_only;
  // The last ones of a block march beside those of the next, or of the one that it waits behind.
  const bool others_march = queue_.ready() > 0 || static_cast<int>(service_.count()) >= options_.blocks->share();
  if (!alone && others_march && !queue_.chained(block.tasks.front())) orders.order().leave = options_.lanes / 2;
  // One that is suspected tells each of its periods.
  orders.order().interval = alone ? 0 : options_.interval;
  blocks_[service_.begin(to_bytes(orders.order()))] = std::move(block);
}

void DistributedOrbits::fill() {
  while (service_.room()) {
    OrbitQueue::Batch batch;
    const bool alone = !alone_.empty();
    if (alone) {
      Orbit orbit = std::move(alone_.front());
      alone_.pop_front();
      if (orbit.now.slots.empty())
        batch.fresh.push_back(orbit.task);
      else
        batch.orbits.push_back(std::move(orbit));
    } else {
      // Where the share is under way, the last few wait for those that come back.
      if (queue_.waiting() < options_.lanes && static_cast<int>(service_.count()) >= options_.blocks->share()) return;
      const int most = block_size();
      batch = queue_.go_on(options_.lanes, most);
      if (batch.empty()) batch = queue_.take(-1, most);
    }
    if (batch.empty()) return;
    send(std::move(batch), alone);
  }
}

void DistributedOrbits::hear(Block& block, const std::string& bytes) {
  BlockAnswer answer = block_answer(bytes);
  const auto number = [&](const Orbit& orbit) { return block.tasks.at(static_cast<std::size_t>(orbit.task)); };
  for (Orbit& orbit : answer.marched.finished) {
    orbit.task = number(orbit);
    if (!options_.ends_only) orbit.lane = queue_.task(orbit.task).lane;
    if (!queue_.finished(orbit.task)) queue_.finish(std::move(orbit));
  }
  block.running = std::move(answer.marched.running);
  for (Orbit& orbit : block.running) {
    orbit.task = number(orbit);
    orbit.lane = queue_.task(orbit.task).lane;
  }
  seconds_ += answer.seconds - block.seconds;
  lane_periods_ += answer.lane_periods - block.lane_periods;
  block.seconds = answer.seconds;
  block.lane_periods = answer.lane_periods;
}

void DistributedOrbits::lose(Block block, const std::string& cause) {
  for (const int number : block.tasks) {
    if (queue_.finished(number)) continue;
    Orbit orbit;
    orbit.task = number;
    orbit.lane = queue_.task(number).lane;
    for (Orbit& seen : block.running)
      if (seen.task == number) orbit = std::move(seen);
    if (++attempts_[number] < most_attempts || block.tasks.size() > 1) {
      alone_.push_back(std::move(orbit));
      continue;
    }
    orbit.stage = Orbit::Stage::stopped;
    orbit.stopped_period = orbit.transient_periods + orbit.kept_periods + 1;
    orbit.end = {.cause = EndCause::process_ended};
    orbit.end_words = cause;
    if (options_.ends_only) keep_end(orbit, options_.section);
    queue_.finish(std::move(orbit));
  }
}

MarchedOrbits DistributedOrbits::under_way() {
  std::vector<std::vector<Orbit>> all;
  for (const auto& [number, block] : blocks_) all.push_back(block.running);
  std::vector<Orbit> begun;
  for (const Orbit& orbit : alone_)
    if (!orbit.now.slots.empty()) begun.push_back(orbit);
  all.push_back(std::move(begun));
  return queue_.stock(all);
}

void DistributedOrbits::run(const std::atomic<bool>& stop,
                            const std::function<void(const MarchedOrbits&)>& checkpoint) {
  queue_.open();
  Clock::time_point last = Clock::now();
  std::vector<Block> interrupted;
  bool ending = false;
  while (queue_.open_tasks() > 0) {
    if ((stop || over_budget_) && !ending) {
      ending = true;
      service_.stop();
    }
    if (!ending) fill();
    if (service_.count() == 0) break;
    if (auto heard = service_.next(poll_interval)) {
      auto& [number, status] = *heard;
      Block& block = blocks_.at(number);
      if (status.what == What::so_far || status.what == What::done) hear(block, status.content);
      if (status.what == What::failed || status.what == What::gave_up) throw std::runtime_error(status.content);
      if (status.what != What::so_far) {
        const auto ended = blocks_.extract(number);
        if (status.what == What::lost && !ending) lose(std::move(ended.mapped()), status.content);
        if (status.what == What::done && !ending) queue_.give_back(std::move(ended.mapped().running));
        if (status.what == What::interrupted || (status.what == What::done && ending) ||
            (status.what == What::lost && ending))
          interrupted.push_back(std::move(ended.mapped()));
      }
    }
    over_budget_ = over_budget_ || seconds_ > options_.budget;
    if (seconds_since(last) > options_.interval) {
      last = Clock::now();
      checkpoint(under_way());
    }
  }
  for (Block& block : interrupted) blocks_[-1 - static_cast<int>(blocks_.size())] = std::move(block);
  checkpoint(under_way());
  blocks_.clear();
  if (stop) throw Interrupted{};
  if (!over_budget_ && queue_.open_tasks() > 0) throw std::runtime_error("blocks of orbits came back unfinished");
}

namespace {

using What = BlockStatus::What;

// Orbits that are sent together.
struct Part {
  std::size_t batch = 0;
  std::vector<std::size_t> orbits;
  int attempts = 0;  // processes that ended
};

}  // namespace

void measure_elsewhere(const ForcedScenes& scenes, const ExponentTask& task, const SectionPlan& plan,
                       const std::vector<std::vector<std::size_t>>& batches, std::vector<OrbitExponents>& found,
                       double& seconds, const std::function<void(std::size_t)>& measured,
                       const std::atomic<bool>& stop) {
  BlocksUnderWay service(*task.blocks, task.case_id);
  std::deque<Part> waiting;
  std::vector<std::size_t> left(batches.size());  // orbits of a batch that are not known
  for (std::size_t batch = 0; batch < batches.size(); ++batch) {
    left[batch] = batches[batch].size();
    if (left[batch] > 0) waiting.push_back({batch, batches[batch], 0});
  }
  const auto order_of = [&](const Part& part) {
    BlockOrders orders(scenes, plan);
    for (const std::size_t i : part.orbits) {
      Orbit orbit;
      orbit.task = orders.add(task.scenes[i], task.orbits[i]->lane);
      orbit.entry = task.orbits[i]->entry;
      orders.order().marched.finished.push_back(std::move(orbit));
      orders.order().rounds.push_back(task.rounds.at(i));
    }
    orders.order().exponents = task.count;
    orders.order().sawtooth = task.sawtooth[static_cast<std::size_t>(task.groups[part.orbits.front()])];
    return to_bytes(orders.order());
  };
  const auto settle = [&](std::size_t batch, std::size_t count) {
    left[batch] -= count;
    if (left[batch] == 0) measured(batch);
  };
  std::map<int, Part> parts;
  bool ending = false;
  while (!waiting.empty() || service.count() > 0) {
    if (stop && !ending) {
      ending = true;
      service.stop();
    }
    if (ending && service.count() == 0) break;
    for (; !ending && !waiting.empty() && service.room(); waiting.pop_front()) {
      const int number = service.begin(order_of(waiting.front()));
      parts[number] = std::move(waiting.front());
    }
    auto heard = service.next(poll_interval);
    if (!heard || heard->second.what == What::so_far) continue;
    const BlockStatus& status = heard->second;
    Part part = std::move(parts.extract(heard->first).mapped());
    if (status.what == What::failed || status.what == What::gave_up) throw std::runtime_error(status.content);
    if (status.what == What::done) {
      BlockAnswer answer = block_answer(status.content);
      seconds += answer.seconds;
      for (std::size_t i = 0; i < part.orbits.size(); ++i) found[part.orbits[i]] = std::move(answer.exponents.at(i));
      settle(part.batch, part.orbits.size());
    } else if (status.what == What::lost && part.orbits.size() == 1 && part.attempts > 0) {
      if (task.lost) task.lost(status.content);
      settle(part.batch, 1);
    } else if (status.what == What::lost) {
      for (const std::size_t orbit : part.orbits) waiting.push_back({part.batch, {orbit}, part.attempts + 1});
    }
  }
  if (stop) throw Interrupted{};
}

}  // namespace ricochet
