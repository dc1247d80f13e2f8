#pragma once
#include <array>
#include <cstdint>
#include <ricochet/engine/compile.hpp>
#include <ricochet/kernels/block.hpp>
#include <vector>

namespace ricochet {

/// A tangent of a point as rows that rub: Σ share_k times row `row + k`. One of a single row is that row.
struct Tangent {
  int row = 0, count = 1;
  std::array<double, 3> share{1, 0, 0};

  /// Of rows at `values`, `stride` apart.
  double of(const double* values, std::ptrdiff_t stride = 1) const {
    if (count == 1) return values[0];
    double sum = share[0] * values[0];
    for (int k = 1; k < count; ++k) sum += share[static_cast<std::size_t>(k)] * values[k * stride];
    return sum;
  }
  /// The effort along it of efforts of its rows.
  double effort(const double* efforts, std::ptrdiff_t stride = 1) const;
};

/// Tangent 0 or 1 of a point, of a round one for its direction n.
Tangent tangent_of(const RubbingPoint& one, int number, const std::array<double, 2>& normal);

/// By how much friction found something else than what the normal efforts were found with, N: the largest of rows, the
/// largest effort or bound, and the sums of the secant.
struct FrictionChange {
  double most = 0, largest = 0, down = 0, along = 0;
};

/// What friction found in the last stage that looked at contact, and the workspace of finding it. Allocates when
/// constructed only.
struct StageFriction {
  explicit StageFriction(const Program& program);

  /// Of the points that are pressed, only the first ones stay.
  void keep_first(std::size_t points);
  FrictionChange change() const;
  /// The normal efforts are to be found with what friction found, less `back` times its change of the last turn.
  void give(double back);
  /// What was found of a lane, as its state; or nothing.
  void keep(int lane);
  void forget(int lane);

  Block normal;                  ///< |N|, N, by rubbing point and lane; 0: nothing presses
  Block sticks;                  ///< 1: held; part of a lane's state
  Block kept;                    ///< what the law keeps of each row, row by row; part of a lane's state
  Block slid;                    ///< how fast it slides, m/s; 0 where it sticks
  Block along;                   ///< n₁ and n₂ of each point that is round and pressed
  std::vector<double> residual;  ///< per lane, over the largest effort
  std::vector<int> turns;        ///< per lane: how often the normal efforts were found
  int per_row = 0;               ///< numbers that the law keeps of a row
  bool moves = false;            ///< whether a surface does, or a support of one
  std::uint32_t always = 0;      ///< lanes in which a damper acts

  // Of the lane that is being solved, by row or by point.
  std::vector<Tangent> tangents;  ///< of points that are pressed
  std::vector<int> kept_at;       ///< row of `kept` of each
  std::vector<int> first_row, number;
  std::vector<std::array<double, 2>> directions;
  std::vector<double> matrix, free, normals, sliding, held, effort, slides;
  std::vector<double> remembered, remembers;
  std::vector<unsigned char> holds;
  // Of all rows: what the normal efforts were found with, what friction found then, and the same of the turn before.
  std::vector<double> given, found, found_before, off_before;
  std::vector<double> measured, rate, memory;  ///< of the law before friction
  std::vector<double> moved;                   ///< what efforts of friction move each measure by, over c
};

}  // namespace ricochet
