#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runners/report/scene_values.hpp"
#include "runners/report/sketch_lines.hpp"

/// \file
/// A structure as a sketch draws it: its strokes, and where its places lie. One piece for each body of a scene.
namespace ricochet::report {

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
