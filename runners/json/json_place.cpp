#include "runners/json/json_place.hpp"

#include <algorithm>

#include "runners/json/json_text.hpp"

namespace ricochet {

void JsonPlace::unexpected(const std::string& expected) const {
  throw InputError(pointer_, "expected " + expected + ", found " + quote(*value_));
}

void JsonPlace::close(const std::vector<std::string>& keys) const {
  if (!value_->is_object()) unexpected("an object with the keys " + quoted_list(keys));
  for (const auto& [key, ignored] : value_->items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      throw InputError(pointer_of(key), "unknown key \"" + shortened(key) + "\"" + did_you_mean(key, keys) +
                                            " (keys here: " + quoted_list(keys) + ")");
}

JsonPlace JsonPlace::at(const std::string& key, const std::string& meaning) const {
  const auto found = value_->find(key);
  if (found == value_->end()) throw InputError(pointer_of(key), "missing; " + meaning);
  return {*found, pointer_of(key)};
}

std::string JsonPlace::pointer_of(const std::string& key) const {
  return pointer_to(pointer_, key);
}

std::vector<std::pair<std::string, JsonPlace>> JsonPlace::members(const std::string& expected) const {
  if (!value_->is_object()) unexpected(expected);
  std::vector<std::pair<std::string, JsonPlace>> members;
  for (const auto& item : value_->items())
    members.emplace_back(item.key(), JsonPlace(item.value(), pointer_of(item.key())));
  return members;
}

std::vector<JsonPlace> JsonPlace::items(const std::string& expected) const {
  if (!value_->is_array()) unexpected(expected);
  std::vector<JsonPlace> items;
  for (std::size_t i = 0; i < value_->size(); ++i) items.emplace_back((*value_)[i], pointer_to(pointer_, i));
  return items;
}

std::string JsonPlace::text(const std::string& expected) const {
  if (!value_->is_string() || value_->get<std::string>().find_first_not_of(" \t\r\n") == std::string::npos)
    unexpected(expected);
  return value_->get<std::string>();
}

std::string JsonPlace::word(const std::vector<std::string>& words) const {
  if (value_->is_string() && std::find(words.begin(), words.end(), value_->get<std::string>()) != words.end())
    return value_->get<std::string>();
  unexpected("one of " + quoted_list(words));
}

}  // namespace ricochet
