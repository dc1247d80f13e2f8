#include "runners/kinds/sweep/distributed_exponents.hpp"

#include <deque>
#include <map>
#include <stdexcept>

#include "runners/kinds/sweep/block_orders.hpp"
#include "runners/kinds/sweep/blocks_under_way.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {
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
  constexpr double look_up = 0.1;  // s between two looks at `stop`
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
    auto heard = service.next(look_up);
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
