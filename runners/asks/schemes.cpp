// What one time scheme tells of the limit of another.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "runners/asks/evidence.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet::asks {
namespace {

/// A choice of how the same problem is marched: it moves no limit of a compliant law.
bool is_of_scheme(const std::string& column) {
  return axis_role(column) == "time" || column == "contact.evaluation";
}

/// Whether a compliant law without friction worked in each case: its forces follow from the motion, whatever the step.
bool is_compliant(const Point& point) {
  return std::all_of(point.behind.begin(), point.behind.end(), [](const CaseRecord* one) {
    return measure(*one, contact_steps_measure) && !measure(*one, "friction_residual");
  });
}

/// Widens `own` where its interval and that of another exclude each other, though both have one limit: one of them is
/// wrong, and it is not known which. What moves both alike, mesh and seeds, is no part of that. One that has not
/// settled itself disproves nothing.
void widen_by(Estimate& own, const Estimate& other) {
  if (!own.step || !other.step || own.grows || other.grows || !other.motion.empty()) return;
  const auto left = [](const Estimate& one) {
    return (one.motion.empty() ? 1 : one.step_doubt) * *one.step + one.sampling.value_or(0);
  };
  const double apart = std::abs(own.value - other.value);
  if (apart <= left(own) + left(other)) return;
  const double before = own.step_doubt * *own.step;
  own.step = apart + *other.step;
  own.step_doubt = std::max(1.0, before / *own.step);
  own.few = "disagrees with another scheme, though both have one limit";
  own.disproved = true;
}

/// Narrows `own` to what another scheme with the same limit tells: as far as both values lie apart, and what is left of
/// the other. One that moves, or is known by two sizes alone, tells nothing.
void narrow_by(Estimate& own, const Estimate& other) {
  if (!other.step || other.grows || !other.motion.empty() || other.two) return;
  const double told = std::abs(own.value - other.value) + other.step_doubt * *other.step;
  // What seems to grow without bound has a limit, which the other knows.
  if (own.grows) {
    own.grows = false;
    own.motion.clear();
    own.step = told;
    own.step_doubt = 1;
    return;
  }
  if (!own.step) return;
  if (told >= own.step_doubt * *own.step) return;
  own.step_doubt = std::max(1.0, told / *own.step);
  own.step = std::min(*own.step, told);
  if (own.doubted()) return;
  own.few.clear();
  own.motion.clear();
  own.two = false;
}

/// Whether two points are means over the same draws at the same size.
bool same_draws(const Point& a, const Point& b) {
  const auto &own = a.values.at(*a.finest), &other = b.values.at(*b.finest);
  return a.finest->second == b.finest->second &&
         std::equal(own.begin(), own.end(), other.begin(), other.end(),
                    [](const auto& one, const auto& two) { return one.first == two.first; });
}

/// The estimate of a point beside those of others with the same limit.
Estimate tested(const Point& point, const std::vector<Point>& peers) {
  Estimate out = *point.estimate;
  for (const Point& peer : peers) {
    if (!same_draws(point, peer)) continue;
    Estimate widened = *point.estimate;
    widen_by(widened, *peer.estimate);
    if (widened.step > out.step) out = widened;
  }
  return out;
}

}  // namespace

std::optional<Evidence::Schemes> Evidence::schemes(const std::string& name,
                                                   const std::vector<std::string>& columns) const {
  const MeasureInfo* info = measure_info(name);
  if (names_step(columns) || !info || info->of_each_size || info->of == MeasureInfo::Of::computation)
    return std::nullopt;
  Schemes out;
  for (const CaseRecord& record : results().cases)
    if (!is_reference(record)) out.all.push_back(&record);
  out.told = choices(out.all, name, columns);
  out.told.insert(out.told.end(), columns.begin(), columns.end());
  std::copy_if(out.told.begin(), out.told.end(), std::back_inserter(out.others),
               [](const auto& one) { return !is_of_scheme(one); });
  return out.others.size() == out.told.size() ? std::nullopt : std::optional(std::move(out));
}

void Evidence::test_by_schemes(std::vector<Point>& points, const std::string& name, const Schemes& varying,
                               bool shares) const {
  Cases all = varying.all;
  // Those that have a limit, by its name.
  std::map<std::string, std::vector<Point>> peers;
  for (Point& point : points)
    if (point.estimate && is_compliant(point)) peers[point.limit = key(point.first(), varying.others) + '\n'];
  std::erase_if(all, [&](const CaseRecord* one) { return !peers.contains(key(*one, varying.others) + '\n'); });
  for (Point& peer : alone(name, all, varying.told, shares))
    if (peer.estimate && is_compliant(peer)) peers[key(peer.first(), varying.others) + '\n'].push_back(std::move(peer));
  for (Point& point : points)
    if (!point.limit.empty()) point.estimate = tested(point, peers[point.limit]);
  // What no other disproves tells the others where to look.
  for (auto& [limit, group] : peers) {
    std::vector<Estimate> estimates;
    for (const Point& peer : group) estimates.push_back(tested(peer, group));
    for (std::size_t k = 0; k < group.size(); ++k) group[k].estimate = estimates[k];
  }
  for (Point& point : points) {
    if (point.limit.empty() || point.estimate->disproved) continue;
    for (const Point& peer : peers[point.limit])
      if (!peer.estimate->disproved && same_draws(point, peer)) narrow_by(*point.estimate, *peer.estimate);
  }
}

void Evidence::test_by_contact(std::vector<Point>& points, const std::string& name, const Schemes& varying,
                               bool shares) const {
  std::map<std::string, std::vector<Point*>> idle;
  for (Point& point : points)
    if (is_idle(point, split_measure(name).second)) idle[key(point.first(), varying.others)].push_back(&point);
  if (idle.empty()) return;
  Cases all = varying.all;
  std::erase_if(all, [&](const CaseRecord* one) { return !idle.contains(key(*one, varying.others)); });
  for (const Point& peer : alone(name, all, varying.told, shares)) {
    if (!peer.estimate || peer.estimate->value == 0) continue;
    for (Point* point : idle[key(peer.first(), varying.others)]) {
      point->of_untouched_stop = false;
      if (!point->estimate) continue;
      Estimate& own = *point->estimate;
      const double value = std::abs(peer.estimate->value), told = value + peer.estimate->u().value_or(0);
      if (told <= own.step.value_or(0)) continue;
      own.step = told;
      own.step_doubt = (value + peer.estimate->doubted_u().value_or(0)) / told;
      own.few = "touches nothing, and other schemes do";
      own.disproved = true;
    }
  }
}

}  // namespace ricochet::asks
