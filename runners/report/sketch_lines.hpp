#pragma once
#include <array>
#include <string>
#include <vector>

/// \file
/// The strokes that sketches of scenes are made of, as SVG; places in pixels.
namespace ricochet::report {

std::string line(double x1, double y1, double x2, double y2, const char* classes);
std::string path(const std::string& d, const char* classes);
/// An arrow along x or y, its head at the second end; `both`: one at each.
std::string arrow(double x1, double y1, double x2, double y2, bool both = false);
std::string circle(double x, double y, double radius, const char* classes);
/// A face across the direction (dx, dy), hatched on the side that nothing enters.
std::string face(double x, double y, double dx, double dy);
/// A wall whose face stands at x; hatched to its left (or right).
std::string wall(double x, double from, double to, double side);

/// The texts of a sketch: one that would cover another goes down (or up) until it does not.
class Labels {
 public:
  std::string operator()(double x, double y, const std::string& text, const char* anchor = "middle", double away = -1);
  /// From where to where they reach, with `from` and `to`, pixels.
  std::array<double, 2> reach(double from, double to) const;

 private:
  struct Box {
    double left, right, low;
  };
  std::vector<Box> boxes_;
};

}  // namespace ricochet::report
