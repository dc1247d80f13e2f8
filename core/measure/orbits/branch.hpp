#pragma once
#include <algorithm>
#include <array>
#include <complex>
#include <limits>
#include <map>
#include <optional>
#include <ricochet/contract/worded.hpp>
#include <ricochet/measure/orbits/multipliers.hpp>
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {

/// Runs of steps in which a point is closed by one stop, over the steps of a map, round its end.
struct ContactRuns {
  int count = 0, shortest = 0;
  int held = 0;  ///< of the count: those of points that are closed all the time
  /// `all`: steps after which a motion repeats.
  void add(long long length, long long all) {
    ++count;
    held += length >= all;
    shortest = shortest == 0 ? static_cast<int>(length) : std::min(shortest, static_cast<int>(length));
  }
};

/// Calls run(begin, length) for each run of one point over n steps: side(k) in step k, 0 open, −1 or 1 closed. Before
/// the first step stand those of the last one, of a half map with the sides exchanged; a run may go beyond n.
template <class Side, class Run>
void each_run(long long n, bool half, const Side& side, const Run& run) {
  const int turned = half ? -1 : 1;
  const auto at = [&](long long k) { return k < 0 ? turned * side(k + n) : k < n ? side(k) : turned * side(k - n); };
  bool any = false;
  for (long long k = 0; k < n; ++k) {
    if (side(k) == 0 || side(k) == at(k - 1)) continue;
    long long end = k + 1;
    while (end < k + n && at(end) == side(k)) ++end;
    run(k, end - k);
    any = true;
    k = std::min(end, n) - 1;
  }
  if (!any && n > 0 && side(0) != 0) run(0, n);  // closed all the time
}

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
  int begins = 0;       ///< of such a branch: where x stands in the period (MapClock)
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

/// Pieces between which the derivative is made of that of the piece before; then it is made of its steps again.
inline constexpr long long pieces_updated = 64;

/// Follows a branch of −P½(x, λ) = x or P^p(x, λ) = x, P piecewise affine and continuous, piece by piece. On a piece
/// the contact sets stay and the branch is a line, x + s t with [P' − 1, P_λ] t = 0. The piece ends at the least s > 0
/// at which an effort or the distance to a bound vanishes. There the point changes its set in that step, and the new
/// line leaves so that the new margin grows. No step size, no tolerance: any fold is passed. Bounds that are met at
/// once change one after the other, the earlier step and the lower row first. The pieces between them have no length.
class PieceFollower {
 public:
  /// From an orbit (branch_start()), or from the entry of another follower. Where that has made a multiple of
  /// `pieces_updated`, both go on alike, bit for bit.
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

/// What is read of the multipliers of a corner.
struct CornerRoots {
  Outside outside;
  double real = 0;     ///< the real one nearest −1; 0: there is none
  double modulus = 0;  ///< of the pair nearest the circle, angle in (0.01, π − 0.01); 0: none
  double angle = 0;    ///< of that pair
  double product = 1;  ///< ∏ (1 + μ): 0 where a real one is −1
};
CornerRoots roots_at(const std::vector<std::complex<double>>& multipliers);

/// A corner of a branch: where a piece begins.
struct BranchCorner {
  double parameter = 0, arc = 0, tip = 0;
  int way = 0;                                ///< sign of dλ/ds on the piece
  int runs = 0;                               ///< runs of contact over the steps of the map
  int held = 0;                               ///< of them, those that never end
  int shortest = 0;                           ///< steps of the shortest of them; 0: there is none
  CornerRoots raw;                            ///< of the frozen step, all along the piece
  CornerRoots smooth;                         ///< by the half-step rule, at the corner
  std::vector<std::complex<double>> leading;  ///< raw, largest modulus first
  SetChange change;                           ///< that made it; none of the first corner
  double residual = 0;                        ///< m
  double rebounds = 0;                        ///< u where stops give back speed (stepped_map.hpp), m
  double placed = 0;                          ///< what is left of u where impacts are placed (stepped_map.hpp), m
  double slowest = 0;                         ///< of its rebounds, m/s (stepped_map.hpp)
};

/// Over all points, those of each stage on their own.
ContactRuns contact_runs(const SetSteps& sets, const SetSequence& sequence, bool half);

/// Whether the second half of the steps has the sets of the first one with the sides exchanged. An orbit that stands
/// alone with such sets is its own image under x → −x, t → t + T/2.
bool is_image(const SetSteps& sets, const SetSequence& sequence);
/// The divisor of its period after which a sequence repeats: an orbit alone with such sets does so too. 0: none.
int repeats_sooner(const SetSequence& sequence, int period);

/// An orbit that was solved exactly where it was asked for.
struct MarkedOrbit {
  double parameter = 0, arc = 0, tip = 0;
  long long corner = 0;  ///< of the piece that it is on
  Eigen::VectorXd x;
  /// Its multipliers, the largest first, where they are not those of the corner.
  std::vector<std::complex<double>> leading = {};
  Outside outside = {};
};

/// How a branch ended: at an end of the range, at its first orbit, where it becomes part of another branch, at a point
/// at which the study stops, at a limit of the study, or where it could not be followed; `missing`: it has no first
/// orbit.
enum class TraceEnd { none, range, closed, joined, asked, limit, left, missing };
constexpr std::array<const char*, 8> words_of(TraceEnd) {
  return {"", "range", "closed", "joined", "asked", "limit", "left", "missing"};
}

/// A branch as far as it was followed.
struct BranchTrace {
  std::vector<BranchCorner> corners;
  std::map<long long, Eigen::VectorXd> states;  ///< x at some corners: evenly spaced ones, turns and changes
  long long stride = 1;                         ///< of those that are evenly spaced
  std::vector<MarkedOrbit> marks;
  long long ties = 0;   ///< corners at which two bounds were met at once
  double rebounds = 0;  ///< largest u of orbits that give back speed, m (stepped_map.hpp); 0: none does
  TraceEnd ends = TraceEnd::none;
  std::string end;  ///< why it ended; "" while it goes on
  bool ended() const { return ends != TraceEnd::none; }
  void end_by(TraceEnd how, std::string why) {
    ends = how;
    end = std::move(why);
  }
  void end_at_repeat(int sooner, double parameter);
  void end_at_image(double parameter);
  void end_at_arc(double longest);
  /// Whether an impact of the last orbit has 1 % of the fastest approach of the branch, or less.
  bool grazes() const;
};

/// Where a branch ends at the latest, and what is looked for on it.
struct BranchLimits {
  double least = 0, largest = 0;  ///< λ
  long long pieces = 200000;
  double arc = 1;  ///< m
  std::vector<double> marks = {};
  int multipliers = 4;
  bool ends_at_image = false;      ///< of orbits that are not their own images: whether it ends where they become so
  bool ends_sooner = false;        ///< of orbits of several periods: whether it ends where they repeat sooner
  std::size_t most_states = 2000;  ///< evenly spaced ones

  /// The multipliers that are kept of an orbit.
  std::vector<std::complex<double>> leading(std::vector<std::complex<double>> all) const {
    all.resize(std::min(all.size(), static_cast<std::size_t>(multipliers)));
    return all;
  }
};

/// Follows one branch of a piecewise affine map, with what is read at each corner.
class BranchRun {
 public:
  BranchRun(PeriodicMap& map, const MapClock& clock, PieceFollower follower, BranchLimits limits);
  /// From where another one stopped: its trace, and a follower from its state.
  BranchRun(PeriodicMap& map, const MapClock& clock, PieceFollower follower, BranchLimits limits, BranchTrace trace,
            SetSequence first_sets);

  /// Goes through up to so many pieces; false where the branch has ended.
  bool advance(long long pieces);
  const BranchTrace& trace() const { return trace_; }
  const BranchState& state() const { return follower_.state(); }
  const BranchState& entry() const { return follower_.entry(); }
  long long pieces() const { return follower_.state().pieces; }
  const SetSequence& first_sets() const { return first_; }
  const MapClock& clock() const { return clock_; }

 private:
  void read();
  void keep(bool special);
  void finish(const Piece& piece);

  PeriodicMap* map_;
  MapClock clock_;
  PieceFollower follower_;
  BranchLimits limits_;
  BranchTrace trace_;
  SetSequence first_;
  int standing_ = 0;  // pieces without length in a row
};

}  // namespace ricochet
