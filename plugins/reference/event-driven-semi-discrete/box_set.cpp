#include "box_set.hpp"

#include <ricochet/contact_solvers/box_problem.hpp>
#include <utility>

#include "stopped.hpp"

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

}  // namespace ricochet::reference
