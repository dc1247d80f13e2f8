#include "runners/report/sketch_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"

namespace ricochet::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_sketch_labels = 12;
// Along z, of a beam in two planes, as it is seen from the side and above.
constexpr std::array<double, 2> oblique = {-0.62, 0.46};
// What moves along its axis has a pin, which its stops meet above it.
constexpr double pin_height = -68, body_height = -46;

std::vector<double> numbers_at(const Json& object, const char* key) {
  std::vector<double> out;
  const auto found = object.find(key);
  if (found != object.end() && found->is_array())
    for (const Json& one : *found)
      if (one.is_number()) out.push_back(one.get<double>());
  return out;
}

std::string measured(double from, double to, double y) {
  return line(from, y, to, y, "measure") + line(from, y - 5, from, y + 5, "measure") +
         line(to, y - 5, to, y + 5, "measure");
}

std::string name_and_length(const PieceFrame& frame, double length) {
  const bool longer = frame.span > 1.01 * frame.scale * length;
  if (frame.name.empty()) return "";
  return length > 0 ? frame.name + ", " + metres(length) + (longer ? " (drawn longer)" : "") : frame.name;
}

Spot beam_spot(const Json& place, double x, double y) {
  const std::vector<double> direction = numbers_at(place, "direction");
  double along_y = 1, along_z = 0;
  if (direction.size() == 2) {
    const double size = std::hypot(direction[0], direction[1]);
    if (size > 0) along_y = direction[0] / size, along_z = direction[1] / size;
  } else if (place.value("component", "") == "uz") {
    along_y = 0, along_z = 1;
  }
  Spot out{x, y, along_z * oblique[0], along_z * oblique[1] - along_y};
  out.ring = {0, -1, oblique[0], oblique[1]};
  return out;
}

Piece beam(const SceneValues& scene, const PieceFrame& frame, Labels& label) {
  const double length = scene.number("/scene/structure/length").value_or(1), right = frame.left + frame.span,
               y = frame.rest;
  const HeldBeam held = held_beam(scene, length, {frame.left, frame.span, y, frame.measure}, label);
  std::string out = (held.given ? held.svg : wall(frame.left, y - 30, y + 30, -1)) +
                    line(frame.left, y, right, y, "structure") + held.masses;
  if (!frame.shaken.empty())
    out += arrow(frame.left - 24, y - 24, frame.left - 24, y + 24, true) +
           label(frame.left - 24, y + 48, frame.shaken, "middle", 1);
  if (frame.loaded) {
    for (int k = 1; k <= 6; ++k)
      out += arrow(frame.left + frame.span * k / 7.0, y - 30, frame.left + frame.span * k / 7.0, y - 8);
    out += label(frame.left + frame.span / 14.0 - 6, y - 34, "f(x, t)");
  }
  if (scene.number("/scene/structure/planes").value_or(1) > 1) {
    const double x = std::max(32.0, frame.left - 44), low = y + 62;
    out += arrow(x, low, x, low - 26) + label(x + 6, low - 22, "y", "start") +
           arrow(x, low, x + 30 * oblique[0], low + 30 * oblique[1]) +
           label(x + 30 * oblique[0] + 8, low + 30 * oblique[1] + 8, "z", "start");
  }
  if (frame.measure > 0)
    out += measured(frame.left, right, frame.measure) +
           (held.measured ? held.spans
                          : label((frame.left + right) / 2, frame.measure - 4,
                                  "L = " + scene.text("/scene/structure/length", "m")));
  const bool pulled = scene.number("/scene/structure/tension").value_or(0) != 0;
  out += label(right + (pulled ? 60 : 12), y + 4, name_and_length(frame, length), "start", 1);
  return {out, [=](const Json& place) -> std::optional<Spot> {
            const auto x = number_at(place, "x");
            if (!x) return std::nullopt;
            return beam_spot(place, frame.left + frame.span * std::clamp(*x / length, 0.0, 1.0), y);
          }};
}

// Of what moves along its axis: a along it from its wall, c across it, as pixels.
class Axis {
 public:
  explicit Axis(const PieceFrame& frame) : frame_(frame), upright_(frame.axis[1] != 0) {}

  bool upright() const { return upright_; }
  Spot spot(double a, double c) const {
    const double sign = frame_.forward ? 1 : -1;
    const auto& [ux, uy] = frame_.axis;
    return {frame_.left + a * ux + (upright_ ? c : 0), frame_.rest + a * uy + (upright_ ? 0 : c), sign * ux, sign * uy};
  }
  std::string strokes(const std::string& svg) const {
    return fmt::format("<g transform=\"matrix({} {} {} {} {:.1f} {:.1f})\">{}</g>", frame_.axis[0], frame_.axis[1],
                       upright_ ? 1 : 0, upright_ ? 0 : 1, frame_.left, frame_.rest, svg);
  }
  std::string text(double a, double c, const std::string& words, Labels& label, const char* anchor = "middle") const {
    const Spot at = spot(a, c);
    return label(at.x, at.y, words, anchor);
  }

 private:
  const PieceFrame& frame_;
  bool upright_;
};

std::string box(double a, double c, double wide, double high) {
  return fmt::format("<rect class=\"body\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>", a, c, wide,
                     high);
}

std::string pin(double a) {
  return line(a, pin_height - 10, a, pin_height + 22, "structure");
}

Piece oscillator(const SceneValues& scene, const PieceFrame& frame, bool met, Labels& label) {
  const Axis axis(frame);
  const double half = frame.alone ? 35 : 20, high = 44, low = axis.upright() ? high / 2 : 0,
               mass = frame.alone ? 254 : frame.span - half, coil = (mass - half - 20) / 8;
  std::string spring = fmt::format("M0 {:.1f}h20", low - high / 2), out;
  for (int k = 0; k < 4; ++k) spring += fmt::format("l{0:.2f} -9l{0:.2f} 9l{0:.2f} 9l{0:.2f} -9", coil / 2);
  const bool held = !scene.text("/scene/structure/stiffness", "").empty();
  if (held || frame.alone) out += wall(0, low - high, low, -1);
  if (!axis.upright()) out += line(0, low, frame.span, low, "hatch");
  if (held) out += path(spring, "spring");
  out = axis.strokes(out + box(mass - half, low - high, 2 * half, high) + (met && !axis.upright() ? pin(mass) : ""));
  out += axis.text(mass, low - 17, frame.alone ? "m" : "", label);
  if (frame.alone && held) out += axis.text(110, -36, "k", label);
  if (!scene.text("/scene/structure/force/amplitude", "").empty()) {
    const Spot from = axis.spot(mass + half + 2, low - 22), to = axis.spot(mass + half + 57, low - 22);
    out += arrow(from.x, from.y, to.x, to.y) + label(to.x + 6, to.y + 4, "F cos(ωt + ψ)", "start");
  }
  if (!frame.shaken.empty()) {
    const Spot from = axis.spot(-56, -22), to = axis.spot(-12, -22);
    out += arrow(from.x, from.y, to.x, to.y, true) + label((from.x + to.x) / 2, from.y - 12, frame.shaken);
  }
  Spot place = axis.upright() ? axis.spot(mass + half, 0) : axis.spot(mass, pin_height);
  if (axis.upright()) (frame.forward ? place.back : place.front) = 2 * half;
  if (axis.upright())
    out += axis.text(mass, half + 14, frame.name, label, "start");
  else
    out += axis.text(frame.span / 2, 18, frame.name, label);
  return {out, [=](const Json&) { return std::optional(place); }};
}

Piece bar(const SceneValues& scene, const PieceFrame& frame, const std::vector<Json>& used, Labels& label) {
  const Axis axis(frame);
  const std::string fixed = scene.word("/scene/structure/fixed");
  const double length = scene.number("/scene/structure/length").value_or(1), top = axis.upright() ? -9 : body_height;
  const double middle = top + 9;
  std::string strokes = box(0, top, frame.span, 18), out;
  if (fixed == "left" || fixed == "right")
    strokes += fixed == "right" ? wall(frame.span, middle - 27, middle + 27, 1) : wall(0, middle - 27, middle + 27, -1);
  const auto along = [=](const Json& place) { return frame.span * number_at(place, "x").value_or(0) / length; };
  for (const Json& place : used)
    if (!axis.upright()) strokes += pin(along(place));
  out = axis.strokes(strokes);
  if (frame.loaded) {
    const Spot from = axis.spot(frame.span / 2 - 25, top - 8), to = axis.spot(frame.span / 2 + 25, top - 8);
    out += arrow(from.x, from.y, to.x, to.y) + label((from.x + to.x) / 2, (from.y + to.y) / 2 - 8, "f(x, t)");
  }
  if (frame.alone)
    out += axis.text(frame.span / 2, -6, "L = " + scene.text("/scene/structure/length", "m"), label);
  else if (axis.upright())
    out += axis.text(frame.span / 2, 16, frame.name + ", " + metres(length), label, "start");
  else
    out += axis.text(frame.span / 2, -8, frame.name + ", " + metres(length), label);
  return {out, [=](const Json& place) {
            return std::optional(Axis(frame).spot(along(place), axis.upright() ? 0 : pin_height));
          }};
}

// Of matrices with places: nodes and what the stiffness joins.
Piece nodes(const Json& layout, const PieceFrame& frame, const PieceSize& size, Labels& label) {
  const std::vector<double> x = numbers_at(layout, "x"), y = numbers_at(layout, "y");
  const double middle = *std::min_element(y.begin(), y.end()) + size.tall / 2;
  const auto at = [=](const Json& node) {
    const auto n = node.get<std::size_t>();
    return Spot{frame.left + frame.scale * (x.at(n) - size.first), frame.rest - frame.scale * (y.at(n) - middle)};
  };
  std::string d, out;
  for (const Json& link : layout.at("links")) {
    const Spot from = at(link[0]), to = at(link[1]);
    d += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", from.x, from.y, to.x, to.y);
  }
  out = path(d, "structure mesh");
  for (const Json& node : layout.at("held")) {
    const Spot one = at(node);
    out +=
        fmt::format("<rect class=\"solid\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\"/>", one.x - 4, one.y - 4);
  }
  if (frame.measure > 0) {
    const double low = frame.measure;
    out += arrow(14, low, 44, low) + label(50, low + 4, layout["axes"][0], "start") + arrow(14, low, 14, low - 30) +
           label(14, low - 36, layout["axes"][1]);
    if (size.length > 0)
      out += measured(frame.left, frame.left + frame.span, low) +
             label(frame.left + frame.span / 2, low - 4, metres(size.length));
  }
  out += label(frame.left + frame.span + 12, frame.rest + 4, name_and_length(frame, size.length), "start", 1);
  return {out, [=](const Json& place) -> std::optional<Spot> {
            const Json found = place.value("at", Json(-1)), direction = place.value("direction", Json());
            if (!found.is_number_integer() || found.get<int>() < 0) return std::nullopt;
            Spot spot = at(found);
            spot.dx = direction[0].get<double>();
            spot.dy = -direction[1].get<double>();
            spot.ring = {1, 0, 0, -1};
            return spot;
          }};
}

/// What a place without an x is called: a point, a node and its component.
std::string place_name(const Json& place) {
  if (place.contains("point")) return place["point"];
  if (!place.contains("node")) return "dofs";
  return place.value("node", "") + (place.contains("component")   ? " " + place.value("component", "")
                                    : place.contains("direction") ? " along a line"
                                                                  : "");
}

// Of modes, or of matrices without places: a dot for each point.
Piece points(const Json& layout, const PieceFrame& frame, const std::vector<Json>& used, Labels& label) {
  std::vector<std::string> names = layout.at("points").get<std::vector<std::string>>();
  for (const Json& place : used)
    if (const std::string name = place_name(place); std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  const auto px = [=, count = static_cast<double>(names.size())](std::size_t k) {
    return frame.left + frame.span * (static_cast<double>(k) + 0.5) / count;
  };
  std::string out = line(frame.left, frame.rest, frame.left + frame.span, frame.rest, "measure");
  for (std::size_t k = 0; k < names.size(); ++k) {
    out += circle(px(k), frame.rest, 6, "body");
    if (names.size() <= most_sketch_labels)
      out += label(px(k), frame.rest + (frame.alone ? 80 : 62), names[k], "middle", 1);
  }
  out += label(frame.left + frame.span + 12, frame.rest + 4, frame.name, "start", 1);
  return {names.empty() ? "" : out, [=](const Json& place) -> std::optional<Spot> {
            const auto found = std::find(names.begin(), names.end(), place_name(place));
            if (found == names.end()) return std::nullopt;
            return Spot{px(static_cast<std::size_t>(found - names.begin())), frame.rest};
          }};
}

bool has_nodes(const Json* layout) {
  return layout && layout->contains("nodes") && !numbers_at(*layout, "x").empty();
}

}  // namespace

std::string metres(double gap) {
  return number_text(gap, 4) + " m";
}

PieceSize piece_size(const SceneValues& scene, const Json* layout) {
  const std::string type = scene.word("/scene/structure/type");
  PieceSize out;
  out.along = type == "oscillator" || type == "bar";
  if (type == "beam") out.length = scene.number("/scene/structure/length").value_or(1);
  if (!has_nodes(layout)) return out;
  const std::vector<double> x = numbers_at(*layout, "x"), y = numbers_at(*layout, "y");
  const auto [left, right] = std::minmax_element(x.begin(), x.end());
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  return {*left, *right - *left, *high - *low, false};
}

std::optional<Piece> draw_piece(const SceneValues& scene, const Json* layout, const PieceFrame& frame,
                                const std::vector<Json>& used, Labels& label) {
  const std::string type = scene.word("/scene/structure/type");
  if (type == "beam") return beam(scene, frame, label);
  if (type == "oscillator") return oscillator(scene, frame, !used.empty(), label);
  if (type == "bar") return bar(scene, frame, used, label);
  if (has_nodes(layout)) return nodes(*layout, frame, piece_size(scene, layout), label);
  if (layout && layout->contains("points")) return points(*layout, frame, used, label);
  return std::nullopt;
}

std::string line(double x1, double y1, double x2, double y2, const char* classes) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", classes, x1, y1,
                     x2, y2);
}

std::string path(const std::string& d, const char* classes) {
  return fmt::format("<path class=\"{}\" d=\"{}\"/>", classes, d);
}

std::string arrow(double x1, double y1, double x2, double y2, bool both) {
  const double length = std::hypot(x2 - x1, y2 - y1), ux = (x2 - x1) / length, uy = (y2 - y1) / length;
  const auto head = [&](double x, double y, double sign) {
    const double bx = x - sign * 7 * ux, by = y - sign * 7 * uy;
    return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} {:.1f}", x, y, bx - 3.5 * uy, by + 3.5 * ux,
                       x, y, bx + 3.5 * uy, by - 3.5 * ux);
  };
  return line(x1, y1, x2, y2, "acts") + path(head(x2, y2, 1) + (both ? head(x1, y1, -1) : ""), "acts");
}

std::string circle(double x, double y, double radius, const char* classes) {
  return fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.3g}\"/>", classes, x, y, radius);
}

std::string face(double x, double y, double dx, double dy) {
  std::string hatch;
  for (double u = -9; u <= 9; u += 6)
    hatch += fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}", x - u * dy, y + u * dx, 6 * dx - 3 * dy, 6 * dy + 3 * dx);
  return line(x + 11 * dy, y - 11 * dx, x - 11 * dy, y + 11 * dx, "stop") + path(hatch, "stop");
}

std::string Labels::operator()(double x, double y, const std::string& text, const char* anchor, double away) {
  if (text.empty()) return "";
  constexpr double most = 8;
  const double letter = 6.7 * scale_, space = 3 * scale_, height = 13 * scale_;
  const auto letters = std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; });
  const double wide = letter * static_cast<double>(letters);
  double left = x - (*anchor == 'm' ? wide / 2 : *anchor == 'e' ? wide : 0);
  const double inside = std::max(0.0, std::min(left, width_ - wide));
  x += inside - left;
  left = inside;
  const auto covers = [&](const Box& one) {
    return left - space < one.right && one.left < left + wide + space && std::abs(y - one.low) < height;
  };
  for (double tried = 0; tried < most && std::any_of(boxes_.begin(), boxes_.end(), covers); ++tried) y += away * height;
  boxes_.push_back({left, left + wide, y});
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor, escape(text));
}

std::array<double, 2> Labels::reach(double from, double to) const {
  const double above = 12 * scale_, below = 6 * scale_;
  for (const Box& one : boxes_) {
    from = std::min(from, one.low - above);
    to = std::max(to, one.low + below);
  }
  return {from, to};
}

std::string wall(double x, double from, double to, double side) {
  std::string hatch;
  for (double y = from; y < to; y += 8) hatch += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x, y, x + side * 8, y + 8);
  return line(x, from, x, to, "solid") + path(hatch, "hatch");
}

}  // namespace ricochet::report
