#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/measure/stability/stability.hpp>
#include <ricochet/measure/stability/step_map.hpp>
#include <ricochet/measure/stability/structure_physics.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// Gathers the roots of a step: the largest, and those that ought not to be marginal.
class RootCollector {
 public:
  RootCollector(const Damping& damping, double h, Detail detail) : damping_(damping), h_(h), detail_(detail) {}

  bool full() const { return detail_ == Detail::full; }
  double h() const { return h_; }
  const Damping& damping() const { return damping_; }
  void largest(const Root& root, double pulsation, bool on_kernel, const std::string& mode);

  /// A root that lives on a motion (m, c, k), of which `others` roots with this one are on the unit circle.
  void judge(const Root& root, double m, double c, double k, int others, double tolerance, RootPlace place,
             const std::string& where);

  StepSpectrum finish(const std::string& contact);

  StepSpectrum spectrum;

 private:
  void name(const Root& root, RootPlace place, const std::string& where);

  Damping damping_;
  double h_;
  Detail detail_;
  static constexpr std::size_t most_findings = 3;
};

namespace {

// The larger modulus of e^{λh}, mλ² + cλ + k = 0: what time h leaves of the motion; 0 where nothing moves by itself.
double physical_modulus(double m, double c, double k, double h) {
  if (m <= 0) return c > 0 ? std::exp(-k * h / c) : 0.0;
  const double discriminant = c * c - 4 * m * k;
  if (discriminant < 0) return std::exp(-0.5 * c * h / m);
  const double sum = c + std::sqrt(discriminant);
  return sum > 0 ? std::exp(-2 * k * h / sum) : 1.0;
}

}  // namespace

std::string root_text(std::complex<double> root) {
  const double near = 1e-6;
  if (std::abs(root - 1.0) < near) return "root +1";
  if (std::abs(root + 1.0) < near) return "root −1";
  if (std::abs(root.real()) < near) return "roots ±i";
  return fmt::format("roots of modulus 1 at ±{:.4g}°", std::abs(std::arg(root)) * 180 / std::numbers::pi);
}

void RootCollector::largest(const Root& root, double pulsation, bool on_kernel, const std::string& mode) {
  const double size = std::abs(root.value);
  // Of equal moduli the first is told: slow modes of an undamped structure all have modulus one.
  if (size <= spectrum.radius * (1 + 1e-12)) return;
  spectrum.radius = size;
  spectrum.root = root.value;
  spectrum.pulsation = pulsation;
  spectrum.on_kernel = on_kernel;
  spectrum.mode = mode;
}

void RootCollector::judge(const Root& root, double m, double c, double k, int others, double tolerance, RootPlace place,
                          const std::string& where) {
  const double size = std::abs(root.value);
  if (size < 1 - tolerance || size > 1 + growth_tolerance) return;
  const double physical = physical_modulus(m, c, k, h_);
  if (physical >= 1 - 10 * tolerance) {
    // A motion that neither decays nor lacks inertia has two roots on the circle, which meet at +1 as h → 0.
    if (std::abs(root.value - 1.0) < 1e-3) return;
    if (!root.defective && others <= 2) return;
    name(root, place, where);
  } else {
    name(root, place, where + (m > 0 ? ", though the structure is damped" : ""));
  }
}

void RootCollector::name(const Root& root, RootPlace place, const std::string& where) {
  spectrum.grows_linearly = spectrum.grows_linearly || root.defective;
  for (MarginalRoot& finding : spectrum.marginal_roots)
    if (finding.where == where && finding.defective == root.defective &&
        std::min(std::abs(finding.value - root.value), std::abs(finding.value - std::conj(root.value))) < 1e-6) {
      finding.count += std::abs(finding.value - root.value) < 1e-6;
      return;
    }
  spectrum.marginal_roots.push_back({root.value, place, where, root.defective, 1});
}

StepSpectrum RootCollector::finish(const std::string& contact) {
  spectrum.contact = contact;
  const std::vector<MarginalRoot>& findings = spectrum.marginal_roots;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const MarginalRoot& finding = findings[i];
    if (!spectrum.marginal.empty()) spectrum.marginal += "; ";
    if (i == most_findings) {
      spectrum.marginal += fmt::format("and {} more", findings.size() - i);
      break;
    }
    spectrum.marginal += finding.defective ? "double " : "";
    spectrum.marginal += root_text(finding.value) + " on " + finding.where;
    if (finding.count > 1) spectrum.marginal += fmt::format(" ({} times)", finding.count);
    if (finding.defective) spectrum.marginal += ": grows linearly";
  }
  return std::move(spectrum);
}

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Its multiples fill [0, 1) without repeating.
constexpr double golden = std::numbers::phi - 1;

// Roots of modes come from 2 × 2 or 3 × 3 matrices and are known to round-off; those of dense steps less well.
constexpr double modal_marginal = 1e-9, dense_marginal = 1e-7;

}  // namespace

StabilityPredictor::~StabilityPredictor() = default;
StabilityPredictor::StabilityPredictor(StabilityPredictor&&) noexcept = default;

StabilityPredictor::StabilityPredictor(std::shared_ptr<const SemiDiscrete> problem, LinearLaw law)
    : problem_(std::move(problem)), law_(law) {
  if (problem_->dofs() > most_modal_dofs) {
    notes_.push_back(fmt::format("no step is predicted: the {} dofs are over {}, where modes cost more than marching",
                                 problem_->dofs(), most_modal_dofs));
    return;
  }
  if (problem_->damping.own()) {
    notes_.emplace_back("no step is predicted: the damping is not made of K and M");
    return;
  }
  modes_ = std::make_unique<StructureModes>(open_modes(*problem_));
  choose_sets();
}

double StabilityPredictor::first_pulsation() const {
  return modes_ && modes_->regular > 0 ? modes_->pulsation(0) : 0.0;
}

Excitation StabilityPredictor::excite(const StructureModes& modes, double h) const {
  Excitation out{VectorXd::Zero(problem_->dofs()), VectorXd::Zero(problem_->dofs())};
  for (int i = 0; i < modes.size(); ++i) {
    if (modes.stiffness[i] == 0) continue;
    const double sign = std::fmod(golden * (i + 1), 1.0) < 0.5 ? -1.0 : 1.0;
    const double lift = sign / std::sqrt(modes.stiffness[i]);
    out.position += lift * modes.shapes.col(i);
    // Without mass, viscosity alone says how fast: q' = −q/α; without that, half of itself in a step.
    const double massless = -lift / std::max(problem_->damping.stiffness, 2 * h);
    out.velocity += (i < modes.regular ? sign / std::sqrt(modes.mass[i]) : massless) * modes.shapes.col(i);
  }
  return out;
}
Excitation StabilityPredictor::excitation(double h) const {
  if (modes_) return excite(*modes_, h);
  Excitation out{VectorXd(problem_->dofs()), VectorXd::Zero(problem_->dofs())};
  for (Index i = 0; i < out.position.size(); ++i)
    out.position[i] = std::fmod(golden * static_cast<double>(i + 1), 1.0) - 0.5;
  return out;
}
Excitation StabilityPredictor::excitation(const ClosedSet& set, double h) const {
  const bool moves = modes_ && problem_->dofs() > static_cast<int>(set.points.size());
  return moves ? excite(held_at(set), h) : Excitation{};
}

// Modes from `first` on, each by itself.
std::optional<Refusal> StabilityPredictor::add_modes(RootCollector& found, const StepPlan& plan,
                                                     const StructureModes& modes, int first) const {
  for (int i = first; i < modes.size(); ++i) {
    const double m = modes.mass[i], k = modes.stiffness[i];
    const double c = found.damping().stiffness * k + found.damping().mass * m;
    const MatrixXd step = amplification(plan, m, c, k);
    if (!step.allFinite()) return Refusal{"the matrix of the step is singular on " + modes.name(i)};
    int others = 0;
    for (const Root& root : step_roots(in_metres(step, plan, found.h(), 1), found.full())) {
      found.largest(root, modes.pulsation(i), i >= modes.regular, modes.name(i));
      if (!found.full()) break;
      if (std::abs(root.value) >= 1 - modal_marginal) others += root.multiplicity;
      found.judge(root, m, c, k, others, modal_marginal, i >= modes.regular ? RootPlace::kernel : RootPlace::mode,
                  modes.name(i));
    }
  }
  return std::nullopt;
}

SpectrumOrRefusal StabilityPredictor::open(const StepPlan& plan, double h, Detail detail) const {
  if (!modes_) return Refusal{notes_.front()};
  RootCollector found(problem_->damping, h, detail);
  if (auto refusal = add_modes(found, plan, *modes_, 0)) return *refusal;
  return found.finish("open");
}

// Computed once for each set that is asked for.
const StructureModes& StabilityPredictor::held_at(const ClosedSet& set) const {
  std::unique_ptr<StructureModes>& held = held_modes_[set.points];
  if (!held) {
    const bool free = modes_->regular > 0 && modes_->stiffness.head(modes_->regular).minCoeff() == 0;
    held = std::make_unique<StructureModes>(held_modes(*problem_, set.points, free));
  }
  return *held;
}

SpectrumOrRefusal StabilityPredictor::held(const StepPlan& plan, double h, const ClosedSet& set, Detail detail) const {
  const auto points = held_point_map(plan);
  if (!points) return dense(plan, h, set, detail);
  RootCollector found(problem_->damping, h, detail);
  if (problem_->dofs() > static_cast<int>(set.points.size()))
    if (auto refusal = add_modes(found, plan, held_at(set), 0)) return *refusal;
  for (const Root& root : step_roots(in_metres(*points, plan, h, 1), found.full())) {
    found.largest(root, 0, false, "the held points");
    // Held points do not move: no root of theirs has a motion behind it.
    if (found.full()) found.judge(root, 0, 0, 1, 0, modal_marginal, RootPlace::held_points, "the held points");
  }
  return found.finish(set.name);
}

SpectrumOrRefusal StabilityPredictor::dense(const StepPlan& plan, double h, const ClosedSet& set, Detail detail) const {
  const Index n = problem_->dofs(), points = static_cast<Index>(set.points.size());
  StructureModes modes = *modes_;
  MatrixXd rows(points, n);
  for (Index i = 0; i < points; ++i)
    rows.row(i) = Eigen::RowVectorXd(problem_->measured().row(set.points[static_cast<std::size_t>(i)])) * modes.shapes;
  // κ_i h_i h_iᵀ = κ (√(κ_i/κ) h_i)(√(κ_i/κ) h_i)ᵀ: rows of this length share one κ.
  for (Index i = 0; i < points && law_.stiffness && !law_.own.empty(); ++i)
    rows.row(i) *=
        std::sqrt(law_.own[static_cast<std::size_t>(set.points[static_cast<std::size_t>(i)])] / *law_.stiffness);
  // Within Ker M any orthogonal basis serves: one in which only the first directions move the points.
  const Index kernel = n - modes.regular;
  Index felt = n;
  if (kernel > 0) {
    const MatrixXd turn = householder_basis(rows.rightCols(kernel).transpose());
    rows.rightCols(kernel) = (rows.rightCols(kernel) * turn).eval();
    felt = modes.regular + std::min(points, kernel);
  }
  const Damping& damping = problem_->damping;
  LinearProblem problem;
  problem.mass = modes.mass.head(felt).asDiagonal();
  problem.stiffness = modes.stiffness.head(felt).asDiagonal();
  problem.damping = damping.stiffness * problem.stiffness + damping.mass * problem.mass;
  problem.contact = rows.leftCols(felt);
  const auto map = step_map(problem, plan, {law_.evaluation, law_.stiffness.value_or(0.0)});
  if (const auto* refusal = std::get_if<Refusal>(&map)) return *refusal;

  RootCollector found(damping, h, detail);
  if (felt < n)
    if (auto refusal = add_modes(found, plan, modes, static_cast<int>(felt))) return *refusal;
  const std::vector<Root> roots =
      step_roots(in_metres(std::get<MatrixXd>(map), plan, h, felt, law_.stiffness.value_or(1.0)), found.full());
  if (roots.empty()) return Refusal{"the eigenvalues of the closed step were not found"};
  for (const Root& root : roots) {
    if (!found.full()) {
      found.largest(root, 0, false, "");
      break;
    }
    // The slot in which the motion is largest.
    Eigen::VectorXcd shape = root.vector.head(felt);
    for (std::size_t j = 1; j < plan.slots.size(); ++j) {
      const auto slot = root.vector.segment(static_cast<Index>(j) * felt, felt);
      if (slot.norm() > shape.norm()) shape = slot;
    }
    const VectorXd square = shape.cwiseAbs2();
    const double m = square.dot(modes.mass.head(felt)), elastic = square.dot(modes.stiffness.head(felt));
    const double spring = law_.stiffness.value_or(0.0) * (problem.contact * shape).squaredNorm();
    Index main = 0;
    (square.array() * (modes.stiffness.head(felt).array() + modes.mass.head(felt).array() / (h * h))).maxCoeff(&main);
    const int mode = static_cast<int>(main);
    found.largest(root, modes.pulsation(mode), mode >= modes.regular, modes.name(mode));
    const bool massless = mode >= modes.regular;
    found.judge(root, massless ? 0.0 : m, damping.stiffness * elastic + damping.mass * m, elastic + spring, 0,
                dense_marginal, massless ? RootPlace::kernel : RootPlace::mode, modes.name(mode));
  }
  return found.finish(set.name);
}

SpectrumOrRefusal StabilityPredictor::closed(const StepPlan& plan, double h, const ClosedSet& set,
                                             Detail detail) const {
  if (!modes_) return Refusal{notes_.front()};
  return law_.evaluation ? dense(plan, h, set, detail) : held(plan, h, set, detail);
}

SpectrumOrRefusal StabilityPredictor::worst_closed(const StepPlan& plan, double h, Detail detail) const {
  std::optional<StepSpectrum> worst;
  std::optional<Refusal> refused;
  for (const ClosedSet& set : sets_) {
    auto one = closed(plan, h, set, detail);
    if (const auto* refusal = std::get_if<Refusal>(&one)) {
      refused = *refusal;
      continue;
    }
    StepSpectrum& spectrum = std::get<StepSpectrum>(one);
    const bool worse =
        !worst || (spectrum.stable() && worst->stable() ? worst->marginal.empty() && !spectrum.marginal.empty()
                                                        : spectrum.radius > worst->radius);
    if (worse) worst = std::move(spectrum);
    if (detail == Detail::radius && !worst->stable()) break;
  }
  if (worst) return *worst;
  return refused.value_or(Refusal{notes_.empty() ? "no contact to close" : notes_.front()});
}

StepLimit step_limit(const std::function<SpectrumOrRefusal(double h)>& spectrum, const std::vector<double>& steps) {
  StepLimit limit;
  const auto at = [&](double h) -> std::optional<StepSpectrum> {
    auto found = spectrum(h);
    if (auto* known = std::get_if<StepSpectrum>(&found)) return std::move(*known);
    return std::nullopt;
  };
  std::optional<double> stable, unstable;
  for (const double h : steps) {
    const auto found = at(h);
    if (!found) continue;
    if (!found->stable()) {
      unstable = h;
      limit.beyond = found;
      break;
    }
    stable = h;
  }
  if (!unstable) return limit;
  for (double h = *unstable; !stable && h > 1e-6 * steps.front();) {
    limit.below_range = true;
    h /= 4;
    const auto found = at(h);
    if (!found) return limit;
    if (found->stable())
      stable = h;
    else
      unstable = h, limit.beyond = found;
  }
  if (!stable) return limit;
  double low = *stable, high = *unstable;
  while (high > low * (1 + 1e-6)) {
    const double middle = std::sqrt(low * high);
    const auto found = at(middle);
    if (!found) break;
    if (found->stable())
      low = middle;
    else
      high = middle, limit.beyond = found;
  }
  limit.step = low;
  return limit;
}

}  // namespace ricochet
