#include <algorithm>
#include <ricochet/engine/stage_delassus.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>

namespace ricochet {

void ActiveSystem::reserve(int most) {
  capacity = static_cast<std::size_t>(most);
  points.reserve(capacity);
  matrix.resize(capacity * capacity);
  right.resize(capacity);
  slopes.resize(capacity);
  round.resize(2 * capacity);
}

void ActiveSystem::factorise() {
  // A pivot this small against its diagonal belongs to a point that depends on those before it.
  constexpr double dependent = 1e-13;
  const std::size_t size = points.size();
  for (std::size_t i = 0; i < size; ++i) {
    const double diagonal = at(i, i);
    for (std::size_t j = 0; j < i; ++j) {
      double sum = at(i, j);
      for (std::size_t l = 0; l < j; ++l) sum -= at(i, l) * at(j, l) * at(l, l);
      at(i, j) = at(j, j) != 0 ? sum / at(j, j) : 0.0;
      at(i, i) -= at(i, j) * at(i, j) * at(j, j);
    }
    if (!(at(i, i) > dependent * diagonal)) at(i, i) = 0;
  }
}

void ActiveSystem::solve() {
  const std::size_t size = points.size();
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t l = 0; l < i; ++l) right[i] -= at(i, l) * right[l];
  for (std::size_t i = size; i-- > 0;) {
    right[i] = at(i, i) != 0 ? right[i] / at(i, i) : 0.0;
    for (std::size_t l = i + 1; l < size; ++l) right[i] -= at(l, i) * right[l];
  }
}

StageDelassus::StageDelassus(StageOperator& op, const MarchModel& model, const FoldedStage* band)
    : op_(op),
      model_(model),
      band_(model.rubbed().rows() > 0 ? nullptr : band),
      contact_(model.pushed()),
      rows_(model.rows()),
      points_(contact_.rows()) {
  const auto points = static_cast<std::size_t>(points_);
  known_.assign(points, false);
  columns_ = std::make_unique_for_overwrite<double[]>(points * points);
  responses_ = std::make_unique_for_overwrite<double[]>(points * static_cast<std::size_t>(rows_));
  rhs_.assign(static_cast<std::size_t>(rows_), 0.0);
  response_.assign(static_cast<std::size_t>(rows_), 0.0);
}

HeldBand* StageDelassus::held() {
  if (band_) held_ = HeldBand::make(stage_system(model_, *band_), contact_.view());
  band_ = nullptr;
  return held_.get();
}

const double* StageDelassus::respond(const double* efforts, int stride) {
  std::fill(rhs_.begin(), rhs_.end(), 0.0);
  for (std::size_t j = 0; j < static_cast<std::size_t>(points_); ++j) {
    const double p = efforts[j * static_cast<std::size_t>(stride)];
    if (p == 0) continue;
    for (auto e = static_cast<std::size_t>(contact_.start[j]); e < static_cast<std::size_t>(contact_.start[j + 1]); ++e)
      rhs_[static_cast<std::size_t>(contact_.index[e])] += contact_.value[e] * p;
  }
  op_.solve_column(rhs_.data(), response_.data());
  return response_.data();
}

int StageDelassus::computed() const {
  return static_cast<int>(std::count(known_.begin(), known_.end(), true));
}

void StageDelassus::compute(int j) {
  known_[static_cast<std::size_t>(j)] = true;
  const auto first = static_cast<std::size_t>(contact_.start[static_cast<std::size_t>(j)]);
  const auto last = static_cast<std::size_t>(contact_.start[static_cast<std::size_t>(j) + 1]);
  std::fill(rhs_.begin(), rhs_.end(), 0.0);
  for (std::size_t e = first; e < last; ++e) rhs_[static_cast<std::size_t>(contact_.index[e])] = contact_.value[e];
  double* response = responses_.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(rows_);
  op_.solve_column(rhs_.data(), response);
  double* out = columns_.get() + static_cast<std::size_t>(j) * static_cast<std::size_t>(points_);
  for (std::size_t i = 0; i < static_cast<std::size_t>(points_); ++i) {
    double sum = 0;
    for (auto e = static_cast<std::size_t>(contact_.start[i]); e < static_cast<std::size_t>(contact_.start[i + 1]); ++e)
      sum += contact_.value[e] * response[contact_.index[e]];
    out[i] = sum;
  }
}

StageImpulse::StageImpulse(const ImpulseProgram& program, StageOperator& op, const MarchModel& model)
    : program_(program), op_(op), model_(model), rows_(model.rows()), points_(model.pushed().rows()) {
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
  const RowMatrix& H = model_.pushed();
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
