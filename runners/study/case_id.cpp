#include "runners/study/case_id.hpp"

#include <algorithm>

namespace ricochet {
namespace {

constexpr std::size_t digits = 10;

}  // namespace

bool is_former_id(std::string_view id) {
  return id.size() == digits &&
         std::all_of(id.begin(), id.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

std::string id_of_today(std::string id) {
  if (is_former_id(id)) id.insert(id.begin(), case_letter);
  return id;
}

std::string former_id(std::string id) {
  if (id.size() == digits + 1 && id.front() == case_letter && is_former_id(std::string_view(id).substr(1)))
    id.erase(id.begin());
  return id;
}

bool begins_id(std::string_view id, std::string_view asked) {
  return id.starts_with(asked) || std::string_view(former_id(std::string(id))).starts_with(asked);
}

}  // namespace ricochet
