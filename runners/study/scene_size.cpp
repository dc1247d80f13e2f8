#include "runners/study/scene_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

namespace ricochet {

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
