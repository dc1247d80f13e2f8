#include "tests/benchmarks/siconos_beam.hpp"

#include <Eigen/Eigenvalues>
#include <Interaction.hpp>
#include <LCP.hpp>
#include <LagrangianLinearDiagonalDS.hpp>
#include <LagrangianLinearTIDS.hpp>
#include <LagrangianLinearTIR.hpp>
#include <MoreauJeanOSI.hpp>
#include <NewtonImpactNSL.hpp>
#include <NonSmoothDynamicalSystem.hpp>
#include <OneStepNSProblem.hpp>
#include <SiconosVector.hpp>
#include <SimpleMatrix.hpp>
#include <SimulationGraphs.hpp>
#include <TimeDiscretisation.hpp>
#include <TimeStepping.hpp>
#include <cmath>

namespace ricochet::benchmarks {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

// F(t) = a sin ωt + b cos ωt, as a constant operator would give it: no plugin, no file.
struct Harmonic {
  Vector sine, cosine;
  double pulsation = 0;
  void evaluate(double t, SiconosVector& out) const {
    const double s = std::sin(pulsation * t), c = std::cos(pulsation * t);
    double* to = out.getArray();
    for (Eigen::Index i = 0; i < sine.size(); ++i) to[i] = s * sine[i] + c * cosine[i];
  }
};

// A system of Siconos under such a load; without one it has no external force at all.
template <class System>
struct Shaken : System {
  template <class... Arguments>
  explicit Shaken(Harmonic load, Arguments... arguments) : System(arguments...), load_(std::move(load)) {
    if (load_.sine.size() > 0)
      this->setFExtPtr(std::make_shared<SiconosVector>(static_cast<unsigned>(load_.sine.size())));
  }
  void computeFExt(double time) override { load_.evaluate(time, *this->_fExt); }

 private:
  Harmonic load_;
};

std::shared_ptr<SiconosVector> vector_of(const Vector& from) {
  auto made = std::make_shared<SiconosVector>(static_cast<unsigned>(from.size()));
  for (Eigen::Index i = 0; i < from.size(); ++i) made->setValue(static_cast<unsigned>(i), from[i]);
  return made;
}

std::shared_ptr<SimpleMatrix> matrix_of(const Matrix& from, bool sparse) {
  const auto rows = static_cast<unsigned>(from.rows()), columns = static_cast<unsigned>(from.cols());
  const auto entries = static_cast<unsigned>((from.array() != 0).count());
  auto made = sparse ? std::make_shared<SimpleMatrix>(rows, columns, Siconos::SPARSE, entries)
                     : std::make_shared<SimpleMatrix>(rows, columns);
  if (!sparse) made->zero();
  for (unsigned i = 0; i < rows; ++i)
    for (unsigned j = 0; j < columns; ++j)
      if (from(i, j) != 0) made->setValue(i, j, from(i, j));
  return made;
}

int solver_of(SiconosBeam::Solver solver) {
  return solver == SiconosBeam::Solver::pgs ? SICONOS_LCP_PGS : SICONOS_LCP_LEMKE;
}

// Impacts of points that leave: the law's right-hand side gets w⁻ where that is positive, and w⁺ + w⁻ ≥ 0 results.
struct PassingMoreauJean : MoreauJeanOSI {
  using MoreauJeanOSI::MoreauJeanOSI;
  void computeFreeOutput(InteractionsGraph::VDescriptor& vertex, OneStepNSProblem* problem) override {
    MoreauJeanOSI::computeFreeOutput(vertex, problem);
    InteractionsGraph& set = *problem->simulation()->indexSet(problem->indexSetLevel());
    const double before = (*set.bundle(vertex)->y_k(problem->inputOutputLevel()))(0);
    SiconosVector& right = *(*set.properties(vertex).workVectors)[MoreauJeanOSI::OSNSP_RHS];
    if (before > 0) right(0) += before;
  }
};

}  // namespace

struct SiconosBeam::Parts {
  std::shared_ptr<LagrangianDS> system;
  std::vector<std::shared_ptr<Interaction>> relations;
  std::shared_ptr<TimeStepping> simulation;
  Vector tip;
  double shift = 0;  // of the absolute displacement against u: (1 − 1/κ) A
  double pulsation = 0, h = 0;
  long long made = 0;
};

SiconosBeam::SiconosBeam(ShakenBeam beam, double h, long long steps, Form form, Leaving leaving, Solver solver)
    : parts_(std::make_unique<Parts>()) {
  auto& [M, K, H, alpha, s, r, tip, lower, upper, q, v, A, omega] = beam;
  const auto n = q.size();
  if (form == Form::modes) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solved(K, M);
    const Matrix modes = solved.eigenvectors(), inverse = modes.transpose() * M;
    q = inverse * q;
    v = inverse * v;
    r = inverse * r;
    s = modes.transpose() * s;
    H *= modes;
    tip = modes.transpose() * tip;
    M = Matrix::Identity(n, n);
    K = solved.eigenvalues().asDiagonal();
  }
  Harmonic load;
  double kappa = 1;
  if (A != 0) {
    kappa = std::tan(omega * h / 2) / (omega * h / 2);
    load.pulsation = omega;
    load.sine = A * (-omega * omega * (kappa * M * r - s) + K * r / kappa);
    load.cosine = A * omega * alpha * K * r;
    v += A * omega * r;
  }
  std::shared_ptr<LagrangianDS> system;
  const auto q0 = vector_of(q), v0 = vector_of(v);
  if (form == Form::modes) {
    const Vector stiffness = K.diagonal(), damping = alpha * stiffness;
    system =
        std::make_shared<Shaken<LagrangianLinearDiagonalDS>>(load, q0, v0, vector_of(stiffness), vector_of(damping));
  } else {
    const bool sparse = form == Form::sparse;
    SP::SiconosMatrix mass = matrix_of(M, sparse), stiffness = matrix_of(K, sparse),
                      damping = matrix_of(alpha * K, sparse);
    system = std::make_shared<Shaken<LagrangianLinearTIDS>>(load, q0, v0, mass, stiffness, damping);
  }
  const auto nsds = std::make_shared<NonSmoothDynamicalSystem>(0.0, h * static_cast<double>(steps + 1));
  nsds->insertDynamicalSystem(system);
  const auto law = std::make_shared<NewtonImpactNSL>(0.0);
  for (Eigen::Index i = 0; i < H.rows(); ++i)
    for (const double side : {1.0, -1.0}) {
      const double stop = side > 0 ? lower[i] : upper[i];
      if (!std::isfinite(stop)) continue;
      const auto relation = std::make_shared<LagrangianLinearTIR>(matrix_of(side * H.row(i), false),
                                                                  vector_of(Vector::Constant(1, -side * stop)));
      parts_->relations.push_back(std::make_shared<Interaction>(law, relation));
      nsds->link(parts_->relations.back(), system);
    }
  std::shared_ptr<MoreauJeanOSI> integrator;
  if (leaving == Leaving::stopped)
    integrator = std::make_shared<MoreauJeanOSI>(0.5);
  else
    integrator = std::make_shared<PassingMoreauJean>(0.5);
  parts_->simulation = std::make_shared<TimeStepping>(nsds, std::make_shared<TimeDiscretisation>(0.0, h), integrator,
                                                      std::make_shared<LCP>(solver_of(solver)));
  parts_->simulation->setNewtonOptions(SICONOS_TS_LINEAR);
  parts_->system = system;
  parts_->tip = tip;
  parts_->shift = A * (1 - 1 / kappa);
  parts_->pulsation = omega;
  parts_->h = h;
}

SiconosBeam::~SiconosBeam() = default;
SiconosBeam::SiconosBeam(SiconosBeam&&) noexcept = default;

void SiconosBeam::step() {
  parts_->simulation->computeOneStep();
  parts_->simulation->nextStep();
  ++parts_->made;
}

double SiconosBeam::tip() const {
  const SiconosVector& q = *parts_->system->q();
  double sum = parts_->shift * std::sin(parts_->pulsation * parts_->h * static_cast<double>(parts_->made));
  for (Eigen::Index i = 0; i < parts_->tip.size(); ++i) sum += parts_->tip[i] * q(static_cast<unsigned>(i));
  return sum;
}

double SiconosBeam::impulse() const {
  double sum = 0;
  for (const auto& relation : parts_->relations) sum += (*relation->lambda(1))(0);
  return sum;
}

int SiconosBeam::pushed() const {
  int count = 0;
  for (const auto& relation : parts_->relations) count += (*relation->lambda(1))(0) > 0;
  return count;
}

}  // namespace ricochet::benchmarks
