#pragma once
#include <limits>
#include <optional>
#include <ricochet/measure/orbits/multipliers.hpp>
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <string>

namespace ricochet {

/// Arclength, of that of the range, within which bounds count as met at once.
inline constexpr double met_at_once = 1e-12;

/// A change of a contact set: in which step, of which row of v.
struct SetChange {
  long long step = -1;
  int row = -1;
  bool closes = false;  ///< the point; else it opens
  bool upper = false;   ///< which stop
};

/// Where a branch stands: at the beginning of a piece, or of a step along it.
struct BranchState {
  Eigen::VectorXd x;
  double parameter = 0;
  SetSequence sets;
  Eigen::VectorXd along;       ///< dx/ds, s the arclength
  double parameter_along = 0;  ///< dλ/ds
  SetChange change;            ///< what ended the piece before; none at first
  double arc = 0;              ///< m
  long long pieces = 0;
  double step = 0;      ///< of a branch that goes by steps, m
  int orientation = 0;  ///< of such a branch: the sign of the determinant of its bordered matrix
};

/// Why following stopped.
enum class BranchEnd { none, range, mark, unresolved };

/// What one piece came to.
struct Piece {
  BranchEnd end = BranchEnd::none;
  double length = 0;    ///< m
  double residual = 0;  ///< |P(x) − x| at its beginning, by the affine steps, m
  SetChange change;     ///< what ended it
  bool tie = false;     ///< another bound is met there as well, to 1e-12 of the range
  std::string why;      ///< of an unresolved one
};

/// An orbit (of shoot()), and the way: +1 towards larger λ.
BranchState branch_start(Eigen::VectorXd x, double parameter, SetSequence sets, int way);

/// Follows a branch of −P½(x, λ) = x or P^p(x, λ) = x, P piecewise affine and continuous, piece by piece. On a piece
/// the contact sets stay and the branch is a line, x + s t with [P' − 1, P_λ] t = 0. The piece ends at the least s > 0
/// at which an effort or the distance to a bound vanishes; there the point changes its set in that step, and the new
/// line leaves so that the new margin grows. No step size, no tolerance: any fold is passed. Bounds that are met at
/// once change one after the other, the earlier step and the lower row first, on pieces of no length between them.
class PieceFollower {
 public:
  /// From an orbit (branch_start()), or from the entry of another follower: both then go on alike, bit for bit.
  /// `round_off`: that of the map, m.
  PieceFollower(PeriodicMap& map, const MapClock& clock, BranchState entry, double round_off);

  /// Where the piece under way was entered, with the direction before it.
  const BranchState& entry() const { return entry_; }
  const BranchState& state() const { return state_; }
  /// ∂(sign·P)/∂x on the piece under way.
  const Eigen::MatrixXd& derivative() const { return derivative_; }
  /// Rows of v along the piece under way: values at its beginning, slopes per arclength.
  const PeriodicMap::Measures& measures() const { return measures_; }

  /// Where the piece under way ends, without going there.
  Piece end_of_piece(double least, double largest);
  /// Goes to its end: changes the set, or stays on it where a limit ended it.
  void go(const Piece& piece);
  /// The state a way s along the piece.
  BranchState at(double s) const;

 private:
  void enter();
  void new_direction();
  void sweep();

  PeriodicMap* map_;
  MapClock clock_;
  BranchState entry_, state_;
  Eigen::MatrixXd derivative_;
  Eigen::VectorXd by_parameter_;
  DenseLu bordered_;
  PeriodicMap::Measures measures_;
  double residual_ = 0, round_off_;
};

}  // namespace ricochet
