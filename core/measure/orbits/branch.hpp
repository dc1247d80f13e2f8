#pragma once
#include <complex>
#include <map>
#include <ricochet/measure/orbits/contact_runs.hpp>
#include <ricochet/measure/orbits/follow_pieces.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// What is read of the multipliers of a corner.
struct CornerRoots {
  Outside outside;
  double real = 0;     ///< the real one nearest −1; 0: there is none
  double modulus = 0;  ///< of the pair nearest the circle, angle in (0.01, π − 0.01); 0: none
  double angle = 0;    ///< of that pair
};
CornerRoots roots_at(const std::vector<std::complex<double>>& multipliers);

/// A corner of a branch: where a piece begins.
struct BranchCorner {
  double parameter = 0, arc = 0, tip = 0;
  int way = 0;                                ///< sign of dλ/ds on the piece
  int runs = 0;                               ///< runs of contact over the steps of the map
  int shortest = 0;                           ///< steps of the shortest of them; 0: there is none
  CornerRoots raw;                            ///< of the frozen step, all along the piece
  CornerRoots smooth;                         ///< by the half-step rule, at the corner
  std::vector<std::complex<double>> leading;  ///< raw, largest modulus first
  SetChange change;                           ///< that made it; none of the first corner
  double residual = 0;                        ///< m
};

/// Over all points, those of each stage on their own.
ContactRuns contact_runs(const SetSteps& sets, const SetSequence& sequence, bool half);

/// Whether the second half of the steps has the sets of the first one with the sides exchanged: an orbit that stands
/// alone with such sets is its own image under x → −x, t → t + T/2.
bool is_image(const SetSteps& sets, const SetSequence& sequence);
/// The divisor of its period after which a sequence repeats: an orbit alone with such sets does so too. 0: none.
int repeats_sooner(const SetSequence& sequence, int period);

/// An orbit that was solved exactly where it was asked for.
struct MarkedOrbit {
  double parameter = 0, arc = 0, tip = 0;
  long long corner = 0;  ///< of the piece that it is on
  Eigen::VectorXd x;
};

/// A branch as far as it was followed.
struct BranchTrace {
  std::vector<BranchCorner> corners;
  std::map<long long, Eigen::VectorXd> states;  ///< x at some corners: evenly spaced ones, turns and changes
  long long stride = 1;                         ///< of those that are evenly spaced
  std::vector<MarkedOrbit> marks;
  long long ties = 0;   ///< corners at which two bounds were met at once
  double rebounds = 0;  ///< largest u of orbits that give back speed, m (stepped_map.hpp); 0: none does
  std::string end;      ///< why it ended; "" while it goes on
  bool ended() const { return !end.empty(); }
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
