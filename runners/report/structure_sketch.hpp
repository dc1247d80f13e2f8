#pragma once
#include <string>

#include "runners/report/scene_values.hpp"

/// \file
/// Sketches of structures that files describe: nodes and what joins them, or points alone; their stops and loads.
namespace ricochet::report {

/// The strokes and how high they are, in pixels.
struct StructureSketch {
  std::string svg;
  double height = 0;
};

/// `width`: of the drawing, pixels. Empty where the study keeps no layout of its structure.
StructureSketch structure_sketch(const SceneValues& scene, double width);

}  // namespace ricochet::report
