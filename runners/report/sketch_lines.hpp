#pragma once
#include <string>

/// \file
/// The strokes that sketches of scenes are made of, as SVG; places in pixels.
namespace ricochet::report {

std::string line(double x1, double y1, double x2, double y2, const char* classes);
std::string label(double x, double y, const std::string& text, const char* anchor = "middle");
std::string path(const std::string& d, const char* classes);
/// An arrow along x or y, its head at the second end; `both`: one at each.
std::string arrow(double x1, double y1, double x2, double y2, bool both = false);
/// A wall whose face stands at x; hatched to its left (or right).
std::string wall(double x, double from, double to, double side);

}  // namespace ricochet::report
