#include <ricochet/engine/flight/drive_rows.hpp>
#include <ricochet/engine/flight/effort_response.hpp>

namespace ricochet {

using Eigen::MatrixXd;
using Eigen::VectorXd;

EffortResponse::EffortResponse(const Program& program, int stage, int ago, const VectorXd& row) {
  const auto stages = static_cast<int>(program.stages.size()), slots = static_cast<int>(program.plan.slots.size());
  const VectorXd mass = program.model->inertia().mass.diagonal();
  slots_.push_back(MatrixXd::Zero(row.size(), slots));
  for (int at = 0; at < stages; ++at) {
    const StageProgram& one = program.stages[static_cast<std::size_t>(at)];
    const FoldedStage& folded = one.folded;
    const MatrixXd& before = slots_.back();
    const int place = at + ago * stages - stage;
    const double weight = one.reads_contact && place >= 0 && place < static_cast<int>(one.effort.size())
                              ? one.effort[static_cast<std::size_t>(place)]
                              : 0.0;
    none_ = none_ && weight == 0;
    VectorXd z = VectorXd::Zero(row.size());
    if (folded.solves()) {
      z = weight * row;
      for (int j = 0; j < slots; ++j)
        z += ((weight_at(folded.mass_history, j) * mass.array() + weight_at(folded.stiffness_history, j)) *
              before.col(j).array())
                 .matrix();
      z.array() /= folded.mass * mass.array() + folded.stiffness;
    }
    unknown_.push_back(z);
    MatrixXd after = MatrixXd::Zero(row.size(), slots);
    const std::vector<Combination>& update = program.plan.stages[static_cast<std::size_t>(at)].update;
    for (int j = 0; j < slots; ++j) after.col(j) = of(at, update[static_cast<std::size_t>(j)]);
    slots_.push_back(std::move(after));
  }
}

VectorXd EffortResponse::of(int at, const Combination& c) const {
  const MatrixXd& slots = slots_[static_cast<std::size_t>(at)];
  VectorXd sum = VectorXd::Zero(slots.rows());
  if (c.z != 0) sum += c.z * unknown_[static_cast<std::size_t>(at)];
  for (int j = 0; j < static_cast<int>(c.slots.size()); ++j)
    if (const double weight = weight_at(c.slots, j); weight != 0) sum += weight * slots.col(j);
  return sum;
}

}  // namespace ricochet
