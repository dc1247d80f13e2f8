#include <cmath>
#include <ricochet/engine/march_model.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/measure/orbits/massless_roots.hpp>
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {

std::vector<std::complex<double>> massless_roots(const Program& program, const SetSteps& sets) {
  constexpr double on_circle = 1e-7, no_mass = 1e-6;
  const Inertia& inertia = program.problem->inertia;
  std::vector<std::complex<double>> roots;
  if (inertia.kernel_dimension == 0) return roots;
  const GeneralModes modes = general_modes(sets[0].state.topRows(sets.state_size()));
  if (!modes.found) return roots;
  const MarchModel& model = *program.model;
  const double largest = dense_mass(inertia).norm();
  for (Eigen::Index i = 0; i < modes.values.size(); ++i) {
    if (std::abs(std::abs(modes.values[i]) - 1) > on_circle) continue;
    bool massless = true;
    for (int first = 0; first < sets.slots_size(); first += model.rows()) {
      const Eigen::VectorXcd slot = modes.vectors.col(i).segment(first, model.rows());
      for (const Eigen::VectorXd& part : {Eigen::VectorXd(slot.real()), Eigen::VectorXd(slot.imag())}) {
        const Eigen::VectorXd nodal = model.to_nodal(part);
        massless = massless && apply_mass(inertia, nodal).norm() <= no_mass * largest * nodal.norm();
      }
    }
    if (massless) roots.push_back(modes.values[i]);
  }
  return roots;
}

std::vector<std::complex<double>> after_steps(std::vector<std::complex<double>> roots, long long steps, double sign) {
  for (std::complex<double>& root : roots) root = sign * std::polar(1.0, std::arg(root) * static_cast<double>(steps));
  return roots;
}

}  // namespace ricochet
