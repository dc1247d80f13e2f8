#include "runners/kinds/sweep/block_orders.hpp"

#include <algorithm>
#include <cereal/types/utility.hpp>
#include <chrono>

#include "runners/kinds/sweep/orbit_checkpoints.hpp"
#include "runners/march/bytes.hpp"
#include "runners/march/seconds.hpp"

namespace ricochet {
namespace {

constexpr const char* order_mark = "block 4";
constexpr const char* answer_mark = "answer of a block 5";
constexpr std::size_t most_scenes = 8192, most_kept_cases = 8;  // that are kept for later blocks

std::vector<double> numbers(const Eigen::VectorXd& vector) {
  return {vector.data(), vector.data() + vector.size()};
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

template <class Archive>
void serialize(Archive& archive, SceneVariant& variant) {
  archive(variant.values, variant.own_state);
}

template <class Archive>
void serialize(Archive& archive, SectionPlan& plan) {
  auto& [pulsation, steps_per_period, strobe, transient, at_most, keep, section, tolerance, scale] = plan;
  archive(pulsation, steps_per_period, strobe, transient, at_most, keep, section, tolerance, scale);
}

template <class Archive>
void serialize(Archive& archive, OrderedOrbit& orbit) {
  archive(orbit.scene, orbit.position, orbit.velocity);
}

template <class Archive>
void serialize(Archive& archive, BlockOrder& order) {
  auto& [scenes, section, lanes, leave, ends_only, interval, orbits, marched, exponents, rounds, sawtooth] = order;
  archive(scenes, section, lanes, leave, ends_only, interval, orbits, marched, exponents, rounds, sawtooth);
}

template <class Archive>
void serialize(Archive& archive, BlockAnswer& answer) {
  archive(answer.marched, answer.exponents, answer.seconds, answer.lane_periods);
}

std::string to_bytes(const BlockOrder& order) {
  return packed(order, order_mark);
}
std::string to_bytes(const BlockAnswer& answer) {
  return packed(answer, answer_mark);
}
BlockOrder block_order(const std::string& bytes) {
  return unpacked<BlockOrder>(bytes, order_mark);
}
BlockAnswer block_answer(const std::string& bytes) {
  return unpacked<BlockAnswer>(bytes, answer_mark);
}

int BlockOrders::place(int scene) {
  if (order_.scenes.empty()) {
    places_[scenes_.reference_scene()] = 0;
    order_.scenes.push_back(scenes_[scenes_.reference_scene()].variant);
  }
  const auto [known, added] = places_.try_emplace(scene, static_cast<int>(order_.scenes.size()));
  if (added) order_.scenes.push_back(scenes_[scene].variant);
  return known->second;
}

int BlockOrders::add(int scene, const LaneSpec& lane) {
  const int at = place(scene);
  order_.orbits.push_back({at, numbers(lane.position), numbers(lane.velocity)});
  return static_cast<int>(order_.orbits.size()) - 1;
}

BlockMarcher::Scenes& BlockMarcher::scenes_of(const StudyCase& study_case, const SceneVariant& reference_scene) {
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Scenes& one) {
    return one.study_case == &study_case && one.reference_scene == key_of(reference_scene) &&
           one.known.size() < most_scenes;
  });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
  } else {
    // Of another batch of cells: it does not come back.
    std::erase_if(kept_, [&](const Scenes& one) { return one.study_case == &study_case; });
    kept_.push_front({&study_case, key_of(reference_scene), std::make_unique<ForcedScenes>(study_case, registry_), {}});
    if (kept_.size() > most_kept_cases) kept_.pop_back();
  }
  return kept_.front();
}

std::string BlockMarcher::march(const StudyCase& study_case, const std::string& bytes,
                                const std::function<void(std::string)>& so_far, const std::atomic<bool>& stop) {
  const double begun = thread_seconds();
  BlockOrder order = block_order(bytes);
  Scenes& kept = scenes_of(study_case, order.scenes.at(0));
  std::vector<int> scenes;
  for (const SceneVariant& variant : order.scenes) {
    const auto [known, added] = kept.known.try_emplace(key_of(variant), 0);
    if (added) known->second = kept.all->add(variant);
    const ForcedScene& scene = (*kept.all)[known->second];
    if (!scene.refusal.empty()) throw std::runtime_error(scene.refusal.text);
    scenes.push_back(known->second);
  }
  const auto lane_of = [&](const OrderedOrbit& orbit) {
    LaneSpec lane = (*kept.all)[scenes.at(static_cast<std::size_t>(orbit.scene))].lane;
    lane.position = vector_of(orbit.position);
    lane.velocity = vector_of(orbit.velocity);
    return lane;
  };
  BlockAnswer answer;
  if (order.exponents > 0) {
    ExponentTask task;
    task.sawtooth.assign(static_cast<std::size_t>(kept.all->groups()), order.sawtooth);
    task.count = order.exponents;
    task.rounds = order.rounds;
    for (std::size_t i = 0; i < order.orbits.size(); ++i) {
      Orbit& orbit = order.marched.finished.at(i);
      orbit.lane = lane_of(order.orbits[i]);
      task.orbits.push_back(&orbit);
      task.groups.push_back((*kept.all)[scenes.at(static_cast<std::size_t>(order.orbits[i].scene))].group);
    }
    answer.exponents = measure_exponents(*kept.all, task, order.section, answer.seconds, stop);
    return to_bytes(answer);
  }
  OrbitScheduler scheduler(*kept.all, {.section = order.section,
                                       .lanes = order.lanes,
                                       .leave = order.leave,
                                       .interval = order.interval,
                                       .ends_only = order.ends_only});
  for (const OrderedOrbit& orbit : order.orbits)
    scheduler.add({scenes.at(static_cast<std::size_t>(orbit.scene)), lane_of(orbit), -1, -1});
  scheduler.restore(std::move(order.marched));
  std::string last;
  scheduler.run(stop, [&](const MarchedOrbits& marched) {
    answer.marched = marched;
    answer.seconds = thread_seconds() - begun;
    answer.lane_periods = scheduler.lane_periods();
    so_far(to_bytes(answer));
  });
  // What has ended has been told.
  answer.marched.finished.clear();
  return to_bytes(answer);
}

BlocksUnderWay::BlocksUnderWay(BlockService& service, std::string case_id)
    : service_(service), case_id_(std::move(case_id)) {}

int BlocksUnderWay::begin(const std::string& order) {
  const int block = begun_++;
  under_way_[block] = service_.begin(case_id_, order, [inbox = inbox_, block](BlockStatus status) {
    const std::lock_guard guard(inbox->mutex);
    inbox->status.emplace_back(block, std::move(status));
    inbox->changed.notify_all();
  });
  return block;
}

std::optional<std::pair<int, BlockStatus>> BlocksUnderWay::next(double seconds) {
  std::unique_lock lock(inbox_->mutex);
  if (!inbox_->changed.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return !inbox_->status.empty(); }))
    return std::nullopt;
  std::pair<int, BlockStatus> one = std::move(inbox_->status.front());
  inbox_->status.pop_front();
  if (one.second.what != BlockStatus::What::so_far) under_way_.erase(one.first);
  return one;
}

void BlocksUnderWay::stop() {
  for (const auto& [block, number] : under_way_) service_.stop(number);
}

}  // namespace ricochet
