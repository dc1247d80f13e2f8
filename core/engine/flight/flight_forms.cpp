#include <algorithm>
#include <bit>
#include <ricochet/engine/flight/flight_motion.hpp>
#include <ricochet/engine/flight/flight_set.hpp>

namespace ricochet {
namespace {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

// The symmetric form of (a y)(b y).
MatrixXd product(const RowVectorXd& a, const RowVectorXd& b) {
  return 0.5 * (a.transpose() * b + b.transpose() * a);
}

}  // namespace

// The balance of a step as quadratic forms. M couples what is closed to what moves; K does not.
FlightWorks::Forms FlightSet::forms(const Program& program, const StepRows& rows, const VectorXd& mass,
                                    const MatrixXd& lifted) {
  FlightWorks::Forms forms;
  const int width = rows.width(), drives = drive_.count();
  const bool touching = !closed_.empty();
  const auto begin = [&](FlightWorks::Form& form) {
    if (form.empty()) form.assign(static_cast<std::size_t>(modes_), MatrixXd::Zero(width, width));
  };
  const auto padded = [&](const RowVectorXd& drive) {
    RowVectorXd row = RowVectorXd::Zero(width);
    row.tail(drives) = drive;
    return row;
  };
  // (m μ + k) of two combinations of a stage.
  const auto add = [&](FlightWorks::Form& form, double m, double k, int stage, const Combination& a,
                       const Combination& b) {
    begin(form);
    const MatrixXd lift_a = lift_of(a, lifted), lift_b = lift_of(b, lifted);
    const MatrixXd inert_a = project(own_mass_.asDiagonal() * lift_a),
                   inert_b = project(own_mass_.asDiagonal() * lift_b);
    for (int mode = 0; mode < modes_; ++mode) {
      const RowVectorXd row_a = rows.of(mode, stage, a), row_b = rows.of(mode, stage, b);
      MatrixXd& Q = form[static_cast<std::size_t>(mode)];
      Q += (m * mass[mode] + k) * product(row_a, row_b);
      if (touching) Q += m * (product(row_a, padded(inert_b.row(mode))) + product(padded(inert_a.row(mode)), row_b));
    }
    if (!touching) return;
    const MatrixXd common = m * lift_a.transpose() * own_mass_.asDiagonal() * lift_b + k * lift_a.transpose() * lift_b;
    form.front().bottomRightCorner(drives, drives) += 0.5 * (common + common.transpose());
  };
  for (std::size_t at = 0; at < program.plan.stages.size(); ++at) {
    const Stage& plan = program.plan.stages[at];
    const int stage = static_cast<int>(at);
    for (const LossTerm& term : plan.loss) {
      const bool inertial = term.matrix == EnergyMatrix::M;
      add(forms.scheme, inertial ? term.coefficient : 0, inertial ? 0 : term.coefficient, stage, term.value,
          term.value);
    }
    if (!plan.work) continue;
    const WorkForm& work = *plan.work;
    const Damping& damping = program.problem->damping;
    if (program.problem->damped())
      add(forms.damping, damping.mass, damping.stiffness, stage, work.displacement, work.rate);
    if (const VectorXd& own = program.model->modal_damping(); own.size() > 0)
      for (int mode = 0; mode < modes_; ++mode)
        forms.damping[static_cast<std::size_t>(mode)] +=
            own[mode] * product(rows.of(mode, stage, work.displacement), rows.of(mode, stage, work.rate));
    if (!program.support && !program.load) continue;
    begin(forms.loads);
    const MatrixXd load = load_over_drive(program, work.load, drive_), modal = project(load);
    for (int mode = 0; mode < modes_; ++mode)
      forms.loads[static_cast<std::size_t>(mode)] +=
          product(rows.of(mode, stage, work.displacement), padded(modal.row(mode)));
    if (!touching) continue;
    const MatrixXd common = lift_of(work.displacement, lifted).transpose() * load;
    forms.loads.front().bottomRightCorner(drives, drives) += 0.5 * (common + common.transpose());
    if (!program.support) continue;
    const RowVectorXd along =
        harmonic(PhaseWeights(work.support, program.problem->support.pulsation, program.h), drive_);
    const FlightWatch& pushed = bound_->watch(effort_watch_);
    const RowVectorXd push = pushed.drive.colwise().sum();
    forms.loads.front() -= product(padded(push), padded(along));
    const RowVectorXd weights = pushed.rows.colwise().sum();
    for (int mode = 0; mode < modes_; ++mode)
      forms.loads[static_cast<std::size_t>(mode)] -=
          product(weights[mode] * rows.of(mode, 0, pushed.value), padded(along));
  }
  return forms;
}

namespace {

constexpr int most_powers = 40;
constexpr double read_points = 16;  // of a set, of which tables are made to read them step by step

double reading_bytes(int modes, int slots, double points) {
  return 8 * points * (StepReadings::block + 1) * slots * modes;
}

}  // namespace

int flight_powers(long long steps) {
  return std::clamp(static_cast<int>(std::bit_width(static_cast<unsigned long long>(steps))), 4, most_powers);
}

double flight_set_bytes(int modes, int slots, int powers) {
  const double n = modes, width = slots + 3;
  return 8 * (2 * n * n + n * powers * (slots * width + 2 * width * (width + 1))) +
         reading_bytes(modes, slots, read_points);
}

std::size_t most_flight_sets(double set_bytes) {
  return static_cast<std::size_t>(std::clamp(0.25e9 / set_bytes, 1.0, 64.0));
}

// The motion without contact, the sets, the modes themselves, and rows of points over them for measures and bounds.
double flight_bytes(int modes, int slots, int points, long long steps) {
  const double set = flight_set_bytes(modes, slots, flight_powers(steps)), n = modes;
  const double sets = points > 0 ? static_cast<double>(most_flight_sets(set)) : 0;
  return set * (1 + sets) + reading_bytes(modes, slots, points) + 8 * n * (4 * n + 6.0 * points);
}

}  // namespace ricochet
