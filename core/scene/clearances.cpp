#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/named_stops.hpp>

namespace ricochet {
namespace {

using Entries = std::vector<std::pair<int, double>>;

// Entries of one number together, zeros left out.
Entries gathered_entries(Entries entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  Entries out;
  for (const auto& [number, value] : entries) {
    if (!out.empty() && out.back().first == number)
      out.back().second += value;
    else
      out.emplace_back(number, value);
  }
  std::erase_if(out, [](const auto& entry) { return entry.second == 0; });
  return out;
}

// The place of one component of a clearance.
Place along(Place place, const std::string& component) {
  if (place.point.empty())
    place.component = component;
  else
    place.point += "." + component;
  return place;
}

void refuse_own_component(const Place& place, const std::string& pointer) {
  if (!place.component.empty() || !place.direction.empty() || !place.dofs.empty())
    throw InputError(pointer, R"(a clearance has components of its own; expected {"x": m}, {"node": name} or )"
                              R"({"point": name})");
}

}  // namespace

std::vector<NamedStop> clearance_rows(const NamedStop& stop, const ClearanceSpec& clearance) {
  const std::string pointer = fmt::format("/scene/stops/{}", stop.entry);
  for (const auto& [bound, key] : {std::pair(&stop.lower, "/lower"), {&stop.upper, "/upper"}})
    if (*bound) throw InputError(pointer + key, "a clearance is bounded by its radius; expected no other bound");
  refuse_own_component(stop.at, pointer + "/at");
  if (stop.to) refuse_own_component(*stop.to, pointer + "/to");
  const auto& [first, second] = clearance.components;
  // Opposite sides are one row with two bounds.
  const bool opposite = clearance.sides % 2 == 0;
  std::vector<NamedStop> rows;
  for (int k = 0; k < (opposite ? clearance.sides / 2 : clearance.sides); ++k) {
    NamedStop& row = rows.emplace_back(stop);
    row.side.emplace();
    row.side->number = k;
    row.side->angle = 2 * std::numbers::pi * k / clearance.sides;
    row.side->radius = clearance.radius;
    row.side->sides = clearance.sides;
    row.side->offset = clearance.offset;
    row.at = along(stop.at, first);
    row.side->across = along(stop.at, second);
    if (stop.to) {
      row.to = along(*stop.to, first);
      row.side->across_to = along(*stop.to, second);
    }
    const auto [cosine, sine] = side_direction(row.side->angle);
    const double middle = cosine * clearance.offset[0] + sine * clearance.offset[1];
    row.upper = middle + clearance.radius;
    if (opposite) row.lower = middle - clearance.radius;
  }
  return rows;
}

std::array<NamedStop, 2> circle_rows(const NamedStop& first) {
  std::array<NamedStop, 2> rows{first, first};
  for (const int axis : {0, 1}) {
    NamedStop& row = rows[static_cast<std::size_t>(axis)];
    ClearanceSide& side = *row.side;
    side.number = axis;
    side.angle = axis * std::numbers::pi / 2;
    side.circle = true;
    row.lower = side.offset[static_cast<std::size_t>(axis)] - side.radius;
    row.upper = side.offset[static_cast<std::size_t>(axis)] + side.radius;
  }
  return rows;
}

StopsSpec with_circles(StopsSpec stops) {
  std::vector<NamedStop> rows;
  for (NamedStop& stop : stops.named)
    if (!stop.side || stop.side->circle)
      rows.push_back(std::move(stop));
    else if (stop.side->number == 0)
      for (NamedStop& row : circle_rows(stop)) rows.push_back(std::move(row));
  stops.named = std::move(rows);
  return stops;
}

double polygon_error(double radius, int sides) {
  return radius * (1 / std::cos(std::numbers::pi / sides) - 1);
}

PlaceRow combined(double a, const PlaceRow& x, double b, const PlaceRow& y) {
  PlaceRow out;
  out.x = x.x;
  const auto add = [](double factor, const Entries& from, Entries& to) {
    for (const auto& [number, value] : from) to.emplace_back(number, factor * value);
  };
  add(a, x.free, out.free);
  add(b, y.free, out.free);
  add(a, x.held, out.held);
  add(b, y.held, out.held);
  out.free = gathered_entries(std::move(out.free));
  out.held = gathered_entries(std::move(out.held));
  return out;
}

PlaceRow axis_row(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop, std::size_t number,
                  int axis) {
  const std::string pointer = fmt::format("/scene/stops/{}", number);
  const Place& at = axis == 0 ? stop.at : stop.side->across;
  const std::optional<Place>& to = axis == 0 ? stop.to : stop.side->across_to;
  try {
    const PlaceRow row = place_row(scene, space, at, pointer + "/at");
    return to ? difference(row, place_row(scene, space, *to, pointer + "/to")) : row;
  } catch (const InputError& error) {
    const bool component = error.pointer().ends_with("/component") || (!at.point.empty());
    throw InputError(component ? fmt::format("{}/clearance/components/{}", pointer, axis) : error.pointer(),
                     error.what());
  }
}

PlaceRow side_row(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop, std::size_t number) {
  const auto [first, second] = side_direction(stop.side->angle);
  return combined(first, axis_row(scene, space, stop, number, 0), second, axis_row(scene, space, stop, number, 1));
}

void check_clearance(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop,
                     std::size_t number) {
  for (const int axis : {0, 1})
    if (axis_row(scene, space, stop, number, axis).free.empty())
      throw InputError(fmt::format("/scene/stops/{}/clearance/components/{}", number, axis),
                       fmt::format("{} is held along it: nothing there can move; expected a place that moves along "
                                   "both, or a stop along the other",
                                   stop.name));
}

std::vector<Clearance> clearances_of(const StopsSpec& stops) {
  std::vector<Clearance> out;
  for (std::size_t i = 0; i < stops.named.size(); ++i) {
    const NamedStop& stop = stops.named[i];
    if (!stop.side) continue;
    if (stop.side->number == 0)
      out.push_back({.name = stop.name,
                     .first = static_cast<int>(i),
                     .angles = {},
                     .radius = stop.side->radius,
                     .offset = stop.side->offset,
                     .sides = stop.side->sides,
                     .circle = stop.side->circle});
    out.back().angles.push_back(stop.side->angle);
  }
  return out;
}

std::vector<std::string> polygon_notes(const std::vector<Clearance>& clearances) {
  std::vector<std::string> notes;
  for (const Clearance& one : clearances)
    if (!one.circle)
      notes.push_back(
          fmt::format("stop {} is a polygon of {} sides: its corners lie {:.2g} m beyond the circle of {:.6g} m",
                      one.name, one.sides, polygon_error(one.radius, one.sides), one.radius));
  return notes;
}

}  // namespace ricochet
