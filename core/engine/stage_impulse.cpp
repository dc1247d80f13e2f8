#include <algorithm>
#include <ricochet/engine/stage_impulse.hpp>

namespace ricochet {

StageImpulse::StageImpulse(const ImpulseProgram& program, StageOperator& op, const MarchModel& model)
    : program_(program), op_(op), model_(model), rows_(model.rows()), points_(model.measured().rows()) {
  const auto points = static_cast<std::size_t>(points_), rows = static_cast<std::size_t>(rows_);
  known_.assign(points, false);
  columns_ = std::make_unique_for_overwrite<double[]>(points * points);
  unknowns_ = std::make_unique_for_overwrite<double[]>(points * rows);
  jumps_ = std::make_unique_for_overwrite<double[]>(points * rows);
  push_.assign(rows, 0.0);
  rhs_.assign(rows, 0.0);
}

int StageImpulse::computed() const {
  return static_cast<int>(std::count(known_.begin(), known_.end(), true));
}

void StageImpulse::compute(int j) {
  known_[static_cast<std::size_t>(j)] = true;
  const RowMatrix& H = model_.measured();
  std::fill(push_.begin(), push_.end(), 0.0);
  for (auto e = static_cast<std::size_t>(H.start[static_cast<std::size_t>(j)]);
       e < static_cast<std::size_t>(H.start[static_cast<std::size_t>(j) + 1]); ++e)
    push_[static_cast<std::size_t>(H.index[e])] = H.value[e];
  double *z = at(unknowns_, j, rows_), *w = at(jumps_, j, rows_);
  const auto rows = static_cast<std::size_t>(rows_);
  for (std::size_t i = 0; i < rows; ++i) rhs_[i] = program_.weight * push_[i];
  program_.op->solve_column(rhs_.data(), w);
  for (std::size_t i = 0; i < rows; ++i) rhs_[i] = program_.direct * push_[i];
  if (program_.elastic != 0) {
    const SparseMatrix& K = model_.stiffness();
    for (int column = 0; column < K.outerSize(); ++column)
      for (SparseMatrix::InnerIterator it(K, column); it; ++it)
        rhs_[static_cast<std::size_t>(it.row())] += program_.elastic * it.value() * w[column];
  }
  op_.solve_column(rhs_.data(), z);
  double* out = at(columns_, j, points_);
  for (int i = 0; i < points_; ++i) out[i] = program_.measure_z * H.times(i, z) + program_.measure_w * H.times(i, w);
}

}  // namespace ricochet
