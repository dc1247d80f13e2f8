#include "runners/study/case_id.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace ricochet {
namespace {

std::uint64_t hash(const std::string& text) {
  std::uint64_t value = 14695981039346656037ULL;
  for (const char c : text) {
    value ^= static_cast<unsigned char>(c);
    value *= 1099511628211ULL;
  }
  // The last bytes reach the high digits of FNV-1a only weakly; this mixing (MurmurHash3, fmix64) spreads them.
  value ^= value >> 33U;
  value *= 0xff51afd7ed558ccdULL;
  value ^= value >> 33U;
  value *= 0xc4ceb9fe1a85ec53ULL;
  value ^= value >> 33U;
  return value;
}

}  // namespace

std::string CaseIds::next(const StudyCase& study_case, const std::string& kind) {
  // nlohmann::json keeps its keys sorted, whatever the order they were given in.
  nlohmann::json all;
  all["kind"] = kind;
  for (const auto& [axis, value] : study_case.axes) all["axes"][axis] = value;
  all["scene"] = study_case.scene_json;
  all["duration"] = study_case.duration;
  all["samples"] = study_case.samples;
  if (!study_case.settings.is_null()) all["settings"] = study_case.settings;
  std::string text = all.dump();
  while (true) {
    std::string id = fmt::format("{:016x}", hash(text)).substr(0, 10);
    const auto [known, fresh] = canonical_.emplace(id, text);
    if (fresh || known->second == text) return id;
    text += '#';
  }
}

}  // namespace ricochet
