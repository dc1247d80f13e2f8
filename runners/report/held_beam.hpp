#pragma once
#include <string>
#include <utility>
#include <vector>

#include "runners/report/scene_values.hpp"
#include "runners/report/sketch_lines.hpp"

/// \file
/// What holds a beam that says it itself, drawn: clamps, pins, guides, springs, point masses, spans.
namespace ricochet::report {

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

/// Supports, sections and masses in words: name and text, for the table beside the drawing.
std::vector<std::pair<std::string, std::string>> held_beam_words(const SceneValues& scene);

}  // namespace ricochet::report
