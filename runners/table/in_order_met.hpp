#pragma once
#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace ricochet {

/// What a list has under a key, its keys in the order in which they were met. A new key gets a value of its own.
template <class Key, class Value>
Value& in_order_met(std::vector<std::pair<Key, Value>>& list, const Key& key) {
  auto found = std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.first == key; });
  if (found == list.end()) found = list.insert(list.end(), {key, Value()});
  return found->second;
}

/// The same for as many keys as a study has cases.
template <class Key, class Value>
class InOrderMet {
 public:
  Value& operator[](const Key& key) {
    const auto [place, fresh] = places_.emplace(key, list_.size());
    if (fresh) list_.emplace_back(key, Value());
    return list_[place->second].second;
  }
  bool holds(const Key& key) const { return places_.contains(key); }
  const std::vector<std::pair<Key, Value>>& list() const& { return list_; }
  std::vector<std::pair<Key, Value>> list() && { return std::move(list_); }

 private:
  std::vector<std::pair<Key, Value>> list_;
  std::map<Key, std::size_t> places_;
};

}  // namespace ricochet
