#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/engine/energy_bounds.hpp>
#include <ricochet/kernels/floating_point.hpp>

namespace ricochet {

EnergyScale::EnergyScale(const SemiDiscrete& problem)
    : problem_(&problem),
      mass_(QuadraticForm::of(problem.inertia)),
      stiffness_(problem.stiffness),
      compliance_({problem.stiffness, {}, {}}) {
  support_energy_ = static_energy(problem.support_shape);
  support_mass_ = problem.support_shape.lpNorm<1>();
  for (int i = 0; i < problem.points(); ++i) {
    const double compliance = 2 * static_energy(problem.contact.row(i).transpose());
    stop_energy_.push_back(compliance > 0 ? 0.5 / compliance : 0);
  }
}

// ½ fᵀ K⁻¹ f; 0 without a force or where K has no factor.
double EnergyScale::static_energy(const Eigen::VectorXd& load) const {
  return load.size() == 0 ? 0 : 0.5 * compliance_(load).value_or(0);
}

double EnergyScale::of_lane(const LaneSpec& lane) const {
  double scale = 0.5 * (stiffness_(lane.position.data()) + mass_(lane.velocity.data()));
  const double speed = lane.amplitude * problem_->support.pulsation;
  const double push = speed * problem_->support.pulsation;
  scale = std::max({scale, push * push * support_energy_, 0.5 * speed * speed * support_mass_});
  for (int i = 0; i < problem_->points(); ++i) {
    const double reach = std::min(std::abs(lane.lower[i]), std::abs(lane.upper[i]));
    if (std::isfinite(reach)) scale = std::max(scale, reach * reach * stop_energy_[static_cast<std::size_t>(i)]);
  }
  return scale;
}

double EnergyScale::of_load(double t) const {
  if (!problem_->load) return 0;
  Eigen::VectorXd load = Eigen::VectorXd::Ones(problem_->dofs());
  if (static_energy(load) == 0) return std::numeric_limits<double>::infinity();
  constexpr int samples = 64;
  double scale = 0;
  for (int k = 0; k <= (t == 0 ? 0 : samples); ++k) {
    problem_->load->assemble(t * k / samples, load.data());
    if (load.allFinite()) scale = std::max(scale, static_energy(load));
  }
  return scale;
}

EnergyBounds::EnergyBounds(const Program& program)

    : scale_(*program.problem),
      bounded_(program.bounded),
      load_varies_(program.load && !program.load_constant),
      lanes_(program.lanes.size()) {
  if (program.load) load_ = factor * scale_.of_load(0);
}

void EnergyBounds::place(int lane, const LaneSpec& spec, double stored) {
  lanes_[static_cast<std::size_t>(lane)] = bounded_ ? factor * std::max(scale_.of_lane(spec), stored) : infinity;
}

double EnergyBounds::known(int lane) const {
  return std::max(lanes_[static_cast<std::size_t>(lane)], load_);
}

double EnergyBounds::of(int lane) const {
  const double bound = known(lane);
  return bound == 0 ? infinity : bound;
}

bool EnergyBounds::passed(int lane, double energy, double t) {
  // A load that depends on time may have grown since the start.
  if (load_varies_ && t > load_known_until_ && energy > known(lane)) {
    load_known_until_ = 2 * t;
    load_ = std::max(load_, factor * scale_.of_load(load_known_until_));
  }
  return energy > of(lane);
}

}  // namespace ricochet
