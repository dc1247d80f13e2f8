#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/structure/missing_residuals.hpp>
#include <utility>

namespace ricochet {
namespace {

/// A structure in modes, alone or as a body: where its dofs stand.
struct InModes {
  const AssembledStructure* structure = nullptr;
  int first = 0;

  bool has_mode(int dof) const { return dof >= first && dof < first + structure->modes->modes; }
  bool has_residual(int dof) const { return dof >= first + structure->modes->modes && dof < first + structure->dofs(); }
};

const AssembledStructure* in_modes(const StructureSpec& structure) {
  const auto* spec = std::get_if<AssembledSpec>(&structure);
  return spec && spec->structure->modes ? spec->structure.get() : nullptr;
}

std::vector<InModes> all_in_modes(const SceneSpec& scene) {
  std::vector<InModes> out;
  if (const AssembledStructure* alone = in_modes(scene.structure)) out.push_back({alone});
  if (const JoinedBodies* bodies = bodies_of(scene.structure))
    for (const JoinedBody& body : bodies->all)
      if (const AssembledStructure* one = in_modes(body.alone.structure)) out.push_back({one, body.first});
  return out;
}

/// Whether a row moves by modes of a structure and by no residual of it.
bool lacks(const PlaceRow& row, const InModes& one) {
  const auto any = [&](auto member) {
    return std::any_of(row.free.begin(), row.free.end(),
                       [&](const auto& entry) { return (one.*member)(entry.first) && entry.second != 0; });
  };
  return any(&InModes::has_mode) && !any(&InModes::has_residual);
}

bool lacks(const PlaceRow& row, const std::vector<InModes>& all) {
  return std::any_of(all.begin(), all.end(), [&](const InModes& one) { return lacks(row, one); });
}

/// The share of the fastest mode in the static displacement that a force at `load` gives to `stop`; 0 where that is 0.
double last_share(const PlaceRow& load, const PlaceRow& stop, const InModes& one) {
  double sum = 0, last = 0;
  for (const auto& [dof, weight] : stop.free)
    for (const auto& [other, value] : load.free) {
      if (dof != other || !one.has_mode(dof)) continue;
      const double stiffness = one.structure->stiffness.coeff(dof - one.first, dof - one.first);
      if (!(stiffness > 0)) continue;
      sum += weight * value / stiffness;
      if (dof == one.first + one.structure->modes->modes - 1) last = weight * value / stiffness;
    }
  return sum != 0 ? std::abs(last / sum) : 0;
}

/// A stop or a point that is shown, and its row.
struct NamedRow {
  std::string name;
  PlaceRow row;
};

std::vector<NamedRow> stop_rows(const SceneSpec& scene, const FiniteElementSpace& space) {
  std::vector<NamedRow> out;
  for (std::size_t i = 0; i < scene.stops.named.size(); ++i)
    out.push_back({scene.stops.named[i].name, stop_row(scene, space, scene.stops.named[i], i)});
  return out;
}

std::string load_note(std::size_t number, const PlaceRow& load, const std::vector<NamedRow>& stops,
                      const std::vector<InModes>& all) {
  std::string text = fmt::format(
      "load {} is at a point without residual: what it moves the stops by at rest, beyond the modes, is not known",
      number);
  double most = 0;
  std::string at;
  for (const NamedRow& stop : stops)
    for (const InModes& one : all)
      if (const double share = last_share(load, stop.row, one); share > most) {
        most = share;
        at = stop.name;
      }
  constexpr double percent = 100;
  if (most > 0)
    text += fmt::format(". The fastest mode alone gives {:.2g} % of its static displacement at stop {}", percent * most,
                        at);
  return text;
}

// Names of rows that lack a residual, each once.
std::vector<std::string> lacking(const std::vector<NamedRow>& rows, const std::vector<InModes>& all) {
  std::vector<std::string> out;
  for (const NamedRow& one : rows)
    if (lacks(one.row, all) && std::find(out.begin(), out.end(), one.name) == out.end()) out.push_back(one.name);
  return out;
}

}  // namespace

std::vector<std::string> missing_residuals(const SceneSpec& scene, const FiniteElementSpace& space) {
  const std::vector<InModes> all = all_in_modes(scene);
  std::vector<std::string> said;
  if (all.empty() || scene.stops.named.empty()) return said;
  const std::vector<NamedRow> stops = stop_rows(scene, space);
  for (std::size_t k = 0; k < scene.load.terms.size(); ++k) {
    const LoadTerm& term = scene.load.terms[k];
    if (!term.force || !term.place || term.history.is_zero()) continue;
    const PlaceRow row = place_row(scene, space, *term.place, fmt::format("/scene/load/{}/at", k));
    if (lacks(row, all)) said.push_back(load_note(k, row, stops, all));
  }
  if (const std::vector<std::string> names = lacking(stops, all); !names.empty())
    said.push_back(
        fmt::format("no residual at stop {}: its force moves no stop beyond the modes", fmt::join(names, ", ")));
  std::vector<NamedRow> points;
  for (std::size_t i = 0; i < scene.points.size(); ++i)
    points.push_back(
        {scene.points[i].name, place_row(scene, space, scene.points[i].at, fmt::format("/scene/points/{}/at", i))});
  if (const std::vector<std::string> names = lacking(points, all); !names.empty())
    said.push_back(
        fmt::format("no residual at point {}: what is shown there follows the modes alone", fmt::join(names, ", ")));
  const bool moves = !scene.motions.empty() || scene.support.amplitude != 0;
  if (moves && std::any_of(all.begin(), all.end(), [](const InModes& one) { return !one.structure->supports.empty(); }))
    said.emplace_back(
        "supports of a structure in modes move: what their inertia moves the stops by, beyond the modes, is not known");
  return said;
}

}  // namespace ricochet
