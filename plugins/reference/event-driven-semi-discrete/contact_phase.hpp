#pragma once
#include <vector>

#include "contact_modes.hpp"

/// \file
/// One phase of the semi-discrete motion: the modes of its contact set, entered from a state.
namespace ricochet::reference {

/// w and w' at a time.
struct State {
  double time = 0;
  Eigen::VectorXd place, rate;
};

/// The columns of a phase and their first two derivatives, and the signals' exponentials.
struct Columns {
  Eigen::VectorXd value, rate, curve;
  Eigen::VectorXcd phasors;                 ///< e^{σt}
  Eigen::VectorXcd turned, doubled_turned;  ///< e^{στ}; of both sides
  Eigen::VectorXcd answers;                 ///< of one relaxation to each of them
};

/// One thing that moves in a phase, apart from what forces impose: at most size·e^{−decay·τ} in its column.
struct Content {
  Eigen::Index column = 0;
  LinearMode::Content of;
};

class ContactPhase {
 public:
  ContactPhase(const LinearStructure& structure, const ContactModes& modes, const State& from);

  const ContactModes& modes() const { return *modes_; }
  double start() const { return start_; }
  /// The free motion of every column that is not in resonance with a force.
  const std::vector<Content>& contents() const { return contents_; }
  const std::vector<Eigen::Index>& resonant() const { return resonant_; }

  void read(double tau, Columns& at) const;

  State state(double tau) const;

  double watched(Eigen::Index row, const Columns& at) const;
  double watched_rate(Eigen::Index row, const Columns& at) const;
  /// Of a gap: its acceleration.
  double watched_curve(Eigen::Index row, const Columns& at) const;

 private:
  void split_oscillator(Eigen::Index i);
  void split_relaxation(Eigen::Index j, Eigen::Index& column);
  void read_oscillator(Eigen::Index i, double tau, Columns& at) const;

  void read_relaxations(double tau, Eigen::Index column, Columns& at) const;

  const LinearStructure* structure_;
  const ContactModes* modes_;
  double start_ = 0;
  Eigen::VectorXd place_, rate_;  // of the oscillators, at the start
  Eigen::VectorXcd relaxed_;
  Signals force_;  // as it is at the start
  Eigen::MatrixXcd relaxing_force_;
  Eigen::VectorXcd exponents_, doubled_exponents_;
  std::vector<Content> contents_;
  std::vector<Eigen::Index> resonant_;
};

}  // namespace ricochet::reference
