#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/attractors/match_points.hpp>
#include <set>
#include <stdexcept>
#include <tuple>

namespace ricochet {
namespace {

constexpr double farthest_pair = 0.05, always_near = 1e-3, slack = 4, told_apart = 3, arc_weight = 0.1;
constexpr double prominence_factor = 3, of_the_motion = 0.01;

/// A place of a case: points that several of its branches share are one.
struct PlacedPoint {
  CasePoint point;
  std::vector<std::size_t> members;  ///< of the points given
  int identity = -1;
  int sharing = 1;
  bool clear = false;  ///< no other point is less than three times as far from it or from that of the finer case
};

/// A place that a case or one nearer to the reference has, and by how far it moved when it was met last.
struct Known {
  const PlacedPoint* place = nullptr;
  std::optional<double> moved;
};

struct Pair {
  std::size_t left = 0, right = 0;
  double distance = 0;
};

using PlacedPoints = std::vector<const PlacedPoint*>;

auto value_order(const CasePoint& one) {
  return std::tie(one.family, one.parameter, one.displacement, one.arc, one.half);
}

class Matching {
 public:
  Matching(const std::vector<CasePoint>& points, const std::vector<CaseLink>& links, const PointScales& scales)
      : scales_(scales), links_(links), places_(links.size()), known_(links.size()), children_(links.size()) {
    for (std::size_t c = 0; c < links.size(); ++c) {
      if (!links[c].to) continue;
      if (*links[c].to >= links.size()) throw std::invalid_argument("a link leads to no case");
      children_[*links[c].to].push_back(c);
    }
    gather(points);
    std::vector<char> met(links.size(), 0);
    for (std::size_t c = 0; c < links.size(); ++c)
      if (!links[c].to) follow(c, met);
    if (std::count(met.begin(), met.end(), 0) > 0) throw std::invalid_argument("links of cases form a circle");
  }

  MatchedPoints result(std::size_t points) const {
    MatchedPoints out;
    out.name.assign(points, -1);
    out.sharing.assign(points, 0);
    const std::set<int> kept = confirmed();
    std::vector<std::pair<const PlacedPoint*, int>> named;
    for (const int one : kept) named.emplace_back(first_.at(one), one);
    std::sort(named.begin(), named.end(),
              [](const auto& a, const auto& b) { return value_order(a.first->point) < value_order(b.first->point); });
    std::map<int, int> name;
    for (const auto& [place, identity] : named) name.emplace(identity, out.names++);
    for (const std::vector<PlacedPoint>& own : places_)
      for (const PlacedPoint& place : own)
        if (const auto found = name.find(place.identity); found != name.end())
          for (const std::size_t point : place.members) {
            out.name[point] = found->second;
            out.sharing[point] = place.sharing;
          }
    return out;
  }

 private:
  double distance(const CasePoint& a, const CasePoint& b) const {
    const double apart = std::max(0.0, std::abs(a.parameter - b.parameter) - a.half - b.half);
    double moved = std::abs(a.displacement - b.displacement) / scales_.displacement;
    if (a.turns && b.turns)
      moved -= std::sqrt((std::abs(a.parameter - b.parameter) + a.half + b.half) / scales_.parameter);
    return apart / scales_.parameter + std::max(0.0, moved) + arc_weight * std::abs(a.arc - b.arc) / scales_.arc;
  }

  /// Whether two points may be one. How prominent a fold of the motion is depends on how far its branch goes.
  bool alike(const CasePoint& a, const CasePoint& b) const {
    if (a.family != b.family) return false;
    const double least = std::min(a.prominence, b.prominence), most = std::max(a.prominence, b.prominence);
    return least <= 0 || least >= of_the_motion * scales_.parameter || most <= prominence_factor * least;
  }

  /// Whether two branches of a case show one point.
  bool shared(const CasePoint& a, const CasePoint& b) const {
    constexpr double round_off = 1e-6;
    return a.family == b.family && a.branch != b.branch &&
           std::abs(a.parameter - b.parameter) <= a.half + b.half + round_off * scales_.parameter &&
           std::abs(a.displacement - b.displacement) <= round_off * scales_.displacement;
  }

  void gather(const std::vector<CasePoint>& points) {
    std::vector<std::size_t> order(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (points[k].owner >= links_.size()) throw std::invalid_argument("a point belongs to no case");
      order[k] = k;
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return value_order(points[a]) < value_order(points[b]); });
    for (const std::size_t k : order) {
      std::vector<PlacedPoint>& own = places_[points[k].owner];
      const auto same = std::find_if(own.begin(), own.end(), [&](const PlacedPoint& place) {
        return std::all_of(place.members.begin(), place.members.end(),
                           [&](std::size_t member) { return shared(points[member], points[k]); });
      });
      if (same != own.end())
        same->members.push_back(k);
      else
        own.push_back({points[k], {k}});
    }
  }

  /// The farthest that points of a family may be apart; those that are not named: farthest_pair.
  using Bounds = std::map<std::string, double>;

  /// One to one, nearest first, within the bounds.
  std::vector<Pair> pairs(const PlacedPoints& left, const PlacedPoints& right, const Bounds& bounds) const {
    std::vector<Pair> candidates, out;
    for (std::size_t l = 0; l < left.size(); ++l)
      for (std::size_t r = 0; r < right.size(); ++r) {
        if (!alike(left[l]->point, right[r]->point)) continue;
        const auto bound = bounds.find(left[l]->point.family);
        const double apart = distance(left[l]->point, right[r]->point);
        if (apart <= (bound == bounds.end() ? farthest_pair : bound->second)) candidates.push_back({l, r, apart});
      }
    std::sort(candidates.begin(), candidates.end(), [&](const Pair& a, const Pair& b) {
      if (a.distance != b.distance) return a.distance < b.distance;
      return std::make_pair(value_order(left[a.left]->point), value_order(right[a.right]->point)) <
             std::make_pair(value_order(left[b.left]->point), value_order(right[b.right]->point));
    });
    std::vector<char> left_used(left.size(), 0), right_used(right.size(), 0);
    for (const Pair& one : candidates) {
      if (left_used[one.left] || right_used[one.right]) continue;
      left_used[one.left] = right_used[one.right] = 1;
      out.push_back(one);
    }
    return out;
  }

  static PlacedPoints own_places(const std::vector<PlacedPoint>& places) {
    PlacedPoints out;
    for (const PlacedPoint& one : places) out.push_back(&one);
    return out;
  }

  /// Whether no other point is less than three times as far from either end.
  bool clear(const Pair& pair, const PlacedPoints& left, const PlacedPoints& right) const {
    const auto rival = [&](const PlacedPoint* from, const PlacedPoints& among, const PlacedPoint* other) {
      return std::any_of(among.begin(), among.end(), [&](const PlacedPoint* one) {
        return one != other && alike(one->point, from->point) &&
               distance(from->point, one->point) < told_apart * pair.distance;
      });
    };
    return !rival(left[pair.left], right, right[pair.right]) && !rival(right[pair.right], left, left[pair.left]);
  }

  /// How far points of `c` may be from those of the case that it is linked to.
  Bounds bounds_of_link(std::size_t c) const {
    Bounds largest;
    if (!links_[c].refined) return largest;
    for (const std::size_t coarser : children_[c]) {
      if (links_[coarser].along != links_[c].along) continue;
      const PlacedPoints left = own_places(places_[c]), right = own_places(places_[coarser]);
      for (const Pair& one : pairs(left, right, {}))
        if (clear(one, left, right)) {
          double& bound = largest[left[one.left]->point.family];
          bound = std::max(bound, one.distance);
        }
    }
    for (auto& [family, bound] : largest) bound = std::clamp(slack * bound, always_near, farthest_pair);
    return largest;
  }

  void follow(std::size_t c, std::vector<char>& met) {
    met[c] = 1;
    if (links_[c].to) join(c, *links_[c].to);
    for (PlacedPoint& place : places_[c]) {
      if (place.identity >= 0) continue;
      place.identity = static_cast<int>(first_.size());
      first_[place.identity] = &place;
      known_[c][place.identity] = {&place, std::nullopt};
    }
    for (const std::size_t child : children_[c]) follow(child, met);
  }

  void join(std::size_t c, std::size_t to) {
    known_[c] = known_[to];
    PlacedPoints left;
    std::vector<int> identities;
    for (const auto& [identity, known] : known_[to]) {
      left.push_back(known.place);
      identities.push_back(identity);
    }
    const PlacedPoints right = own_places(places_[c]);
    for (const Pair& one : pairs(left, right, bounds_of_link(c))) {
      PlacedPoint& place = places_[c][one.right];
      place.identity = identities[one.left];
      const Known& before = known_[to].at(place.identity);
      const double reach = std::max(2 * one.distance, slack * before.moved.value_or(0));
      place.sharing = static_cast<int>(std::count_if(right.begin(), right.end(), [&](const PlacedPoint* other) {
        return alike(other->point, place.point) &&
               (other == &place || distance(other->point, before.place->point) <= reach);
      }));
      place.clear = clear(one, left, right);
      known_[c][place.identity] = {&place, one.distance};
    }
  }

  /// What the two finest cases of a refinement both have, told from all others.
  std::set<int> confirmed() const {
    std::set<int> out;
    for (std::size_t c = 0; c < links_.size(); ++c) {
      const CaseLink& link = links_[c];
      if (!link.to || !link.refined) continue;
      const CaseLink& next = links_[*link.to];
      if (next.to && next.along == link.along) continue;
      for (const PlacedPoint& coarse : places_[c])
        for (const PlacedPoint& fine : places_[*link.to])
          if (coarse.clear && coarse.identity == fine.identity) out.insert(coarse.identity);
    }
    return out;
  }

  const PointScales& scales_;
  const std::vector<CaseLink>& links_;
  std::vector<std::vector<PlacedPoint>> places_;
  std::vector<std::map<int, Known>> known_;
  std::vector<std::vector<std::size_t>> children_;
  std::map<int, const PlacedPoint*> first_;  ///< where an identity was met first, nearest to the reference
};

}  // namespace

MatchedPoints match_points(const std::vector<CasePoint>& points, const std::vector<CaseLink>& links,
                           const PointScales& scales) {
  return Matching(points, links, scales).result(points.size());
}

PointPresence presence_of(double parameter, double margin, int sharing, const std::vector<BranchReach>& reaches,
                          std::optional<BranchReach>* passed) {
  if (sharing > 0) return sharing > 1 ? PointPresence::many : PointPresence::found;
  std::optional<BranchReach> best;
  for (const BranchReach& one : reaches)
    if (one.from < parameter - margin && one.to > parameter + margin &&
        (!best || one.to - one.from > best->to - best->from))
      best = one;
  if (passed) *passed = best;
  return best ? PointPresence::absent : PointPresence::not_reached;
}

}  // namespace ricochet
