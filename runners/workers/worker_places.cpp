#include "runners/workers/worker_places.hpp"

#include <set>
#include <string>

namespace ricochet {

WorkerPlaces::WorkerPlaces(std::vector<std::shared_ptr<WorkerHost>> hosts) {
  for (auto& host : hosts) {
    width_ += host->width();
    places_.push_back({std::move(host)});
  }
}

int WorkerPlaces::machines() const {
  std::set<std::string> names;
  for (const Place& one : places_) names.insert(one.host->name());
  return static_cast<int>(names.size());
}

WorkerPlaces::Taken WorkerPlaces::take(Where where) {
  const std::lock_guard guard(mutex_);
  const std::size_t at = where == Where::here ? 0 : roomiest();
  Place& place = places_[at];
  Taken taken{nullptr, where == Where::here ? Slot() : Slot(*this, at)};
  if (where == Where::anywhere) ++place.at_work;
  if (!place.idle.empty()) {
    taken.member = std::move(place.idle.back());
    place.idle.pop_back();
  } else {
    taken.member = std::make_shared<Member>();
    taken.member->host = place.host;
    taken.member->number = ++born_;
    taken.member->place = at;
  }
  return taken;
}

void WorkerPlaces::give_back(MemberPointer member) {
  const std::lock_guard guard(mutex_);
  Place& place = places_[member->place];
  if (place.host->there()) place.idle.push_back(std::move(member));
}

void WorkerPlaces::leave(std::size_t place) {
  const std::lock_guard guard(mutex_);
  --places_[place].at_work;
}

std::size_t WorkerPlaces::roomiest() const {
  const auto room = [&](std::size_t at) { return places_[at].host->width() - places_[at].at_work; };
  std::size_t best = 0;
  for (std::size_t at = 1; at < places_.size(); ++at)
    if (places_[at].host->there() && room(at) > room(best)) best = at;
  return best;
}

}  // namespace ricochet
