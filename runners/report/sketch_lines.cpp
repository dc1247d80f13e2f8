#include "runners/report/sketch_lines.hpp"

#include <fmt/format.h>

#include <cmath>

#include "runners/report/html.hpp"

namespace ricochet::report {

std::string line(double x1, double y1, double x2, double y2, const char* classes) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", classes, x1, y1,
                     x2, y2);
}

std::string label(double x, double y, const std::string& text, const char* anchor) {
  return text.empty()
             ? ""
             : fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor, escape(text));
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

std::string wall(double x, double from, double to, double side) {
  std::string hatch;
  for (double y = from; y < to; y += 8) hatch += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x, y, x + side * 8, y + 8);
  return line(x, from, x, to, "solid") + path(hatch, "hatch");
}

}  // namespace ricochet::report
