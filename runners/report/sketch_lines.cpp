#include "runners/report/sketch_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"

namespace ricochet::report {

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
  constexpr double letter = 6.7, space = 3, height = 13, most = 8;
  const auto letters = std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; });
  const double wide = letter * static_cast<double>(letters);
  const double left = x - (*anchor == 'm' ? wide / 2 : *anchor == 'e' ? wide : 0);
  const auto covers = [&](const Box& one) {
    return left - space < one.right && one.left < left + wide + space && std::abs(y - one.low) < height;
  };
  for (double tried = 0; tried < most && std::any_of(boxes_.begin(), boxes_.end(), covers); ++tried) y += away * height;
  boxes_.push_back({left, left + wide, y});
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor, escape(text));
}

std::array<double, 2> Labels::reach(double from, double to) const {
  constexpr double above = 12, below = 6;
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
