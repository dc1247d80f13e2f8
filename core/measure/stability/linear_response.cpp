#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/engine/stage_operator.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/measure/stability/linear_response.hpp>

namespace ricochet {
namespace {

using Complex = std::complex<double>;

// Of one mode; C is 0 where damping is folded.
struct Mode {
  double M, C, K, support;
};

// The clamp accelerates as −push e^{iωt}.
struct Forcing {
  Complex push;
  double pulsation, h;
};

// One step as X ← A X + b e^{iωt}, stage by stage.
struct ModeStep {
  Eigen::MatrixXcd A;
  Eigen::VectorXcd b;
};

// Nothing where a stage has no solution.
std::optional<ModeStep> mode_step(const StepPlan& plan, const Damping& damping, const Mode& mode,
                                  const Forcing& forcing) {
  const int slots = static_cast<int>(plan.slots.size());
  ModeStep step{Eigen::MatrixXcd::Identity(slots, slots), Eigen::VectorXcd::Zero(slots)};
  for (const Stage& stage : plan.stages) {
    const FoldedStage folded = fold(stage, damping, slots);
    Eigen::RowVectorXcd z = Eigen::RowVectorXcd::Zero(slots);
    Complex z0 = 0;
    if (folded.solves()) {
      const double S = folded.mass * mode.M + folded.stiffness * mode.K + folded.damping * mode.C;
      if (S == 0) return std::nullopt;
      Eigen::RowVectorXcd history = Eigen::RowVectorXcd::Zero(slots);
      for (int j = 0; j < slots; ++j) {
        const auto at = static_cast<std::size_t>(j);
        history[j] = folded.mass_history[at] * mode.M + folded.stiffness_history[at] * mode.K;
        if (!folded.damping_history.empty()) history[j] += folded.damping_history[at] * mode.C;
      }
      Complex load = 0;
      for (const Level& level : stage.load)
        load += level.weight * std::polar(1.0, forcing.pulsation * level.at * forcing.h);
      z = history * step.A / S;
      z0 = ((history * step.b)(0) + load * forcing.push * mode.support) / S;
    }
    Eigen::MatrixXcd next(slots, slots);
    Eigen::VectorXcd added(slots);
    for (int j = 0; j < slots; ++j) {
      const Combination& update = stage.update[static_cast<std::size_t>(j)];
      next.row(j) = update.z * z;
      added[j] = update.z * z0;
      for (std::size_t i = 0; i < update.slots.size(); ++i) {
        next.row(j) += update.slots[i] * step.A.row(static_cast<Eigen::Index>(i));
        added[j] += update.slots[i] * step.b[static_cast<Eigen::Index>(i)];
      }
    }
    step = {next, added};
  }
  return step;
}

}  // namespace

std::optional<LinearResponse> linear_response(const SemiDiscrete& problem, const StepPlan& plan, double h) {
  const double omega = problem.support.pulsation;
  if (omega == 0 || (problem.load && !problem.load->absent())) return std::nullopt;
  if (problem.damping.matrix) return std::nullopt;
  const MarchModel model(std::make_shared<SemiDiscrete>(problem), true);
  const int slots = static_cast<int>(plan.slots.size());
  const Eigen::VectorXd K = model.stiffness().diagonal(), M = model.inertia().mass.diagonal();
  const Eigen::VectorXd& C = model.modal_damping();
  const Complex turn = std::polar(1.0, omega * h);
  // u = φ + w, φ = A Im(e^{iωt}): with A = 1 the phasor of φ is −i, that of −φ'' is −iω².
  const Complex clamp(0, -1), push = clamp * omega * omega;
  Eigen::VectorXcd position = Eigen::VectorXcd::Zero(model.rows());
  const Eigen::MatrixXcd identity = Eigen::MatrixXcd::Identity(slots, slots);
  for (int mode = 0; mode < model.rows(); ++mode) {
    const auto step =
        mode_step(plan, problem.damping, {M[mode], C.size() > 0 ? C[mode] : 0.0, K[mode], model.support_shape()[mode]},
                  {push, omega, h});
    if (!step) return std::nullopt;
    const auto answer = regular_solve(turn * identity - step->A, step->b);
    if (!answer) return std::nullopt;
    position[mode] = (*answer)[0];
  }
  LinearResponse response;
  const auto read = [&](const RowMatrix& rows, int row) {
    Complex sum = clamp;
    for (int e = rows.start[static_cast<std::size_t>(row)]; e < rows.start[static_cast<std::size_t>(row) + 1]; ++e)
      sum += rows.value[static_cast<std::size_t>(e)] * position[rows.index[static_cast<std::size_t>(e)]];
    return sum;
  };
  for (int i = 0; i < model.measured().rows(); ++i) response.contact.push_back(read(model.measured(), i));
  response.tip = read(model.tip(), 0);
  return response;
}

double overlap(const LinearResponse& response, const LaneSpec& lane) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < response.contact.size(); ++i) {
    const double peak = std::abs(lane.amplitude) * std::abs(response.contact[i]);
    const auto point = static_cast<Eigen::Index>(i);
    most = std::max({most, peak - lane.upper[point], lane.lower[point] + peak});
  }
  return most;
}

std::optional<ContactSpring> contact_spring(const SemiDiscrete& problem, double stiffness, int point) {
  if (problem.points() == 0) return std::nullopt;
  if (point < 0) point = problem.points() - 1;
  return contact_spring(problem, stiffness, Eigen::VectorXd(Eigen::MatrixXd(problem.contact).row(point).transpose()));
}

std::optional<ContactSpring> contact_spring(const SemiDiscrete& problem, double stiffness, const Eigen::VectorXd& h) {
  constexpr int most_dofs = 240;
  if (problem.dofs() > most_dofs) return std::nullopt;
  const Eigen::MatrixXd held = Eigen::MatrixXd(problem.stiffness) + stiffness * h * h.transpose();
  const SymmetricModes modes = symmetric_modes(dense_mass(problem.inertia), held);
  if (!modes.found) return std::nullopt;
  const Eigen::VectorXd shares = stiffness * (modes.vectors.transpose() * h).array().square();
  Eigen::Index most = 0;
  shares.maxCoeff(&most);
  const double mu = modes.values[most];
  constexpr double massless = 1e-12;  // of the largest
  if (!(mu > massless * modes.values.maxCoeff())) return std::nullopt;
  return ContactSpring{stiffness, stiffness * mu, 1 / std::sqrt(mu)};
}

std::optional<double> contact_compliance(ContactLaw& law, const Parameters& parameters, double depth) {
  if (law.absent() || !law.reads()) return 0;
  law.prepare(1, std::span<const Parameters>(&parameters, 1));
  if (const auto stiffness = constant_stiffness(law)) return 1 / *stiffness;
  const double secant = 0.5 * depth * depth / law.potential({.depth = depth});
  return secant > 0 && std::isfinite(secant) ? std::optional(secant) : std::nullopt;
}

namespace {

constexpr std::size_t samples = 16;  // from one to the next over the values
constexpr int most_halvings = 60;
constexpr double resolution = 1e-12;  // relative

}  // namespace

std::vector<Grazing> find_grazings(const std::vector<double>& values,
                                   const std::function<std::optional<double>(double value)>& overlap) {
  std::vector<Grazing> found;
  if (values.empty()) return found;
  std::optional<double> before;
  double low = 0;
  const std::size_t last = values.size() - 1, stride = std::max<std::size_t>(1, last / samples);
  for (std::size_t i = 0; i <= last; i = i < last ? std::min(i + stride, last) : i + 1) {
    const auto now = overlap(values[i]);
    if (before && now && (*before < 0) != (*now < 0)) {
      double left = low, right = values[i];
      int steps = 0;
      for (; steps < most_halvings && right - left > resolution * std::max(std::abs(left), std::abs(right)); ++steps) {
        const double middle = 0.5 * (left + right);
        const auto there = overlap(middle);
        if (!there) break;
        ((*there < 0) == (*before < 0) ? left : right) = middle;
      }
      found.push_back({*before < 0, 0.5 * (left + right), left, right, steps});
    }
    before = now;
    low = values[i];
  }
  return found;
}

}  // namespace ricochet
