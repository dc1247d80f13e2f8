#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/study/body_keys.hpp"
#include "runners/study/product.hpp"
#include "runners/study/study_kind.hpp"

/// \file
/// The cases of a study as a product of axes. Each axis says its columns, the values of its levels, and what a level
/// puts into a case; a new one is one more entry of the list that load_study.cpp makes.
namespace ricochet {

/// Columns of a case with its values.
using AxisValues = std::vector<std::pair<std::string, Json>>;

/// One factor of the product.
struct CaseAxis {
  /// What its columns speak of. Columns stand in this order, whatever the order of the cases.
  enum class About { methods, mesh, time, scene };
  About about;
  std::vector<std::string> columns;  ///< none where the study does not speak of it
  std::vector<AxisValues> levels;    ///< the values of the columns, of a level that has some
  std::function<void(StudyCase& study_case, std::size_t level)> put;
  std::string pointer = {};  ///< where the study gives its levels
};

/// Values of one member of a case. `told`: whether the study speaks of it.
template <class Value>
CaseAxis plain_axis(const char* column, bool told, const std::vector<Value>& values, Value StudyCase::*member) {
  CaseAxis axis{CaseAxis::About::time, {}, {}, [values, member](StudyCase& one, std::size_t level) {
                  one.*member = values[level];
                }};
  axis.pointer = std::string("/") + column;
  if (told) axis.columns = {column};
  for (const Value& value : values) axis.levels.push_back(told ? AxisValues{{column, value}} : AxisValues());
  return axis;
}

// What these are given must outlive them.

/// Of one role, whose methods stand at `pointer`.
CaseAxis method_axis(const std::vector<MethodOption>& options, MethodChoice StudyCase::*member, std::string pointer);
/// Comes after the scene.
CaseAxis mesh_axis(const std::vector<MeshChoice>& meshes, StudyFiles& files);
/// Modes and residuals, which `mesh` may name. Comes after the mesh.
CaseAxis basis_axis(const std::vector<std::optional<BasisSpec>>& bases, const Json& mesh, bool modal);

/// One scene of the product of the scene's lists.
struct SceneOption {
  SceneSpec scene;
  Json json;
  AxisValues axes;
};
CaseAxis scene_axis(const std::vector<SceneOption>& scenes);

/// Adds every combination of the axes to a study, the last running fastest, each put into a copy of what all have in
/// common.
void add_cases(const std::vector<CaseAxis>& axes, const StudyCase& common, const StudyKind& kind,
               const Registry& registry, Study& study);

}  // namespace ricochet
