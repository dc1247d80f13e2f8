#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/measure/orbits/special_points.hpp>
#include <utility>

namespace ricochet {

namespace {

using Corners = std::vector<BranchCorner>;

SpecialPoint at_corner(const Corners& corners, std::size_t i, PointKind kind) {
  SpecialPoint point;
  point.kind = kind;
  point.corner = static_cast<long long>(i);
  point.parameter = corners[i].parameter;
  point.arc = corners[i].arc;
  point.tip = corners[i].tip;
  point.runs_before = corners[i > 0 ? i - 1 : 0].runs;
  point.runs_after = corners[i].runs;
  point.held_before = corners[i > 0 ? i - 1 : 0].held;
  point.held_after = corners[i].held;
  return point;
}

bool contact_changes(const BranchCorner& was, const BranchCorner& now) {
  return was.runs != now.runs || was.held != now.held;
}

void add_note(SpecialPoint& point, const std::string& text) {
  point.note += (point.note.empty() ? "" : "; ") + text;
}

// Of a corner and the one before, the larger. m: arclength to which orbits are known where stops give back speed.
double larger_at(const Corners& corners, std::size_t i, double BranchCorner::*known) {
  return std::max(corners[i].*known, corners[i > 0 ? i - 1 : 0].*known);
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
  bool jumps = false;  // with a contact that comes or goes
};

// What of the multipliers is counted, and the function whose zero is the crossing.
struct Circle {
  PointKind kind;
  int Outside::*count;
  bool pair;
};

double distance(const CornerRoots& roots, bool pair) {
  if (!pair) return roots.product;
  return roots.modulus == 0 ? NAN : roots.modulus - 1;
}

// Which way multipliers cross between two corners: 1 outwards, −1 inwards, 0 none does. Pairs that meet on the axis
// outside the circle cross nothing; a real one that was one of a pair before does.
int way_of(const CornerRoots& was, const CornerRoots& now, const Circle& circle) {
  const int counted = now.outside.*circle.count - was.outside.*circle.count,
            total = now.outside.total - was.outside.total;
  const auto sign = [](int number) { return number > 0 ? 1 : -1; };
  if (!circle.pair && (was.product < 0) != (now.product < 0)) return sign(total != 0 ? total : counted);
  return counted * total > 0 ? sign(counted) : 0;
}

std::vector<Crossing> crossings_of(const Corners& corners, const Circle& circle, bool by_steps) {
  std::vector<Crossing> all;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const BranchCorner &was = corners[i - 1], &now = corners[i];
    const bool jumps = contact_changes(was, now);
    const int raw = way_of(was.raw, now.raw, circle), smooth = way_of(was.smooth, now.smooth, circle);
    const Crossing here{i, true, raw, now.parameter, now.arc, now.tip, {}, jumps};
    if (raw != 0 && (jumps || !by_steps)) all.push_back(here);
    if (smooth == 0) continue;
    Crossing root = here;
    root.raw = false;
    root.sign = smooth;
    const double before = distance(was.smooth, circle.pair), after = distance(now.smooth, circle.pair);
    // Between two orbits by steps a multiplier may jump over the circle.
    const bool passes = before * after <= 0 && before != after;
    if (!jumps) {
      if (!passes && !by_steps) continue;
      const double share = passes ? before / (before - after) : 0.5;
      const auto between = [&](double a, double b) { return a + share * (b - a); };
      root.value = between(was.parameter, now.parameter);
      root.arc = between(was.arc, now.arc);
      root.tip = between(was.tip, now.tip);
      if (passes)
        root.multiplier =
            circle.pair ? std::polar(1.0, between(was.smooth.angle, now.smooth.angle)) : std::complex<double>(-1);
    }
    all.push_back(root);
  }
  return all;
}

// The crossing of a group that stands for it: as much of the arc as may be lies on the side where it belongs, of what
// is counted before and after it.
const Crossing* stands_for(const std::vector<const Crossing*>& group, int net) {
  const Crossing* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < group.size(); ++j) {
    if (group[j]->sign * net <= 0) continue;
    double amiss = 0;
    int count = 0;
    for (std::size_t k = 0; k + 1 < group.size(); ++k) {
      count += group[k]->sign;
      amiss += std::abs(count - (k < j ? 0 : net)) * (group[k + 1]->arc - group[k]->arc);
    }
    if (amiss < least) {
      least = amiss;
      best = group[j];
    }
  }
  return best;
}

void add_group(const Corners& corners, const Circle& circle, const std::vector<Crossing>& group,
               std::vector<SpecialPoint>& points) {
  const std::size_t first = group.front().corner, last = group.back().corner;
  std::vector<const Crossing*> smooth, raw;
  int raw_net = 0, smooth_net = 0;
  for (const Crossing& one : group) {
    (one.raw ? raw : smooth).push_back(&one);
    (one.raw ? raw_net : smooth_net) += one.sign;
  }
  const Crossing* root = stands_for(smooth, smooth_net);
  const bool frozen = root == nullptr;
  if (frozen) root = stands_for(raw, raw_net);
  if (!root) return;
  SpecialPoint point = at_corner(corners, root->corner, circle.kind);
  point.parameter = root->value;
  point.arc = root->arc;
  point.tip = root->tip;
  point.multiplier = root->multiplier;
  point.low = point.high = root->value;
  point.crossings = static_cast<int>(raw.size());
  for (const Crossing& one : group) widen(point, one.value);
  if (raw.size() <= 1)  // known to the pieces on both sides
    for (const std::size_t i : {first - 1, last, std::min(last + !raw.empty(), corners.size() - 1)})
      widen(point, corners[i].parameter);
  if (root->jumps)
    add_note(point, "at a change of contact, where multipliers jump");
  else if (frozen)
    add_note(point, "by the frozen multipliers alone");
  else if (!root->multiplier)
    add_note(point, "a multiplier jumps over the circle");
  if (smooth.size() > 1)
    add_note(point, fmt::format("the half-step rule crosses {} times; one stands for them", smooth.size()));
  int shortest = corners[first].shortest;
  for (std::size_t i = first - 1; i <= last; ++i)
    if (corners[i].shortest > 0) shortest = std::min(shortest, corners[i].shortest);
  if (shortest > 0 && shortest < shortest_told && larger_at(corners, last, &BranchCorner::rebounds) == 0 &&
      !root->jumps)
    add_note(point, fmt::format("unresolved: a run of contact has {} step{}", shortest, shortest == 1 ? "" : "s"));
  points.push_back(std::move(point));
}

// What of a group whose crossings cancel is a point each: those before and after the longest stretch of arc on which
// the count differs, where it is more than a few corners long. Else all of it.
std::vector<std::vector<Crossing>> parted(const Corners& corners, std::vector<Crossing> group) {
  const bool smooth = std::any_of(group.begin(), group.end(), [](const Crossing& one) { return !one.raw; });
  std::size_t begins = 0, ends = 0;
  double longest = 0;
  int count = 0;
  const Crossing* last = nullptr;
  for (const Crossing& one : group) {
    if (one.raw == smooth) continue;
    if (last && count != 0 && one.corner - last->corner > few_corners && one.arc - last->arc > longest) {
      longest = one.arc - last->arc;
      begins = last->corner;
      ends = one.corner;
    }
    count += one.sign;
    last = &one;
  }
  if (count != 0 || longest == 0) return {std::move(group)};
  const double middle = 0.5 * (corners[begins].arc + corners[ends].arc);
  std::vector<std::vector<Crossing>> parts(2);
  for (Crossing& one : group) parts[one.arc < middle ? 0 : 1].push_back(std::move(one));
  return parts;
}

void add_crossings(const Corners& corners, const Circle& circle, const PointSearch& search,
                   std::vector<SpecialPoint>& points) {
  std::vector<Crossing> group;
  const auto flush = [&] {
    if (group.empty()) return;
    for (const std::vector<Crossing>& part : parted(corners, std::move(group)))
      add_group(corners, circle, part, points);
    group.clear();
  };
  for (const Crossing& one : crossings_of(corners, circle, search.by_steps)) {
    if (!group.empty()) {
      const std::size_t last = group.back().corner;
      const double apart = corners[one.corner].arc - corners[last].arc;
      const bool near = search.by_steps ? one.corner == last
                                        : apart < group_arc * search.gap ||
                                              (static_cast<long long>(one.corner - last) < group_pieces &&
                                               apart < group_pieces_arc * search.gap);
      if (!near) flush();
    }
    group.push_back(one);
  }
  flush();
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

// Widens an interval by what is not known of the orbits along the branch. At a fold λ stands still along it: an orbit
// that is known to so much is one of a value that far. Orbits are known as their impacts are placed, multipliers to
// first order in the step.
void place(const Corners& corners, double metres, SpecialPoint& point) {
  const auto i = static_cast<std::size_t>(std::max(1LL, point.corner));
  if (i >= corners.size()) return;
  const double far = corners[i].arc - corners[i - 1].arc;
  double by = larger_at(corners, i, &BranchCorner::placed) / metres;
  if (point.kind != PointKind::fold) {
    if (!(far > 0)) return;
    by = larger_at(corners, i, &BranchCorner::rebounds) * std::abs(corners[i].parameter - corners[i - 1].parameter) /
         far;
  }
  point.low -= by;
  point.high += by;
  add_note(point, "stops give back speed: the interval is not exact");
}

// Whether a real multiplier passes 1 between the neighbours of a corner, as it does at a fold.
bool passes_one(const Corners& corners, std::size_t i) {
  return corners[i - 1].raw.outside.above != corners[i + 1].raw.outside.above;
}

void add_folds(const BranchTrace& trace, const PointSearch& search, std::vector<SpecialPoint>& points) {
  const Corners& corners = trace.corners;
  for (const Turn& turn : turns_of(trace, search.before)) {
    // What turns within the uncertainty of its orbits turns nowhere.
    const double unknown =
        2 * larger_at(corners, static_cast<std::size_t>(turn.corner), &BranchCorner::placed) / search.metres;
    const double least = std::max(search.prominence, unknown);
    const auto i = static_cast<std::size_t>(turn.corner);
    if (turn.prominence < least) continue;
    // Along a curve the multipliers tell a fold from a kink, however soon the branch ends behind it.
    const bool told = search.by_steps && passes_one(corners, i);
    if (turn.shortest < cut_share * least && !told) continue;
    SpecialPoint point = at_corner(corners, i, PointKind::fold);
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

// What a change of contact is called.
void name_contact(SpecialPoint& point) {
  if (std::min(point.runs_before, point.runs_after) == 0)
    add_note(point, "first contact");
  else if (point.held_before != point.held_after)
    add_note(point, "a permanent contact opens");
}

void add_contacts_between(const Corners& corners, const PointSearch& search, std::vector<SpecialPoint>& points) {
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const BranchCorner &was = corners[i - 1], &now = corners[i];
    if (!contact_changes(was, now)) continue;
    SpecialPoint point = at_corner(corners, i, PointKind::contact);
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
    name_contact(point);
    points.push_back(std::move(point));
  }
}

// A run that appears with its first step, or vanishes with its last one; a permanent contact that opens or stays. A
// margin is 0 at the corner: λ is known as the orbit is. A run that is cut in two, and two that become one, are none.
void add_contacts(const Corners& corners, const PointSearch& search, std::vector<SpecialPoint>& points) {
  std::vector<std::pair<SpecialPoint, int>> found;  // with the number of contacts that change at once
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const BranchCorner &was = corners[i - 1], &now = corners[i];
    if (now.change.step < 0) continue;
    const bool begins =
        now.change.closes ? now.runs > was.runs || now.held > was.held : now.runs < was.runs || now.held < was.held;
    if (!begins) continue;
    const double at_once = met_at_once * std::abs(now.parameter);
    if (!found.empty() && std::abs(found.back().first.parameter - now.parameter) <= at_once) {
      found.back().first.runs_after = now.runs;
      found.back().first.held_after = now.held;
      ++found.back().second;
      continue;
    }
    SpecialPoint point = at_corner(corners, i, PointKind::contact);
    const double known = at_once + round_offs * now.residual / search.metres;
    point.low = point.parameter - known;
    point.high = point.parameter + known;
    point.side = now.change.upper ? "upper" : "lower";
    point.change = now.change;
    found.emplace_back(std::move(point), 1);
  }
  for (auto& [point, together] : found) {
    if (point.runs_before == point.runs_after && point.held_before == point.held_after) continue;
    name_contact(point);
    if (together > 1) add_note(point, fmt::format("{} contacts change at once", together));
    points.push_back(std::move(point));
  }
}

// A branch that comes by a place again has what is there once.
void tell_once(std::vector<SpecialPoint>& points, double same_tip) {
  std::vector<SpecialPoint> once;
  for (SpecialPoint& point : points) {
    const auto known = [&](const SpecialPoint& one) {
      return one.kind != PointKind::mark && one.kind == point.kind && one.side == point.side && one.low <= point.high &&
             point.low <= one.high && std::abs(one.tip - point.tip) <= same_tip;
    };
    if (std::none_of(once.begin(), once.end(), known)) once.push_back(std::move(point));
  }
  points = std::move(once);
}

}  // namespace

std::vector<SpecialPoint> special_points(const BranchTrace& trace, const PointSearch& search) {
  std::vector<SpecialPoint> points;
  const Corners& corners = trace.corners;
  if (corners.empty()) return points;
  add_folds(trace, search, points);
  add_crossings(corners, {search.half ? PointKind::symmetry : PointKind::flip, &Outside::below, false}, search, points);
  add_crossings(corners, {PointKind::torus, &Outside::pairs, true}, search, points);
  if (search.by_steps)
    add_contacts_between(corners, search, points);
  else
    add_contacts(corners, search, points);
  // Next to a graze, where the derivative is infinite, multipliers change their sign.
  if (trace.ends == TraceEnd::left && trace.grazes())
    std::erase_if(points, [&](const SpecialPoint& one) {
      const bool crossing =
          one.kind == PointKind::flip || one.kind == PointKind::symmetry || one.kind == PointKind::torus;
      return crossing && one.corner + 2 >= static_cast<long long>(corners.size());
    });
  if (trace.rebounds > 0)
    for (SpecialPoint& point : points) place(corners, search.metres, point);
  for (const MarkedOrbit& mark : trace.marks) {
    SpecialPoint point = at_corner(corners, static_cast<std::size_t>(mark.corner), PointKind::mark);
    point.parameter = point.low = point.high = mark.parameter;
    point.arc = mark.arc;
    point.tip = mark.tip;
    points.push_back(std::move(point));
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const SpecialPoint& a, const SpecialPoint& b) { return a.arc < b.arc; });
  tell_once(points, std::max(1e-6 * search.gap, trace.rebounds));
  if (trace.ended()) {
    SpecialPoint end = at_corner(corners, corners.size() - 1, PointKind::end);
    end.low = end.high = end.parameter;
    end.ends = trace.ends;
    end.note = trace.end;
    points.push_back(std::move(end));
  }
  return points;
}

}  // namespace ricochet
