#include <algorithm>
#include <ricochet/algebra/weighted_system.hpp>
#include <ricochet/engine/stage_delassus.hpp>

namespace ricochet {

StageDelassus::StageDelassus(StageOperator& op, const MarchModel& model, const FoldedStage* band)
    : op_(op), model_(model), band_(band), contact_(model.measured()), rows_(model.rows()), points_(contact_.rows()) {
  const auto points = static_cast<std::size_t>(points_);
  known_.assign(points, false);
  columns_ = std::make_unique_for_overwrite<double[]>(points * points);
  responses_ = std::make_unique_for_overwrite<double[]>(points * static_cast<std::size_t>(rows_));
  rhs_.assign(static_cast<std::size_t>(rows_), 0.0);
  response_.assign(static_cast<std::size_t>(rows_), 0.0);
}

HeldBand* StageDelassus::held() {
  if (band_)
    held_ = HeldBand::make(weighted_system(band_->stiffness, model_.stiffness(), band_->mass, model_.inertia()),
                           contact_.view());
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

}  // namespace ricochet
