#pragma once
#include <optional>
#include <ricochet/contract/contact_law.hpp>

namespace ricochet {

/// What a friction law sees of one lane of one stage. Bounds are given, efforts p (N) are asked. A point has one row,
/// or two that span its tangent plane; its rows stand together. Rates are against the surface, at the end of the stage:
///
///     u = u° + A p   (m/s),     |p_i|₂ ≤ s_i at point i                                                          (1)
///
/// A (rows × rows, m/s per N) is symmetric positive semidefinite. Two points at one place make it singular.
struct FrictionProblem {
  int points = 0;
  const int* first_row = nullptr;  ///< of each point, and behind the last one: points + 1 numbers
  const double* matrix = nullptr;  ///< A, row by row, `stride` apart
  int stride = 0;
  const double* free = nullptr;   ///< u°, by row
  const double* bound = nullptr;  ///< s ≥ 0 while it slides, N, by point
  const double* bound_static =
      nullptr;                         ///< s while it sticks, N: beyond `bound` only where it stuck in the stage before
  double h = 0;                        ///< what an effort of 1 N gives of momentum in the stage, s
  const double* remembered = nullptr;  ///< what the law kept of each row, memory_per_row() numbers a row; 0 at first
  double* remembers = nullptr;         ///< out: what it keeps now; forgotten where nothing presses
  double* effort = nullptr;            ///< in: a first guess; out: p, by row
  unsigned char* sticks = nullptr;     ///< out: of each point
  double* slid = nullptr;              ///< out: how fast it slides, m/s ≥ 0, of each point

  int rows() const { return first_row[points]; }
  double at(int row, int column) const { return matrix[static_cast<std::ptrdiff_t>(row) * stride + column]; }
};

/// Of FrictionLaw::memory_per_row().
inline constexpr int most_friction_memory = 8;

/// How the surfaces of stops rub: it knows neither the contact law nor the scheme. All lanes have
/// the parameters that it was made with. The loop calls prepare() before the first solve(). It calls solve() for each
/// lane with a bound, as often as the normal efforts of the stage have changed by what it found.
class FrictionLaw {
 public:
  virtual ~FrictionLaw() = default;
  /// Sizes workspaces: at most so many points and rows at once.
  virtual void prepare(int points, int rows) = 0;
  /// Finds p. No allocation here.
  virtual LaneOutcome solve(FrictionProblem& problem) = 0;
  /// How fast a point drifts that is held by this share of its bound, m/s; 0: it does not.
  virtual double creeps(double /*load_over_bound*/) const { return 0; }
  /// By how much a point gives way that is held, m per N; 0: it does not.
  virtual double gives_way() const { return 0; }
  /// Numbers that it keeps of each row from stage to stage, at most most_friction_memory; part of a lane's state.
  virtual int memory_per_row() const { return 0; }
  /// Energy that a row stores, J, by what is kept of it: what its force can still give back.
  virtual double stored(const double* /*remembered*/) const { return 0; }
  /// Whether schemes are refused under which the efforts of a held point never settle.
  virtual bool must_settle() const { return true; }
};

}  // namespace ricochet
