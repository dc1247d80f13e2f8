#include <algorithm>
#include <cmath>
#include <ricochet/measure/statistics/tiers.hpp>

#include "runners/answers/limits.hpp"

namespace ricochet::answers {
namespace {

/// A gain below this share of the energy is round-off.
constexpr double nothing_gained = 1e-11;
/// What keeps the energy is within this share of it.
constexpr double keeps_within = 0.01;

bool one_scene(const Choices& study, const std::vector<const Method*>& methods) {
  const std::vector<std::string> scene = study.scene_columns();
  const std::string first = study.key(methods.front()->first(), scene);
  return std::all_of(methods.begin(), methods.end(),
                     [&](const Method* method) { return study.key(method->first(), scene) == first; });
}

}  // namespace

std::vector<std::size_t> tier_places(const Choices& study, const MeasureLimits& limits) {
  constexpr std::size_t a_dozen = 12, many = 120;
  const std::vector<const Method*> methods = limits.with_limit();
  std::vector<std::size_t> out(methods.size(), 0);
  const MeasureWords& words = limits.words;
  const bool told =
      methods.size() <= 1 ||
      (study.asked().empty() &&
       (words.decades || (one_scene(study, methods) && methods.size() <= (words.direction ? many : a_dozen))));
  if (!told || methods.empty()) return out;
  double scale = scale_of(words, methods);
  if (scale <= 0) scale = 1;
  Members rest;
  std::vector<Limit> found;
  std::vector<double> values;
  for (std::size_t k = 0; k < methods.size(); ++k) {
    const Limit& limit = *methods[k]->limit;
    // What grows from nothing to next to nothing does not blow up.
    const bool grows =
        limit.status == LimitStatus::blows_up && !words.decades && std::abs(limit.value) > tolerance * scale;
    if (methods[k]->gains || grows) continue;
    rest.push_back(k);
    found.push_back(limit);
    values.push_back(limit.value);
  }
  if (rest.empty()) return out;
  std::vector<Members> tiers =
      (words.decades ? tiers_over_decades(values, nothing_gained) : tiers_of(found, tolerance * scale)).tiers;
  if (words.direction > 0) std::reverse(tiers.begin(), tiers.end());
  // Those that keep the energy are told from those that lose some, however small the gaps between them.
  if (words.truth == 1.0 && !tiers.empty()) {
    Members keep, lose;
    for (const std::size_t k : tiers.front()) (values[k] >= *words.truth - keeps_within ? keep : lose).push_back(k);
    const bool apart = std::any_of(lose.begin(), lose.end(),
                                   [&](std::size_t k) { return values[k] < *words.truth - 2 * keeps_within; });
    if (!keep.empty() && apart) {
      tiers.front() = keep;
      tiers.insert(tiers.begin() + 1, lose);
    }
  }
  for (std::size_t tier = 0; tier < tiers.size(); ++tier)
    for (const std::size_t k : tiers[tier]) out[rest[k]] = tier + 1;
  return out;
}

}  // namespace ricochet::answers
