#include <cmath>
#include <numbers>
#include <ricochet/engine/flight/flight_motion.hpp>
#include <ricochet/scene/pulsation.hpp>

namespace ricochet {

Eigen::MatrixXd FlightDrive::change(double steps) const {
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(count(), count());
  if (!harmonic()) return R;
  const double turn = angle * steps, half = std::sin(turn / 2), fall = -2 * half * half, rise = std::sin(turn);
  R.topLeftCorner(2, 2) << fall, rise, -rise, fall;
  return R;
}

StepRows::StepRows(const std::vector<FlightStage>& stages, int slots, const Eigen::VectorXd& mass,
                   const Eigen::VectorXd& damping, const FlightDrive& drive)
    : slots_(slots), drive_(drive), maps_(static_cast<std::size_t>(mass.size())) {
  for (Eigen::Index mode = 0; mode < mass.size(); ++mode) {
    std::vector<StageMap>& maps = maps_[static_cast<std::size_t>(mode)];
    const double c = damping.size() > 0 ? damping[mode] : 0;
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(slots, width());
    for (const FlightStage& stage : stages) {
      StageMap& map = maps.emplace_back(StageMap{change, Eigen::RowVectorXd::Zero(width())});
      const FoldedStage& folded = stage.folded;
      if (folded.solves()) {
        for (int j = 0; j < slots; ++j) {
          const auto at = static_cast<std::size_t>(j);
          double weight = folded.mass_history[at] * mass[mode] + folded.stiffness_history[at];
          if (c != 0) weight += folded.damping_history[at] * c;
          map.unknown += weight * slot(map, j);
        }
        if (drive_.count() > 0) map.unknown.tail(drive_.count()) += stage.force.row(mode);
        map.unknown /= folded.mass * mass[mode] + folded.stiffness + folded.damping * c;
      }
      for (int j = 0; j < slots; ++j) {
        const Combination& update = stage.update[static_cast<std::size_t>(j)];
        change.row(j) += update.z * map.unknown;
        for (int i = 0; i < slots; ++i) {
          const double weight =
              static_cast<std::size_t>(i) < update.slots.size() ? update.slots[static_cast<std::size_t>(i)] : 0.0;
          if (const double more = weight - (i == j ? 1.0 : 0.0); more != 0) change.row(j) += more * slot(map, i);
        }
      }
    }
    maps.push_back({change, Eigen::RowVectorXd::Zero(width())});
  }
}

Eigen::RowVectorXd StepRows::slot(const StageMap& map, int j) const {
  Eigen::RowVectorXd row = map.change.row(j);
  row[j] += 1;
  return row;
}

Eigen::RowVectorXd StepRows::of(int mode, int stage, const Combination& c) const {
  const StageMap& map = maps_[static_cast<std::size_t>(mode)][static_cast<std::size_t>(stage)];
  Eigen::RowVectorXd row = c.z * map.unknown;
  for (std::size_t j = 0; j < c.slots.size(); ++j)
    if (c.slots[j] != 0) row += c.slots[j] * slot(map, static_cast<int>(j));
  return row;
}

using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

RowVectorXd harmonic(const PhaseWeights& phase, const FlightDrive& drive, double factor) {
  RowVectorXd row = RowVectorXd::Zero(drive.count());
  if (!drive.support) return row;
  row[0] = factor * phase.along;
  row[1] = factor * phase.across;
  return row;
}

MatrixXd load_over_drive(const Program& program, const Levels& levels, const FlightDrive& drive) {
  const int rows = program.model->rows();
  MatrixXd load = MatrixXd::Zero(rows, drive.count());
  const double omega = program.problem->support.pulsation;
  if (drive.support)
    load += program.model->support_shape() * harmonic(PhaseWeights(levels, omega, program.h), drive, omega * omega);
  if (!program.load) return load;
  VectorXd nodal(rows);
  const auto at = [&](double t) {
    VectorXd own(rows);
    program.problem->load->assemble(t, nodal.data());
    program.model->load_to_model(nodal.data(), own.data());
    return own;
  };
  double weight = 0;
  for (const Level& level : levels) weight += level.weight;
  const VectorXd start = at(0);
  if (!drive.load) {
    load.col(drive.one()) += weight * start;
    return load;
  }
  const double quarter = std::numbers::pi / 2 / program.load_pulsation;
  const auto [constant, along, across] = harmonic_parts(start, at(quarter), at(2 * quarter));
  const PhaseWeights phase(levels, program.load_pulsation, program.h);
  load.col(0) += phase.along * along - phase.across * across;
  load.col(1) += phase.across * along + phase.along * across;
  load.col(drive.one()) += weight * constant;
  return load;
}

using Eigen::MatrixXd;
using Eigen::VectorXd;

EffortResponse::EffortResponse(const Program& program, int stage, int ago, const VectorXd& row) {
  const auto stages = static_cast<int>(program.stages.size()), slots = static_cast<int>(program.plan.slots.size());
  const VectorXd mass = program.model->inertia().mass.diagonal(), &damping = program.model->modal_damping();
  // (m μ + k + c) of every mode.
  const auto operators = [&](double m, double k, double c) {
    VectorXd sum = (m * mass.array() + k).matrix();
    if (damping.size() > 0) sum += c * damping;
    return sum;
  };
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
        z += operators(weight_at(folded.mass_history, j), weight_at(folded.stiffness_history, j),
                       weight_at(folded.damping_history, j))
                 .cwiseProduct(before.col(j));
      z.array() /= operators(folded.mass, folded.stiffness, folded.damping).array();
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

std::vector<double> slot_weights(const Combination& c) {
  std::vector<double> all = c.slots;
  all.resize(most_slots);
  all.push_back(c.z);
  return all;
}

}  // namespace ricochet
