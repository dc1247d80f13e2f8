#include "runners/report/structure_sketch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"
#include "runners/report/sketch_lines.hpp"

namespace ricochet::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double sketch_margin = 122, sketch_height_margin = 62, tallest_sketch = 230, lowest_sketch = 60,
                 stop_gap = 12, force_length = 34;
constexpr std::size_t most_sketch_labels = 12;

std::vector<Json> list_at(const SceneValues& scene, const std::string& pointer) {
  const Json* found = scene.at(pointer);
  return found && found->is_array() ? found->get<std::vector<Json>>() : std::vector<Json>();
}

std::optional<double> bound(const Json& stop, const char* side) {
  const auto found = stop.find(side);
  if (found == stop.end()) return std::nullopt;
  const Json& value = found->is_array() && !found->empty() ? found->front() : *found;  // the first of an axis
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

std::string sketched_metres(double value) {
  return number_text(value, 3) + " m";
}

// A face across the direction (dx, dy), hatched on the side that nothing enters.
std::string face(double x, double y, double dx, double dy) {
  std::string hatch;
  for (double u = -9; u <= 9; u += 6)
    hatch += fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}", x - u * dy, y + u * dx, 6 * dx - 3 * dy, 6 * dy + 3 * dx);
  return line(x + 11 * dy, y - 11 * dx, x - 11 * dy, y + 11 * dx, "stop") + path(hatch, "stop");
}

// Beside a mark on the side where it points.
std::string beside(double x, double y, double dx, double dy, const std::string& text) {
  const bool across = std::abs(dx) > 0.5 * std::abs(dy);
  return label(x + 12 * dx,
               y + (across   ? 4 + 12 * dy
                    : dy > 0 ? 22
                             : -12),
               text,
               !across  ? "middle"
               : dx > 0 ? "start"
                        : "end");
}

class NodeSketch {
 public:
  NodeSketch(const SceneValues& scene, const Json& layout, double width)
      : scene_(scene), x_(layout.at("x").get<std::vector<double>>()), y_(layout.at("y").get<std::vector<double>>()) {
    const auto [left, right] = std::minmax_element(x_.begin(), x_.end());
    const auto [low, high] = std::minmax_element(y_.begin(), y_.end());
    const double wide = *right - *left, tall = *high - *low, room = width - 2 * sketch_margin;
    scale_ = std::min(wide > 0 ? room / wide : 1e300, tall > 0 ? tallest_sketch / tall : 1e300);
    left_ = *left - (room / scale_ - wide) / 2;
    top_ = *high;
    height_ = std::max(lowest_sketch, scale_ * tall);
    lift_ = sketch_height_margin + (height_ - scale_ * tall) / 2;
    wide_ = wide;
  }

  StructureSketch draw(const Json& layout, double width) {
    std::string d;
    for (const Json& link : layout.at("links"))
      d += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", px(link[0]), py(link[0]), px(link[1]), py(link[1]));
    std::string out = path(d, "structure mesh");
    for (const Json& node : layout.at("held"))
      out += fmt::format("<rect class=\"solid\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\"/>", px(node) - 4,
                         py(node) - 4);
    const std::vector<Json> stops = list_at(scene_, "/scene/stops");
    for (std::size_t i = 0; i < std::min(stops.size(), layout.at("stops").size()); ++i)
      out += stop(stops[i], layout["stops"][i], stops.size() <= most_sketch_labels);
    for (const Json& load : layout.at("loads")) out += force(load);
    const double bottom = 2 * sketch_height_margin + height_;
    const std::string first = layout["axes"][0], second = layout["axes"][1];
    out += arrow(14, bottom - 12, 44, bottom - 12) + label(50, bottom - 8, first, "start") +
           arrow(14, bottom - 12, 14, bottom - 42) + label(14, bottom - 48, second);
    if (wide_ > 0) {
      const double from = sketch_margin + scale_ * (wide_room(width) - wide_) / 2, to = from + scale_ * wide_;
      out += line(from, bottom - 12, to, bottom - 12, "measure") +
             line(from, bottom - 17, from, bottom - 7, "measure") + line(to, bottom - 17, to, bottom - 7, "measure") +
             label((from + to) / 2, bottom - 16, sketched_metres(wide_));
    }
    return {out, bottom};
  }

 private:
  double wide_room(double width) const { return (width - 2 * sketch_margin) / scale_; }
  double px(const Json& node) const { return sketch_margin + scale_ * (x_.at(node.get<std::size_t>()) - left_); }
  double py(const Json& node) const { return lift_ + scale_ * (top_ - y_.at(node.get<std::size_t>())); }

  std::string stop(const Json& said, const Json& where, bool named) const {
    if (where.at("at").get<int>() < 0) return "";
    const double x = px(where["at"]), y = py(where["at"]);
    double dx = where["direction"][0].get<double>(), dy = -where["direction"][1].get<double>();
    const double length = std::hypot(dx, dy);
    const auto name = said.value("name", "");
    constexpr double leaves = 0.2;
    if (length < leaves)  // along the line of sight
      return fmt::format("<circle class=\"stop\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"9\"/>", x, y) +
             (named ? beside(x, y, 1, -1, name) : "");
    dx /= length;
    dy /= length;
    std::string out;
    if (where.contains("to") && where["to"].get<int>() >= 0)
      out +=
          line(x, y, px(where["to"]), py(where["to"]), "stop") +
          fmt::format("<circle class=\"stop\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\"/>", px(where["to"]), py(where["to"]));
    bool first = true;
    for (const auto& [side, key] : {std::pair(1.0, "upper"), {-1.0, "lower"}}) {
      const std::optional<double> value = bound(said, key);
      if (!value) continue;
      const double sx = side * dx, sy = side * dy;
      out += face(x + stop_gap * sx, y + stop_gap * sy, sx, sy);
      if (named)
        out += beside(x + (stop_gap + 6) * sx, y + (stop_gap + 6) * sy, sx, sy,
                      (first ? name + " " : "") + sketched_metres(*value));
      first = false;
    }
    return out;
  }

  std::string force(const Json& load) const {
    if (load.at("at").get<int>() < 0) return "";
    const double x = px(load["at"]), y = py(load["at"]);
    double dx = load["direction"][0].get<double>(), dy = -load["direction"][1].get<double>();
    const double length = std::hypot(dx, dy);
    if (length == 0) return label(x, y - 10, "F(t)");
    dx /= length;
    dy /= length;
    const double tail_x = x - force_length * dx, tail_y = y - force_length * dy;
    return arrow(tail_x, tail_y, x - 5 * dx, y - 5 * dy) + beside(tail_x, tail_y, -dx, -dy, "F(t)");
  }

  const SceneValues& scene_;
  std::vector<double> x_, y_;
  double scale_ = 1, left_ = 0, top_ = 0, height_ = 0, lift_ = 0, wide_ = 0;
};

/// What a place is called: a point, a node and its component.
std::string place_name(const Json& place) {
  if (place.contains("point")) return place["point"];
  if (place.contains("node"))
    return place.value("node", "") + " " +
           (place.contains("component") ? place.value("component", "") : "along a line");
  return "dofs";
}

// A line at rest, a dot for each point, its stops above and below, its force.
StructureSketch point_sketch(const SceneValues& scene, const Json& layout, double width) {
  std::vector<std::string> points = layout.at("points").get<std::vector<std::string>>();
  const auto number = [&](const std::string& name) {
    const auto found = std::find(points.begin(), points.end(), name);
    if (found != points.end()) return static_cast<std::size_t>(found - points.begin());
    points.push_back(name);
    return points.size() - 1;
  };
  const std::vector<Json> stops = list_at(scene, "/scene/stops"), loads = list_at(scene, "/scene/load");
  std::vector<std::size_t> stop_at, load_at;
  for (const Json& stop : stops) stop_at.push_back(number(place_name(stop.at("at"))));
  for (const Json& load : loads)
    if (load.contains("at") && load["at"].is_object()) load_at.push_back(number(place_name(load["at"])));
  if (points.empty()) return {};
  constexpr double rest = 84, height = 168;
  const auto px = [&](std::size_t k) {
    return sketch_margin +
           (width - 2 * sketch_margin) * (static_cast<double>(k) + 0.5) / static_cast<double>(points.size());
  };
  std::string out = line(sketch_margin, rest, width - sketch_margin, rest, "measure");
  for (std::size_t k = 0; k < points.size(); ++k) {
    out += fmt::format("<circle class=\"body\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"6\"/>", px(k), rest);
    if (points.size() <= most_sketch_labels) out += label(px(k), height - 4, points[k]);
  }
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const double x = px(stop_at[i]);
    std::string to;
    if (const auto found = stops[i].find("to"); found != stops[i].end() && found->is_object())
      to = " less " + place_name(*found);
    for (const auto& [side, key] : {std::pair(-1.0, "upper"), {1.0, "lower"}})
      if (const std::optional<double> value = bound(stops[i], key)) {
        out += face(x, rest + 18 * side, 0, side);
        if (stops.size() <= most_sketch_labels) out += label(x, rest + (side < 0 ? -32 : 44), sketched_metres(*value));
      }
    if (stops.size() <= most_sketch_labels) out += label(x, rest - 48, stops[i].value("name", "") + to);
  }
  for (const std::size_t k : load_at) out += arrow(px(k), rest - 42, px(k), rest - 9) + label(px(k), rest - 46, "F(t)");
  return {out, height};
}

}  // namespace

StructureSketch structure_sketch(const SceneValues& scene, double width) {
  const Json* layout = scene.at("/files/layout");
  if (!layout || !layout->is_object()) return {};
  if (layout->contains("points")) return point_sketch(scene, *layout, width);
  if (!layout->contains("nodes") || layout->at("x").empty()) return {};
  return NodeSketch(scene, *layout, width).draw(*layout, width);
}

}  // namespace ricochet::report
