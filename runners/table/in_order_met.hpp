#pragma once
#include <algorithm>
#include <utility>
#include <vector>

namespace ricochet {

/// What a list has under a key, its keys in the order in which they were met; a key that is new gets a value of its
/// own.
template <class Key, class Value>
Value& in_order_met(std::vector<std::pair<Key, Value>>& list, const Key& key) {
  auto found = std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.first == key; });
  if (found == list.end()) found = list.insert(list.end(), {key, Value()});
  return found->second;
}

}  // namespace ricochet
