#include "contact_points.hpp"

#include <fmt/format.h>

#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <utility>

namespace ricochet::reference {
namespace {

// Columns of a small dense W.
class DenseColumns final : public DelassusColumns {
 public:
  explicit DenseColumns(Eigen::MatrixXd W) : W_(std::move(W)) {}
  const double* column(int j) override { return W_.col(j).data(); }

 private:
  Eigen::MatrixXd W_;
};

}  // namespace

ContactSet box_set(const Eigen::MatrixXd& W, double compliance, const Eigen::VectorXd& y, const Eigen::VectorXd& lower,
                   const Eigen::VectorXd& upper) {
  DenseColumns columns(W);
  Eigen::VectorXd p = Eigen::VectorXd::Zero(y.size());
  BoxSolver solver;
  solver.prepare(static_cast<int>(y.size()));
  const auto outcome =
      solver.solve(columns, 1, compliance, y.data(), lower.data(), upper.data(), p.data(), static_cast<int>(y.size()));
  if (!outcome.converged) throw Stopped{"the complementarity problem of the contact points was not solved"};
  ContactSet set;
  for (const double effort : p) set.push_back(effort > 0 ? 1 : (effort < 0 ? -1 : 0));
  return set;
}

ContactPoints::ContactPoints(const LinearStructure& structure, const ContactModes& open) {
  const auto oscillators = static_cast<Eigen::Index>(open.oscillators.size());
  const Pencil modes = pencil(structure, structure.stiffness, Eigen::MatrixXd(0, structure.dofs()));
  reach = structure.contact * modes.massless;
  moving = structure.contact * open.shapes.leftCols(oscillators);
  kernel = modes.massless.cols();

  const Eigen::Index m = structure.points();
  const bool rigid = structure.spring == 0;
  if (m == 0) return;
  const auto S = structure.scale.asDiagonal();
  const Eigen::MatrixXd K = S * (structure.stiffness + structure.shift * structure.mass) * S,
                        across = (structure.contact * S).transpose();
  const Eigen::MatrixXd soft = across.transpose() * definite_solve(K, across);
  const Eigen::VectorXd unit = soft.diagonal().cwiseSqrt().cwiseInverse();
  const auto smallest = [&](const Eigen::MatrixXd& W) {
    return symmetric_modes(unit.asDiagonal() * W * unit.asDiagonal(), EigenVectors::none).values[0];
  };
  if (rigid && smallest(soft) < 1e-12)
    throw Stopped{"two contact points coincide, and rigid stops share their force in no unique way: keep one"};
  massless = smallest(reach * reach.transpose()) > 1e-9 * smallest(soft);
  if (!rigid || massless) return;
  if (m > 1)
    throw Stopped{
        fmt::format("{} contact points with inertia and rigid stops: simultaneous impacts have no unique law; use a "
                    "singular mass whose kernel carries the contact, a compliant law, or stops at the tip alone",
                    m)};
  if (reach.squaredNorm() > 1e-9 * soft(0, 0))
    throw Stopped{"the contact point has no inertia of its own but the massless part does not carry it alone"};
}

}  // namespace ricochet::reference
