#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numeric>
#include <ricochet/measure/statistics/draws.hpp>
#include <set>

#include "runners/asks/evidence.hpp"

namespace ricochet::asks {

std::string Estimate::unknown() const {
  if (grows) return "";
  if (has_step && !step) return "one step: what it leaves open is not known";
  if (one_instant) return "its impact falls at one instant with each step, which hides what the step leaves";
  if (one_draw) return "one seed: what other draws leave is not known";
  return one_mesh ? "one mesh alone has a value" : "";
}

std::optional<double> Estimate::u() const {
  if (grows || (!step && !mesh && !sampling)) return std::nullopt;
  return step.value_or(0) + mesh.value_or(0) + sampling.value_or(0);
}

std::optional<double> Estimate::doubted_u() const {
  return u() ? std::optional(left() + sampling.value_or(0)) : std::nullopt;
}

namespace {

using BySeed = std::map<std::string, double>;

double mean_over(const BySeed& values, const std::set<std::string>& seeds) {
  double sum = 0;
  for (const std::string& seed : seeds) sum += values.at(seed);
  return sum / static_cast<double>(seeds.size());
}

/// Means over the seeds that all these sizes and the finest have in common.
std::vector<SizedValue> along(const std::map<Size, BySeed>& values, const Size& finest, bool steps) {
  std::set<std::string> common;
  for (const auto& [seed, value] : values.at(finest)) common.insert(seed);
  std::vector<std::pair<double, const BySeed*>> sizes;
  for (const auto& [size, by_seed] : values) {
    if (steps ? size.second != finest.second : size.first != finest.first) continue;
    std::set<std::string> both;
    for (const std::string& seed : common)
      if (by_seed.contains(seed)) both.insert(seed);
    // A size that shares no seed tells nothing.
    if (both.empty()) continue;
    common = std::move(both);
    sizes.emplace_back(steps ? size.first : 1 / size.second, &by_seed);
  }
  std::vector<SizedValue> out;
  for (const auto& one : sizes) {
    const BySeed& by_seed = *one.second;
    if (std::all_of(common.begin(), common.end(), [&](const auto& seed) { return by_seed.contains(seed); }))
      out.push_back({one.first, mean_over(by_seed, common)});
  }
  return out;
}

std::optional<double> left_by(const std::optional<Limit>& limit) {
  return limit && limit->uncertainty && std::isfinite(*limit->uncertainty) ? limit->uncertainty : std::nullopt;
}

/// Whether draws scatter more than their own intervals explain, Σ(x − x̄)²/σ² against χ² at 95 %.
bool scatter_more(const std::vector<double>& values, const std::vector<double>& halves) {
  constexpr double normal = 1.96, level = 0.95;  // σ of half a 95 % interval
  const auto n = static_cast<double>(values.size());
  if (n < 2) return false;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double sum = 0;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (const double apart = values[k] - mean; apart != 0) sum += std::pow(normal * apart / halves[k], 2);
  return !(sum <= boost::math::quantile(boost::math::chi_squared(n - 1), level));
}

/// Half the interval of the mean at one size: of many draws between them, of few what each knows of itself, unless they
/// contradict each other.
void put_sampling(Estimate& out, const BySeed& draws, const BySeed* halves) {
  std::vector<double> values, own;
  for (const auto& [seed, value] : draws) {
    values.push_back(value);
    if (halves && halves->contains(seed)) own.push_back(halves->at(seed));
  }
  constexpr std::size_t few = 4;
  const bool all = !own.empty() && own.size() == values.size();
  if (all && values.size() < few && !scatter_more(values, own)) {
    double squares = 0;
    for (const double one : own) squares += one * one;
    out.sampling = std::sqrt(squares) / static_cast<double>(own.size());
    return;
  }
  out.sampling = half_interval(values);
  out.scattered = out.sampling.has_value();
}

/// Why what a refinement tells may be farther than u from the limit, and how many times u that is.
struct Doubt {
  enum class Kind { none, restless, two, three };
  Kind kind = Kind::none;
  double times = 1;
  std::string text = {};
  double added(const std::optional<double>& u) const { return (times - 1) * u.value_or(0); }
};

/// What moves one way goes on, what wanders stays about where it is. Of two sizes three times what first order leaves,
/// 3 |d|/(r − 1) (Roache, 1994), where u is |d|. The order of three sizes alone may be chance.
Doubt doubt_of(const std::optional<Limit>& limit, const char* what, const char* several) {
  constexpr double of_moving = 10, of_wandering = 2, of_two = 3, of_three = 3;
  if (!limit) return {};
  if (limit->restless())
    return {Doubt::Kind::restless, limit->status == LimitStatus::moves ? of_moving : of_wandering,
            std::string(limit->trend > 0   ? "still rises"
                        : limit->trend < 0 ? "still falls"
                                           : "wanders") +
                " with the " + what};
  if (limit->status == LimitStatus::two && limit->ratio > 1 && of_two > limit->ratio - 1)
    return {Doubt::Kind::two, of_two / (limit->ratio - 1), std::string("is known by two ") + several + " alone"};
  if (limit->status == LimitStatus::settles && !limit->order)
    return {Doubt::Kind::three, *limit->uncertainty < limit->range ? of_three : 1,
            limit->sizes > 3 ? std::string("has no confirmed order in the ") + what
                             : std::string("is known by three ") + several + " alone"};
  return {};
}

/// Whether what a refinement moved last is the chance of draws: their mean moves by less than its 95 % interval, from
/// the size before the finest and from the one before that. Few draws, of which that is wide, do not move one way.
bool is_chance(const std::map<Size, BySeed>& values, const Size& finest, bool steps) {
  std::map<double, const BySeed*> sizes;  // the finest first
  for (const auto& [size, by_seed] : values)
    if (steps ? size.second == finest.second : size.first == finest.first)
      sizes[steps ? size.first : 1 / size.second] = &by_seed;
  if (sizes.size() < 2) return false;
  constexpr std::size_t looked_at = 2, few = 4;
  std::size_t looked = 0;
  for (auto coarser = std::next(sizes.begin()); coarser != sizes.end() && looked < looked_at; ++coarser, ++looked) {
    std::vector<double> moves;
    for (const auto& [seed, value] : *sizes.begin()->second)
      if (const auto before = coarser->second->find(seed); before != coarser->second->end())
        moves.push_back(value - before->second);
    const std::optional<double> half = half_interval(moves);
    const auto [least, most] = std::minmax_element(moves.begin(), moves.end());
    if (!half || (moves.size() < few && (*least >= 0 || *most <= 0))) return false;
    if (std::abs(std::accumulate(moves.begin(), moves.end(), 0.0)) > *half * static_cast<double>(moves.size()))
      return false;
  }
  return true;
}

}  // namespace

Limits limits_at(const std::map<Size, BySeed>& values, const Size& finest, double floor, Errors errors) {
  return {limit_of(along(values, finest, true), floor, {}, errors),
          limit_of(along(values, finest, false), floor, {}, errors)};
}

Estimate estimate_of(const std::map<Size, BySeed>& values, const std::map<Size, BySeed>& halves, const Size& finest,
                     const Limits& limits, bool has_step) {
  Estimate out;
  out.has_step = has_step;
  const BySeed& draws = values.at(finest);
  for (const auto& [seed, value] : draws) out.value += value / static_cast<double>(draws.size());
  out.seeds = draws.size();
  out.steps = limits.step ? limits.step->sizes : 1;
  out.meshes = limits.mesh ? limits.mesh->sizes : 1;
  out.step = left_by(limits.step);
  out.mesh = left_by(limits.mesh);
  for (const auto& one : {limits.step, limits.mesh})
    out.grows = out.grows || (one && one->status == LimitStatus::blows_up);
  const auto doubt = [&](const std::optional<Limit>& limit, bool steps) {
    if (limit && is_chance(values, finest, steps)) return Doubt{};
    return steps ? doubt_of(limit, "step", "steps") : doubt_of(limit, "mesh", "meshes");
  };
  const Doubt of_step = doubt(limits.step, true), of_mesh = doubt(limits.mesh, false);
  out.step_doubt = of_step.times;
  out.mesh_doubt = of_mesh.times;
  // What leaves more open is told.
  const bool step_first = of_step.added(out.step) >= of_mesh.added(out.mesh) && of_step.kind != Doubt::Kind::none;
  const Doubt& told = step_first ? of_step : of_mesh;
  (told.kind == Doubt::Kind::restless ? out.motion : out.few) = told.text;
  out.two = told.kind == Doubt::Kind::two;
  if (out.grows) out.motion = "grows without bound";
  out.vanishes = limits.step && limits.step->status == LimitStatus::vanishes;
  out.order = limits.step ? limits.step->order : std::nullopt;
  const auto own = halves.find(finest);
  put_sampling(out, draws, own == halves.end() ? nullptr : &own->second);
  // What the doubt would add is within what the draws leave: two sizes that differ by less tell no more of each other.
  const auto at_most_two = [](const Doubt& one) { return one.times == 1 || one.kind == Doubt::Kind::two; };
  if (out.two && at_most_two(of_step) && at_most_two(of_mesh) &&
      *out.doubted_u() - *out.u() <= out.sampling.value_or(0)) {
    out.step_doubt = out.mesh_doubt = 1;
    out.few.clear();
    out.two = false;
  }
  return out;
}

}  // namespace ricochet::asks
