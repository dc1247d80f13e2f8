#include <algorithm>
#include <cmath>
#include <ricochet/measure/statistics/resolved_effect.hpp>

namespace ricochet {
namespace {

void widen(std::optional<double>& most, const std::optional<double>& move) {
  if (move) most = std::max(most.value_or(0), *move);
}

}  // namespace

const char* effect_word(EffectVerdict verdict) {
  switch (verdict) {
    case EffectVerdict::not_observed:
      return "not observed";
    case EffectVerdict::no_matter:
      return "does not matter";
    case EffectVerdict::decides:
      return "decides";
    case EffectVerdict::unresolved:
      return "not resolved";
    case EffectVerdict::untold:
      return "not told";
  }
  return "";
}

ResolvedEffect resolved_effect(const std::vector<LevelValue>& levels, double threshold, double floor) {
  ResolvedEffect out;
  double largest = 0;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    if (levels[k].value < levels[out.least].value) out.least = k;
    if (levels[k].value > levels[out.most].value) out.most = k;
    widen(out.step, levels[k].step_move);
    widen(out.mesh, levels[k].mesh_move);
    widen(out.sampling, levels[k].sampling);
    largest = std::max(largest, std::abs(levels[k].value));
  }
  out.effect = levels[out.most].value - levels[out.least].value;
  if (largest <= floor)
    out.verdict = EffectVerdict::not_observed;
  else if (!out.step && !out.mesh)
    out.verdict = EffectVerdict::untold;
  else if (out.effect <= std::max(threshold, floor) && out.open() <= threshold)
    out.verdict = EffectVerdict::no_matter;
  else if (out.effect > threshold && out.effect > 2 * out.open())
    out.verdict = EffectVerdict::decides;
  else
    out.verdict = EffectVerdict::unresolved;
  return out;
}

}  // namespace ricochet
