#include "runners/study/case_axes.hpp"

#include <algorithm>
#include <ricochet/scene/bodies.hpp>

#include "runners/study/read_scene.hpp"

namespace ricochet {

namespace {

using About = CaseAxis::About;

}  // namespace

CaseAxis method_axis(const std::vector<MethodOption>& options, MethodChoice StudyCase::*member, std::string pointer) {
  CaseAxis axis{About::methods, {}, {}, [&options, member](StudyCase& one, std::size_t level) {
                  one.*member = options[level].choice;
                  one.starts_beyond = one.starts_beyond || options[level].starts_beyond;
                }};
  axis.pointer = std::move(pointer);
  for (const MethodOption& option : options) {
    axis.levels.push_back(option.axes);
    for (const auto& [name, ignored] : option.axes)
      if (std::find(axis.columns.begin(), axis.columns.end(), name) == axis.columns.end()) axis.columns.push_back(name);
  }
  return axis;
}

CaseAxis mesh_axis(const std::vector<MeshChoice>& meshes, StudyFiles& files) {
  CaseAxis axis{About::mesh, {"elements"}, {}, [&meshes, &files](StudyCase& one, std::size_t level) {
                  one.elements = meshes[level].elements;
                  if (const Json& mesh = meshes[level].of_bodies; mesh.is_object())
                    one.scene = read_scene(one.scene_json = with_meshes(one.scene_json, mesh), &files);
                  one.scene = on_mesh(std::move(one.scene), one.elements);
                }};
  axis.pointer = "/mesh";
  for (const MeshChoice& mesh : meshes) axis.levels.push_back({{"elements", mesh.elements}});
  return axis;
}

CaseAxis basis_axis(const std::vector<std::optional<BasisSpec>>& bases, const Json& mesh, bool modal) {
  const auto residual = [modal](const std::optional<BasisSpec>& basis) {
    return !basis && !modal ? Json(nullptr) : Json(!basis || basis->residual ? "stops" : "none");
  };
  CaseAxis axis{About::mesh, {}, {}, [&bases, residual](StudyCase& one, std::size_t level) {
                  const std::optional<BasisSpec>& basis = bases[level];
                  if (!basis) return;
                  one.scene.basis = basis;
                  one.scene_json["basis"] = {{"modes", basis->modes}, {"residual", residual(basis)}};
                  if (!basis->of_bodies.empty()) one.scene_json["basis"]["of_bodies"] = basis->of_bodies;
                }};
  axis.pointer = "/mesh";
  const bool modes = mesh.contains("modes"), residuals = mesh.contains("residual");
  if (modes) axis.columns.emplace_back("modes");
  if (residuals) axis.columns.emplace_back(residual_axis);
  for (const std::optional<BasisSpec>& basis : bases) {
    AxisValues& level = axis.levels.emplace_back();
    if (bases.size() == 1 && !basis) continue;  // all dofs, as every study that does not speak of modes
    if (modes) level.emplace_back("modes", basis && basis->modes > 0 ? Json(basis->modes) : Json(nullptr));
    if (residuals) level.emplace_back(residual_axis, residual(basis));
  }
  return axis;
}

CaseAxis scene_axis(const std::vector<SceneOption>& scenes) {
  CaseAxis axis{About::scene, {}, {}, [&scenes](StudyCase& one, std::size_t level) {
                  one.scene = scenes[level].scene;
                  one.scene_json = scenes[level].json;
                }};
  axis.pointer = "/scene";
  for (const auto& [name, ignored] : scenes.front().axes) axis.columns.push_back(name);
  for (const SceneOption& scene : scenes) axis.levels.push_back(scene.axes);
  return axis;
}

void add_cases(const std::vector<CaseAxis>& axes, const StudyCase& common, const StudyKind& kind,
               const Registry& registry, Study& study) {
  std::vector<std::size_t> told;
  Product product;
  for (const CaseAxis& axis : axes) {
    told.push_back(told.size());
    product.add(axis.levels.size());
  }
  std::stable_sort(told.begin(), told.end(), [&](auto a, auto b) { return axes[a].about < axes[b].about; });
  for (const std::size_t a : told)
    study.columns.insert(study.columns.end(), axes[a].columns.begin(), axes[a].columns.end());
  CaseIds ids;
  for (; !product.ended(); product.next()) {
    StudyCase one = common;
    for (std::size_t a = 0; a < axes.size(); ++a) axes[a].put(one, product[a]);
    for (const std::size_t a : told) {
      const AxisValues& level = axes[a].levels[product[a]];
      one.axes.insert(one.axes.end(), level.begin(), level.end());
    }
    if (kind.complete) kind.complete(common.settings, registry, one);
    one.id = ids.next(one, study.kind);
    study.cases.push_back(std::move(one));
  }
}

}  // namespace ricochet
