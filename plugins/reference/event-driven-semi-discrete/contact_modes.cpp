#include "contact_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <utility>

#include "linear_structure.hpp"

namespace ricochet::reference {
namespace {

Eigen::MatrixXd closed_rows(const LinearStructure& structure, const ContactSet& set, Signals& bounds,
                            std::vector<Watch>& closed) {
  for (std::size_t i = 0; i < set.size(); ++i)
    if (set[i] != 0) closed.push_back({static_cast<int>(i), set[i], true});
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(closed.size()), structure.dofs());
  bounds.resize(rows.rows(), structure.force.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Watch& watch = closed[static_cast<std::size_t>(i)];
    rows.row(i) = structure.contact.row(watch.point);
    bounds.row(i) = structure.bound(watch.sign).row(watch.point);
  }
  return rows;
}

/// Re(g e^{σt}) = ½ g e^{σt} + ½ ḡ e^{σ̄t}
Eigen::MatrixXcd two_sided(const Eigen::MatrixXcd& reader, const Signals& force) {
  Eigen::MatrixXcd result(reader.rows(), 2 * force.cols() - 1);
  result.col(0) = reader * force.col(0);
  for (Eigen::Index k = 1; k < force.cols(); ++k) {
    result.col(2 * k - 1) = 0.5 * (reader * force.col(k));
    result.col(2 * k) = 0.5 * (reader * force.col(k).conjugate());
  }
  return result;
}

/// Σ|σ|²·(size of the steady response of each watched function), resonant modes left out.
void finish_watches(const LinearStructure& structure, ContactModes& modes) {
  const Eigen::VectorXcd sigma = structure.sigma();
  const auto r = static_cast<Eigen::Index>(modes.oscillators.size());
  modes.watch_steady.setZero(modes.watch_place.rows());
  for (Eigen::Index k = 1; k < sigma.size(); ++k) {
    const double rate = std::abs(sigma[k]);
    Eigen::VectorXd steady = Eigen::VectorXd::Zero(modes.columns());
    for (Eigen::Index i = 0; i < r; ++i) {
      const LinearMode& mode = modes.oscillators[static_cast<std::size_t>(i)];
      if (!mode.resonates(sigma[k])) steady[i] = std::abs(modes.oscillator_force(i, k) / mode.detuning(sigma[k]));
    }
    for (Eigen::Index j = 0, column = r; j < modes.relaxation_force.rows(); ++j) {
      const Complex s = modes.relaxations[static_cast<std::size_t>(j)];
      const double size = std::abs(modes.relaxation_force(j, 2 * k - 1) / (sigma[k] - s)) +
                          std::abs(modes.relaxation_force(j, 2 * k) / (std::conj(sigma[k]) - s));
      for (int c = modes.single[static_cast<std::size_t>(j)] ? 1 : 2; c > 0; --c) steady[column++] = size;
    }
    modes.watch_steady += rate * rate *
                          (modes.watch_signal.col(k).cwiseAbs() + modes.watch_place.cwiseAbs() * steady +
                           rate * modes.watch_rate.cwiseAbs() * steady);
  }
}

class Builder {
 public:
  Builder(const LinearStructure& structure, const ContactSet& set) : at_(structure) {
    rows_ = closed_rows(structure, set, bounds_, closed_);
    set_ = &set;
  }

  ContactModes rigid() {
    const Eigen::MatrixXd lift = static_lift();
    modes_.offset = lift * bounds_;
    separate(pencil(at_, at_.stiffness, rows_), at_.force - pull(modes_.offset));
    watch_gaps();
    watch_forces(lift);
    return std::move(modes_);
  }

  /// Springs without stiffness-proportional damping, or no spring touched.
  ContactModes springs() {
    modes_.offset = Signals::Zero(at_.dofs(), at_.force.cols());
    separate(pencil(at_, supported(), Eigen::MatrixXd(0, at_.dofs())), pushed());
    watch_gaps();
    watch_depths();
    return std::move(modes_);
  }

  /// The springs do not damp as the structure does. With K' = K + κEᵀE, its modes, and y = (√λ q, z) of energy ½|y|²:
  ///
  ///     Λ^{−½} q'' + (α K̂ + η Λ^{−1}) y' + y = F̂,  K̂ = 1 − κ ÊᵀÊ,     that is     ξ = B ξ' + (F̂, 0),  ξ = (y, q')
  ///
  /// B, and not its inverse, so that slow motions keep their digits beside a stiff spring.
  ContactModes damped_springs() {
    const Pencil modes = pencil(at_, supported(), Eigen::MatrixXd(0, at_.dofs()));
    const Eigen::Index r = modes.shapes.cols(), k = modes.massless.cols(), size = 2 * r + k;
    const Eigen::VectorXd unit = modes.squares.cwiseSqrt();
    Eigen::MatrixXd shapes(at_.dofs(), r + k);
    shapes << modes.shapes * unit.cwiseInverse().asDiagonal(), modes.massless;
    const Eigen::MatrixXd touch = rows_ * shapes;
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(size, size);
    B.topLeftCorner(r + k, r + k) =
        at_.alpha * (at_.spring * touch.transpose() * touch - Eigen::MatrixXd::Identity(r + k, r + k));
    B.diagonal().head(r) -= at_.eta * modes.squares.cwiseInverse();
    B.topRightCorner(r, r).diagonal() = -unit.cwiseInverse();
    B.bottomLeftCorner(r, r).diagonal() = unit.cwiseInverse();

    const GeneralModes eigen = general_modes(B);
    const Eigen::MatrixXcd& vectors = eigen.vectors;
    const Eigen::MatrixXcd back = inverse(vectors);
    const Eigen::MatrixXcd displacement = shapes * vectors.topRows(r + k);
    const Eigen::MatrixXd placed =
        (Eigen::MatrixXd(r + k, at_.dofs()) << unit.asDiagonal() * (modes.shapes.transpose() * at_.mass),
         modes.massless.transpose() * supported())
            .finished();
    const Signals force = shapes.transpose() * pushed();
    modes_.offset = Signals::Zero(at_.dofs(), at_.force.cols());
    modes_.oscillator_force.resize(0, at_.force.cols());
    modes_.oscillator_reader.resize(0, at_.dofs());
    std::vector<Eigen::VectorXd> columns;
    std::vector<Eigen::Index> kept;
    for (Eigen::Index j = 0; j < size; ++j) {
      if (eigen.values[j].imag() > 0) continue;
      kept.push_back(j);
      Complex s = 1.0 / eigen.values[j];
      // Nothing here grows; the fastest rates are round-off.
      if (s.real() > 0) s = {-s.real(), s.imag()};
      modes_.relaxations.push_back(s);
      modes_.single.push_back(s.imag() == 0);
      if (modes_.single.back()) {
        columns.emplace_back(displacement.col(j).real());
      } else {
        columns.emplace_back(2 * displacement.col(j).real());
        columns.emplace_back(-2 * displacement.col(j).imag());
      }
    }
    const auto count = static_cast<Eigen::Index>(kept.size());
    Eigen::MatrixXcd reader(count, size), answer(count, r + k);
    for (Eigen::Index j = 0; j < count; ++j) {
      reader.row(j) = back.row(kept[static_cast<std::size_t>(j)]);
      answer.row(j) = -modes_.relaxations[static_cast<std::size_t>(j)] * reader.row(j).head(r + k);
    }
    modes_.place_reader = reader.leftCols(r + k) * placed;
    modes_.rate_reader = reader.rightCols(r) * (modes.shapes.transpose() * at_.mass);
    modes_.relaxation_force = two_sided(answer, force);
    modes_.shapes.resize(at_.dofs(), static_cast<Eigen::Index>(columns.size()));
    for (Eigen::Index j = 0; j < modes_.shapes.cols(); ++j) modes_.shapes.col(j) = columns[static_cast<std::size_t>(j)];
    finish_rates();
    watch_gaps();
    watch_depths();
    return std::move(modes_);
  }

 private:
  /// G = K⁻¹Eᵀ(E K⁻¹ Eᵀ)⁻¹: E G = 1, and K G lies in the rows of E.
  Eigen::MatrixXd static_lift() const {
    const auto S = at_.scale.asDiagonal();
    if (rows_.rows() == 0) return Eigen::MatrixXd(at_.dofs(), 0);
    const Eigen::MatrixXd K = S * (at_.stiffness + at_.shift * at_.mass) * S, across = (rows_ * S).transpose();
    const Eigen::MatrixXd bent = definite_solve(K, across);
    return S *
           (bent * definite_solve(across.transpose() * bent, Eigen::MatrixXd::Identity(rows_.rows(), rows_.rows())));
  }

  /// M D'' + C D' + K D
  Signals pull(const Signals& D) const {
    const Signals rate = at_.rate(D);
    return at_.mass * at_.rate(rate) + at_.damping() * rate + at_.stiffness * D;
  }
  /// K + κEᵀE
  Eigen::MatrixXd supported() const { return at_.stiffness + at_.spring * rows_.transpose() * rows_; }
  Signals pushed() const {
    Signals force = at_.force;
    if (rows_.rows() > 0) force += at_.spring * rows_.transpose() * bounds_;
    return force;
  }

  void separate(const Pencil& modes, const Signals& force) {
    const Eigen::Index r = modes.shapes.cols(), k = modes.massless.cols();
    for (Eigen::Index i = 0; i < r; ++i)
      modes_.oscillators.emplace_back((at_.alpha * modes.squares[i] + at_.eta) / 2, modes.squares[i]);
    modes_.oscillator_force = modes.shapes.transpose() * force;
    modes_.oscillator_reader = modes.shapes.transpose() * at_.mass;
    massless_force_ = modes.massless.transpose() * force;
    massless_ = modes.massless;
    const bool relaxes = at_.alpha > 0 && k > 0;
    modes_.shapes.resize(at_.dofs(), r + (relaxes ? k : 0));
    modes_.shapes.leftCols(r) = modes.shapes;
    modes_.place_reader.resize(0, at_.dofs());
    modes_.rate_reader.resize(0, at_.dofs());
    modes_.relaxation_force.resize(0, 2 * force.cols() - 1);
    if (relaxes) {
      modes_.shapes.rightCols(k) = modes.massless;
      modes_.relaxations.assign(static_cast<std::size_t>(k), -1 / at_.alpha);
      modes_.single.assign(static_cast<std::size_t>(k), true);
      modes_.place_reader = (modes.massless.transpose() * at_.stiffness).cast<Complex>();
      modes_.rate_reader = Eigen::MatrixXcd::Zero(k, at_.dofs());
      modes_.relaxation_force = two_sided(modes.massless.transpose() / at_.alpha, force);
    } else if (k > 0) {
      modes_.offset += modes.massless * massless_force_;
    }
    finish_rates();
  }

  void finish_rates() {
    std::vector<double> rates;
    for (const LinearMode& mode : modes_.oscillators) rates.push_back(mode.pulsation());
    for (std::size_t j = 0; j < modes_.relaxations.size(); ++j)
      rates.insert(rates.end(), modes_.single[j] ? 1 : 2, std::abs(modes_.relaxations[j]));
    modes_.rates = Eigen::Map<const Eigen::VectorXd>(rates.data(), static_cast<Eigen::Index>(rates.size()));
  }

  void watch(const Watch& what, const Eigen::RowVectorXd& place, const Eigen::RowVectorXd& rate,
             const Eigen::RowVectorXcd& signal) {
    const auto count = static_cast<Eigen::Index>(modes_.watches.size());
    modes_.watches.push_back(what);
    modes_.watch_place.conservativeResize(count + 1, modes_.columns());
    modes_.watch_rate.conservativeResize(count + 1, modes_.columns());
    modes_.watch_signal.conservativeResize(count + 1, at_.force.cols());
    modes_.watch_place.row(count) = place;
    modes_.watch_rate.row(count) = rate;
    modes_.watch_signal.row(count) = signal;
  }

  /// sign·(H w − bound), at `point`: the gap where it is open, minus the depth of a spring.
  void watch_distance(const Watch& what, double factor) {
    const Eigen::RowVectorXd row = factor * at_.contact.row(what.point);
    watch(what, row * modes_.shapes, Eigen::RowVectorXd::Zero(modes_.columns()),
          row * modes_.offset - factor * at_.bound(what.sign).row(what.point));
  }
  void watch_gaps() {
    modes_.watch_place.resize(0, modes_.columns());
    modes_.watch_rate.resize(0, modes_.columns());
    modes_.watch_signal.resize(0, at_.force.cols());
    for (std::size_t i = 0; i < set_->size(); ++i)
      for (const int sign : {1, -1}) {
        const auto point = static_cast<Eigen::Index>(i);
        if ((*set_)[i] != 0 || !std::isfinite(at_.bound(sign)(point, 0).real())) continue;
        watch_distance({static_cast<int>(i), sign, false}, sign);
      }
  }
  void watch_depths() {
    for (const Watch& spring : closed_) watch_distance(spring, -spring.sign);
  }

  /// p = Gᵀ(M w'' + C w' + K w − F), where w'' is known from the modes: p = a(q + αq') + signals.
  void watch_forces(const Eigen::MatrixXd& lift) {
    if (closed_.empty()) return;
    const auto r = static_cast<Eigen::Index>(modes_.oscillators.size());
    const Eigen::MatrixXd X = modes_.shapes.leftCols(r);
    const Eigen::MatrixXd heavy = lift.transpose() * at_.mass * X, stiff = lift.transpose() * at_.stiffness;
    Eigen::VectorXd squares(r);
    for (Eigen::Index i = 0; i < r; ++i) squares[i] = modes_.oscillators[static_cast<std::size_t>(i)].square();
    Eigen::MatrixXd place = Eigen::MatrixXd::Zero(lift.cols(), modes_.columns());
    place.leftCols(r) = stiff * X - heavy * squares.asDiagonal();
    Signals signal = heavy * modes_.oscillator_force + lift.transpose() * (pull(modes_.offset) - at_.force);
    if (at_.alpha > 0 && massless_.cols() > 0) signal += (stiff * massless_) * massless_force_;
    for (std::size_t i = 0; i < closed_.size(); ++i) {
      const double sign = closed_[i].sign;
      const auto row = static_cast<Eigen::Index>(i);
      watch(closed_[i], sign * place.row(row), sign * at_.alpha * place.row(row), sign * signal.row(row));
    }
  }

  const LinearStructure& at_;
  const ContactSet* set_ = nullptr;
  Eigen::MatrixXd rows_;  // E
  Signals bounds_;
  std::vector<Watch> closed_;
  Eigen::MatrixXd massless_;
  Signals massless_force_;
  ContactModes modes_;
};

}  // namespace

ContactModes contact_modes(const LinearStructure& structure, const ContactSet& set) {
  const bool touched = std::any_of(set.begin(), set.end(), [](signed char sign) { return sign != 0; });
  Builder builder(structure, set);
  ContactModes modes = structure.spring == 0            ? builder.rigid()
                       : touched && structure.alpha > 0 ? builder.damped_springs()
                                                        : builder.springs();
  finish_watches(structure, modes);
  return modes;
}

namespace {

// Columns of a small dense W.
class DenseColumns final : public DelassusColumns {
 public:
  explicit DenseColumns(Eigen::MatrixXd W) : W_(std::move(W)) {}
  const double* column(int j) override { return W_.col(j).data(); }

 private:
  Eigen::MatrixXd W_;
};

}  // namespace

ContactSet box_set(const Eigen::MatrixXd& W, double compliance, const Eigen::VectorXd& y, const Eigen::VectorXd& lower,
                   const Eigen::VectorXd& upper) {
  DenseColumns columns(W);
  Eigen::VectorXd p = Eigen::VectorXd::Zero(y.size());
  BoxSolver solver;
  solver.prepare(static_cast<int>(y.size()));
  const auto outcome =
      solver.solve(columns, 1, compliance, y.data(), lower.data(), upper.data(), p.data(), static_cast<int>(y.size()));
  if (!outcome.converged) throw Stopped{"the complementarity problem of the contact points was not solved"};
  ContactSet set;
  for (const double effort : p) set.push_back(effort > 0 ? 1 : (effort < 0 ? -1 : 0));
  return set;
}

ContactPoints::ContactPoints(const LinearStructure& structure, const ContactModes& open) {
  const auto oscillators = static_cast<Eigen::Index>(open.oscillators.size());
  const Pencil modes = pencil(structure, structure.stiffness, Eigen::MatrixXd(0, structure.dofs()));
  reach = structure.contact * modes.massless;
  moving = structure.contact * open.shapes.leftCols(oscillators);
  kernel = modes.massless.cols();

  const Eigen::Index m = structure.points();
  const bool rigid = structure.spring == 0;
  if (m == 0) return;
  const auto S = structure.scale.asDiagonal();
  const Eigen::MatrixXd K = S * (structure.stiffness + structure.shift * structure.mass) * S,
                        across = (structure.contact * S).transpose();
  const Eigen::MatrixXd soft = across.transpose() * definite_solve(K, across);
  const Eigen::VectorXd unit = soft.diagonal().cwiseSqrt().cwiseInverse();
  const auto smallest = [&](const Eigen::MatrixXd& W) {
    return symmetric_modes(unit.asDiagonal() * W * unit.asDiagonal(), EigenVectors::none).values[0];
  };
  if (rigid && smallest(soft) < 1e-12)
    throw Stopped{"two contact points coincide, and rigid stops share their force in no unique way: keep one"};
  massless = smallest(reach * reach.transpose()) > 1e-9 * smallest(soft);
  if (!rigid || massless) return;
  if (m > 1)
    throw Stopped{
        fmt::format("{} contact points with inertia and rigid stops: simultaneous impacts have no unique law. Use a "
                    "singular mass whose kernel carries the contact, a compliant law, or stops at the tip alone",
                    m)};
  if (reach.squaredNorm() > 1e-9 * soft(0, 0))
    throw Stopped{"the contact point has no inertia of its own but the massless part does not carry it alone"};
}

}  // namespace ricochet::reference
