#include "runners/study/bases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "runners/json/json_text.hpp"
#include "runners/study/body_keys.hpp"

namespace ricochet {
std::vector<std::optional<BasisSpec>> bases_of(const Json& mesh, const Json& scene, bool modal) {
  if (!mesh.contains("modes") && !mesh.contains("residual")) return {std::nullopt};
  if (!mesh.contains("modes") && !modal)
    throw InputError("/mesh/residual", "there is no mesh.modes whose residual it could be; expected modes too");
  std::vector<std::optional<BasisSpec>> bases;
  const Json counts = mesh.value("modes", Json(nullptr));
  for (const Json& modes : counts.is_array() ? counts : Json::array({counts}))
    for (const std::string& residual : one_or_each<std::string>(mesh.value("residual", Json("stops"))))
      if (modes.is_object()) {
        const std::vector<int> each = of_bodies(modes, scene, "/mesh/modes");
        if (std::find(each.begin(), each.end(), 0) != each.end())
          throw InputError("/mesh/modes", "says no number for one of the bodies; expected one for each");
        bases.push_back(BasisSpec{std::accumulate(each.begin(), each.end(), 0), residual == "stops", each});
      } else if (!modes.is_null())
        bases.push_back(BasisSpec{modes.get<int>(), residual == "stops"});
      else if (modal && residual != "stops")
        bases.push_back(BasisSpec{0, false});
      else if (std::find(bases.begin(), bases.end(), std::nullopt) == bases.end())
        bases.emplace_back();
  return bases;
}

void check_bases(const std::vector<std::optional<BasisSpec>>& bases, const Json& mesh, const StructureSpec& structure,
                 int coarsest) {
  const bool any = std::any_of(bases.begin(), bases.end(), [](const auto& basis) { return basis.has_value(); });
  const int dofs = any ? make_space(structure, coarsest).dofs : 0;
  if (any && bodies_of(structure)) return;  // told by the body that has fewer
  for (const std::optional<BasisSpec>& basis : bases) {
    if (!basis || basis->modes <= dofs) continue;
    const Json& counts = mesh.at("modes");
    std::string pointer = "/mesh/modes";
    for (std::size_t i = 0; counts.is_array() && i < counts.size(); ++i)
      if (counts[i] == basis->modes) pointer = pointer_to("/mesh/modes", i);
    throw InputError(
        pointer,
        fmt::format("{} modes; the structure has {} degrees of freedom{}", basis->modes, dofs,
                    std::holds_alternative<AssembledSpec>(structure) ? "" : fmt::format(" on {} elements", coarsest)));
  }
}

void check_size(const StructureSpec& structure) {
  constexpr int most_dofs = 20000;
  const auto* spec = std::get_if<AssembledSpec>(&structure);
  if (!spec || spec->structure->dofs() <= most_dofs) return;
  const int n = spec->structure->dofs();
  SemiDiscrete problem;
  const JoinedBodies* bodies = bodies_of(structure);
  problem.space = make_space(structure, bodies ? bodies->mesh : 1);
  problem.stiffness = spec->structure->stiffness;
  problem.inertia.mass = spec->structure->mass;
  problem.position = Eigen::VectorXd::Zero(n);
  problem.contact.resize(0, n);
  const double seconds = std::min(predict_cost(OperatorKind::band, problem, {}, 1).step_seconds,
                                  predict_cost(OperatorKind::sparse, problem, {}, 1).step_seconds);
  throw InputError("/scene/structure", fmt::format("{} dofs without mesh.modes: a march takes {:.2g} s per step; "
                                                   "expected at most {}, or mesh.modes",
                                                   n, seconds, most_dofs));
}

}  // namespace ricochet
