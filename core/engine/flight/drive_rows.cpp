#include <ricochet/engine/flight/drive_rows.hpp>

namespace ricochet {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

MatrixXd dense(const RowMatrix& rows, int columns) {
  MatrixXd matrix = MatrixXd::Zero(rows.rows(), columns);
  for (int i = 0; i < rows.rows(); ++i)
    for (int k = rows.start[static_cast<std::size_t>(i)]; k < rows.start[static_cast<std::size_t>(i) + 1]; ++k)
      matrix(i, rows.index[static_cast<std::size_t>(k)]) += rows.value[static_cast<std::size_t>(k)];
  return matrix;
}

RowVectorXd harmonic(const PhaseWeights& phase, const FlightDrive& drive, double factor) {
  RowVectorXd row = RowVectorXd::Zero(drive.count());
  if (!drive.harmonic) return row;
  row[0] = factor * phase.along;
  row[1] = factor * phase.across;
  return row;
}

MatrixXd load_over_drive(const Program& program, const Levels& levels, const FlightDrive& drive) {
  const int rows = program.model->rows();
  MatrixXd load = MatrixXd::Zero(rows, drive.count());
  const double omega = program.problem->support.pulsation;
  if (drive.harmonic)
    load += program.model->support_shape() * harmonic(PhaseWeights(levels, omega, program.h), drive, omega * omega);
  if (program.load) {
    double weight = 0;
    for (const Level& level : levels) weight += level.weight;
    VectorXd nodal(rows), own(rows);
    program.problem->load->assemble(0, nodal.data());
    program.model->load_to_model(nodal.data(), own.data());
    load.col(drive.one()) += weight * own;
  }
  return load;
}

}  // namespace ricochet
