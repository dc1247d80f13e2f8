#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/report/scene_sketch.hpp"

/// \file
/// A structure as a sketch draws it: its strokes, and where its places lie. One piece for each body of a scene.
namespace ricochet::report {

// The strokes that sketches of scenes are made of, as SVG; places in pixels.

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
  /// `size` of the letters, pixels; labels are moved to within a `width`.
  Labels(double size, double width) : scale_(size / 12), width_(width) {}
  std::string operator()(double x, double y, const std::string& text, const char* anchor = "middle", double away = -1);
  /// From where to where they reach, with `from` and `to`, pixels.
  std::array<double, 2> reach(double from, double to) const;

 private:
  struct Box {
    double left, right, low;
  };
  double scale_, width_;
  std::vector<Box> boxes_;
};

// What holds a beam that says it itself, drawn: clamps, pins, guides, springs, point masses, spans.

/// Where the beam lies in the drawing, in pixels; measure: the height of its spans, 0 for none.
struct BeamFrame {
  double left, span, rest, measure;
};

struct HeldBeam {
  bool given = false;     ///< whether the scene has supports of its own
  bool measured = false;  ///< whether `spans` says the lengths
  std::string svg, masses, spans;
};
HeldBeam held_beam(const SceneValues& scene, double length, const BeamFrame& frame, Labels& label);

/// A place of a drawing, pixels, and where its displacement points; `front` and `back`: how far what moves reaches that
/// way, and the other. A circle round it has the axes `ring`.
struct Spot {
  double x = 0, y = 0, dx = 0, dy = -1;
  double front = 0, back = 0;
  std::array<double, 4> ring = {0, -1, 1, 0};
};

/// Its own lengths, m; `tall` across its x.
struct PieceSize {
  double first = 0, length = 0, tall = 0;
  bool along = false;  ///< whether it moves along its axis
};

/// Where it is drawn, pixels: where its x begins, how long it is, the height of its line, pixels per metre.
struct PieceFrame {
  double left = 0, span = 0, rest = 0, scale = 1;
  double measure = 0;                   ///< the height of its length, 0 for none
  std::array<double, 2> axis = {1, 0};  ///< of what moves along its axis: where that points, from its wall
  bool forward = true;                  ///< whether its displacements point there too
  bool alone = true, loaded = false;    ///< the only structure of its scene; pushed along its length
  std::string name = {}, shaken = {};   ///< of a body; the motion of what holds it
};

struct Piece {
  std::string svg;
  std::function<std::optional<Spot>(const nlohmann::ordered_json& place)> spot;
};

/// `layout`: of its files, null for none. `used`: places of stops and loads, which points without a place are drawn
/// for.
PieceSize piece_size(const SceneValues& scene, const nlohmann::ordered_json* layout);
/// Nothing for a structure that cannot be drawn.
std::optional<Piece> draw_piece(const SceneValues& scene, const nlohmann::ordered_json* layout, const PieceFrame& frame,
                                const std::vector<nlohmann::ordered_json>& used, Labels& label);

/// The word for a gap: "0.0001 m".
std::string metres(double gap);

}  // namespace ricochet::report
