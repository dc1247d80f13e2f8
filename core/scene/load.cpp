#include <algorithm>
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {

DistributedLoad::DistributedLoad(const Formula& load, const FiniteElementSpace& space)
    : load_(load), size_(space.dofs) {
  if (absent()) return;
  const auto& gauss = gauss_points();
  for (const auto& element : space.elements) {
    dofs_.push_back(element.dof);
    auto& weights = weights_.emplace_back();
    for (std::size_t g = 0; g < gauss.size(); ++g) {
      points_.push_back(element.left + gauss[g].xi * element.length);
      const auto phi = shape_values(space.basis, element.length, gauss[g].xi);
      for (std::size_t a = 0; a < 4; ++a) weights[4 * g + a] = gauss[g].weight * element.length * phi[a];
    }
  }
  if (space.elements.empty()) points_.push_back(0);
  values_.resize(points_.size());
}

void DistributedLoad::assemble(double t, double* out) const {
  std::fill(out, out + size_, 0.0);
  if (absent()) return;
  load_.evaluate(points_, t, values_);
  if (dofs_.empty()) out[0] = values_[0];
  for (std::size_t e = 0; e < dofs_.size(); ++e) {
    for (std::size_t a = 0; a < 4; ++a) {
      const int dof = dofs_[e][a];
      if (dof < 0) continue;
      for (std::size_t g = 0; g < 4; ++g) out[dof] += weights_[e][4 * g + a] * values_[4 * e + g];
    }
  }
}

}  // namespace ricochet
