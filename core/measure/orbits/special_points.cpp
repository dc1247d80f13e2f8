#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <ricochet/measure/orbits/special_points.hpp>

namespace ricochet {

std::vector<Turn> turns_of(const BranchTrace& trace) {
  const auto& corners = trace.corners;
  if (corners.empty()) return {};
  std::vector<Turn> turns;
  std::vector<double> path = {corners.front().parameter};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    if (corners[i].way != corners[i - 1].way) {
      turns.push_back({static_cast<long long>(i), corners[i].parameter, 0});
      path.push_back(corners[i].parameter);
    }
  path.push_back(corners.back().parameter);
  // Indices of path that are left: the ends, and turns.
  std::list<std::size_t> left;
  for (std::size_t i = 0; i < path.size(); ++i) left.push_back(i);
  while (left.size() > 2) {
    auto smallest = left.begin();
    double least = std::numeric_limits<double>::infinity();
    for (auto at = left.begin(); std::next(at) != left.end(); ++at)
      if (const double way = std::abs(path[*std::next(at)] - path[*at]); way < least) {
        least = way;
        smallest = at;
      }
    const auto next = std::next(smallest);
    const auto take = [&](std::list<std::size_t>::iterator at) {
      if (*at == 0 || *at + 1 == path.size()) return;
      turns[*at - 1].prominence = least;
      left.erase(at);
    };
    take(next);
    take(smallest);
  }
  return turns;
}

namespace {

using Corners = std::vector<BranchCorner>;

SpecialPoint at_corner(const Corners& corners, std::size_t i, const char* kind, const char* label) {
  SpecialPoint point;
  point.kind = kind;
  point.label = label;
  point.corner = static_cast<long long>(i);
  point.parameter = corners[i].parameter;
  point.arc = corners[i].arc;
  point.tip = corners[i].tip;
  point.runs_before = corners[i > 0 ? i - 1 : 0].runs;
  point.runs_after = corners[i].runs;
  return point;
}

void widen(SpecialPoint& point, double value) {
  point.low = std::min(point.low, value);
  point.high = std::max(point.high, value);
}

// A crossing: between corners i − 1 and i.
struct Crossing {
  std::size_t corner = 0;
  bool raw = false;
  int sign = 0;                        // outwards or inwards
  double value = 0, arc = 0, tip = 0;  // of a smooth one: where it is by linear interpolation
  std::optional<std::complex<double>> multiplier;
};

// What of the multipliers is counted, and the function whose zero is the crossing.
struct Circle {
  const char *kind, *label;
  int Outside::*count;
  bool pair;
};

double distance(const CornerRoots& roots, bool pair) {
  if (pair) return roots.modulus == 0 ? NAN : roots.modulus - 1;
  return roots.real == 0 ? NAN : -1 - roots.real;
}

std::vector<Crossing> crossings_of(const Corners& corners, const Circle& circle, bool by_steps) {
  std::vector<Crossing> all;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const BranchCorner &was = corners[i - 1], &now = corners[i];
    if (was.runs != now.runs) continue;  // multipliers jump with a contact that comes or goes
    // Pairs that meet on the axis outside the circle cross nothing.
    const int counted = now.raw.outside.*circle.count - was.raw.outside.*circle.count;
    if (!by_steps && counted * (now.raw.outside.total - was.raw.outside.total) > 0)
      all.push_back({i, true, counted > 0 ? 1 : -1, now.parameter, now.arc, now.tip, {}});
    const int smooth = now.smooth.outside.*circle.count - was.smooth.outside.*circle.count;
    if (smooth * (now.smooth.outside.total - was.smooth.outside.total) <= 0) continue;
    const double before = distance(was.smooth, circle.pair), after = distance(now.smooth, circle.pair);
    // Between two orbits by steps a multiplier may jump over the circle.
    const bool passes = before * after <= 0 && before != after;
    if (!passes && !by_steps) continue;
    const double share = passes ? before / (before - after) : 0.5;
    const auto between = [&](double a, double b) { return a + share * (b - a); };
    std::optional<std::complex<double>> multiplier;
    if (passes)
      multiplier =
          circle.pair ? std::polar(1.0, between(was.smooth.angle, now.smooth.angle)) : std::complex<double>(-1);
    all.push_back({i, false, smooth > 0 ? 1 : -1, between(was.parameter, now.parameter), between(was.arc, now.arc),
                   between(was.tip, now.tip), multiplier});
  }
  return all;
}

void add_group(const Corners& corners, const Circle& circle, const std::vector<Crossing>& group, bool rebounds,
               std::vector<SpecialPoint>& points) {
  const std::size_t first = group.front().corner, last = group.back().corner;
  std::vector<const Crossing*> smooth, raw;
  int raw_net = 0, smooth_net = 0;
  for (const Crossing& one : group) {
    (one.raw ? raw : smooth).push_back(&one);
    (one.raw ? raw_net : smooth_net) += one.sign;
  }
  if (raw_net == 0 && smooth_net == 0) return;
  SpecialPoint point = at_corner(corners, last, circle.kind, circle.label);
  if (raw.empty()) {
    point.low = point.high = corners[smooth.front()->corner - 1].parameter;
    for (const Crossing* one : smooth) {
      widen(point, corners[one->corner - 1].parameter);
      widen(point, corners[one->corner].parameter);
    }
  } else {
    point.low = point.high = raw.front()->value;
    for (const Crossing* one : raw) widen(point, one->value);
    if (raw.size() == 1)  // known to the pieces on both sides
      for (const std::size_t i : {first - 1, std::min(first + 1, corners.size() - 1)})
        widen(point, corners[i].parameter);
    point.crossings = static_cast<int>(raw.size());
  }
  if (!smooth.empty()) {
    const Crossing& root = *smooth[smooth.size() / 2];
    point.corner = static_cast<long long>(root.corner);
    point.parameter = root.value;
    point.arc = root.arc;
    point.tip = root.tip;
    point.multiplier = root.multiplier;
    if (!root.multiplier) point.note = "a multiplier jumps over the circle";
    if (smooth.size() > 1)
      point.note = fmt::format("the half-step rule crosses {} times; the middle one stands for them", smooth.size());
  } else {
    const Crossing& middle = *raw[raw.size() / 2];
    point.corner = static_cast<long long>(middle.corner);
    point.parameter = middle.value;
    point.arc = middle.arc;
    point.tip = middle.tip;
    point.note = "by the frozen multipliers alone";
  }
  int shortest = corners[first].shortest;
  for (std::size_t i = first - 1; i <= last; ++i)
    if (corners[i].shortest > 0) shortest = std::min(shortest, corners[i].shortest);
  const auto say = [&](const std::string& text) { point.note += (point.note.empty() ? "" : "; ") + text; };
  if (shortest > 0 && shortest < shortest_told && !rebounds)
    say(fmt::format("unresolved: a run of contact has {} step{}", shortest, shortest == 1 ? "" : "s"));
  if (point.parameter < point.low || point.parameter > point.high)
    say("its root lies outside the crossings of the frozen multipliers");
  points.push_back(std::move(point));
}

void add_crossings(const Corners& corners, const Circle& circle, const PointSearch& search,
                   std::vector<SpecialPoint>& points) {
  std::vector<Crossing> group;
  const auto flush = [&] {
    if (!group.empty()) add_group(corners, circle, group, search.placed > 0, points);
    group.clear();
  };
  for (const Crossing& one : crossings_of(corners, circle, search.by_steps)) {
    if (!group.empty()) {
      const std::size_t last = group.back().corner;
      const bool near = static_cast<long long>(one.corner - last) < group_pieces ||
                        corners[one.corner].arc - corners[last].arc < group_arc * search.gap;
      if (!near || search.by_steps) flush();
    }
    group.push_back(one);
  }
  flush();
}

// A count outside that changes with a contact that comes or goes: where multipliers jump over −1.
void add_jumps(const Corners& corners, const Circle& circle, std::vector<SpecialPoint>& points) {
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const BranchCorner &was = corners[i - 1], &now = corners[i];
    const int counted = now.raw.outside.*circle.count - was.raw.outside.*circle.count;
    if (was.runs == now.runs || counted * (now.raw.outside.total - was.raw.outside.total) <= 0) continue;
    SpecialPoint point = at_corner(corners, i, circle.kind, circle.label);
    point.low = point.high = was.parameter;
    widen(point, now.parameter);
    widen(point, corners[std::min(i + 1, corners.size() - 1)].parameter);
    point.crossings = 1;
    point.note = "at a change of contact, where multipliers jump";
    points.push_back(std::move(point));
  }
}

// λ at the vertex of the parabola through a corner at which it turns and its neighbours.
double vertex(const Corners& corners, std::size_t i) {
  const BranchCorner &a = corners[i - 1], &b = corners[i], &c = corners[i + 1];
  const double before = b.arc - a.arc, after = c.arc - b.arc;
  if (!(before > 0) || !(after > 0)) return b.parameter;
  const double left = (b.parameter - a.parameter) / before, right = (c.parameter - b.parameter) / after;
  const double curve = (right - left) / (before + after), slope = (left * after + right * before) / (before + after);
  return curve == 0 ? b.parameter : b.parameter - slope * slope / (4 * curve);
}

// Widens an interval by what is not known of the orbits along the branch.
void place(const Corners& corners, double placed, SpecialPoint& point) {
  const auto i = static_cast<std::size_t>(std::max(1LL, point.corner));
  if (i >= corners.size()) return;
  const double far = corners[i].arc - corners[i - 1].arc;
  if (!(far > 0)) return;
  const double by = placed * std::abs(corners[i].parameter - corners[i - 1].parameter) / far;
  point.low -= by;
  point.high += by;
  point.note += (point.note.empty() ? "" : "; ") + std::string("stops give back speed: the interval is not exact");
}

void add_folds(const BranchTrace& trace, const PointSearch& search, std::vector<SpecialPoint>& points) {
  const Corners& corners = trace.corners;
  for (const Turn& turn : turns_of(trace)) {
    if (turn.prominence < search.prominence) continue;
    const auto i = static_cast<std::size_t>(turn.corner);
    SpecialPoint point = at_corner(corners, i, "fold", "LP");
    // A motion without contact is one piece, however long: where it touches its stop the other piece tells.
    const double before = std::abs(corners[i].parameter - corners[i - 1].parameter),
                 after = std::abs(corners[i + 1].parameter - corners[i].parameter);
    const bool free = corners[i].runs == 0 || corners[i - 1].runs == 0;
    double half = 0.5 * (free ? std::min(before, after) : std::max(before, after));
    if (search.contacts > 0 && corners[i - 1].runs != corners[i + 1].runs)
      half = search.contacts;
    else if (search.by_steps)
      point.parameter = vertex(corners, i);
    // A corner has no parabola: the orbit that was solved belongs to the interval.
    half = std::max(half, std::abs(point.parameter - corners[i].parameter));
    point.low = point.parameter - half;
    point.high = point.parameter + half;
    point.multiplier = 1;
    point.prominence = turn.prominence;
    point.side = corners[i].way < 0 ? "below" : "above";
    points.push_back(std::move(point));
  }
}

// A run that appears with its first step, or vanishes with its last one.
void add_contacts(const Corners& corners, const PointSearch& search, std::vector<SpecialPoint>& points) {
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const BranchCorner &was = corners[i - 1], &now = corners[i];
    if (was.runs == now.runs || (now.change.step < 0 && !search.by_steps)) continue;
    if (search.by_steps) {
      SpecialPoint point = at_corner(corners, i, "contact", "GR");
      point.low = point.high = was.parameter;
      widen(point, now.parameter);
      if (search.contacts > 0) {
        // On the side with fewer contacts.
        if (was.runs < now.runs) --point.corner;
        const BranchCorner& placed = corners[static_cast<std::size_t>(point.corner)];
        point.parameter = placed.parameter;
        point.arc = placed.arc;
        point.tip = placed.tip;
        point.low = placed.parameter - search.contacts;
        point.high = placed.parameter + search.contacts;
      }
      if (std::min(was.runs, now.runs) == 0) point.note = "first contact";
      points.push_back(std::move(point));
      continue;
    }
    const bool appears = now.change.closes && now.runs > was.runs, vanishes = !now.change.closes && now.runs < was.runs;
    if (!appears && !vanishes) continue;  // a run is cut in two, or two become one
    SpecialPoint point = at_corner(corners, i, "contact", "GR");
    // The shorter one of the two: a motion without contact is one piece, however long. Between bounds that are met at
    // once there is no length.
    const auto away = [&](std::ptrdiff_t way) {
      auto at = static_cast<std::ptrdiff_t>(i);
      double far = 0;
      while (far <= met_at_once * std::abs(now.parameter) && (at += way) >= 0 && at < std::ssize(corners))
        far = std::abs(corners[static_cast<std::size_t>(at)].parameter - now.parameter);
      return far;
    };
    double piece = away(-1);
    if (const double after = away(1); after > 0) piece = std::min(piece, after);
    point.low = point.parameter - piece;
    point.high = point.parameter + piece;
    point.side = now.change.upper ? "upper" : "lower";
    point.change = now.change;
    if (std::min(was.runs, now.runs) == 0) point.note = "first contact";
    points.push_back(std::move(point));
  }
}

}  // namespace

std::vector<SpecialPoint> special_points(const BranchTrace& trace, const PointSearch& search) {
  std::vector<SpecialPoint> points;
  const Corners& corners = trace.corners;
  if (corners.empty()) return points;
  add_folds(trace, search, points);
  const Circle minus =
      search.half ? Circle{"symmetry", "BP", &Outside::below, false} : Circle{"flip", "PD", &Outside::below, false};
  add_crossings(corners, minus, search, points);
  add_jumps(corners, minus, points);
  add_crossings(corners, {"torus", "TR", &Outside::pairs, true}, search, points);
  add_contacts(corners, search, points);
  if (search.placed > 0)
    for (SpecialPoint& point : points) place(corners, search.placed, point);
  for (const MarkedOrbit& mark : trace.marks) {
    SpecialPoint point = at_corner(corners, static_cast<std::size_t>(mark.corner), "mark", "UZ");
    point.parameter = point.low = point.high = mark.parameter;
    point.arc = mark.arc;
    point.tip = mark.tip;
    points.push_back(std::move(point));
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const SpecialPoint& a, const SpecialPoint& b) { return a.arc < b.arc; });
  if (trace.ended()) {
    SpecialPoint end = at_corner(corners, corners.size() - 1, "end", "EP");
    end.low = end.high = end.parameter;
    end.note = trace.end;
    points.push_back(std::move(end));
  }
  return points;
}

}  // namespace ricochet
