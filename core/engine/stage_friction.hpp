#pragma once
#include <cstdint>
#include <ricochet/engine/compile.hpp>
#include <ricochet/kernels/block.hpp>
#include <vector>

namespace ricochet {

/// What friction found in the last stage that looked at contact, and the workspace of finding it. Allocates when
/// constructed only.
struct StageFriction {
  explicit StageFriction(const Program& program);

  Block normal;                  ///< |N|, N, by rubbing point and lane; 0: nothing presses
  Block sticks;                  ///< 1: held; part of a lane's state
  Block kept;                    ///< what the law keeps of each row, row by row; part of a lane's state
  Block slid;                    ///< how fast it slides, m/s; 0 where it sticks
  std::vector<double> residual;  ///< per lane, over the largest effort
  std::vector<int> turns;        ///< per lane: how often the normal efforts were found
  int per_row = 0;               ///< numbers that the law keeps of a row
  std::uint32_t always = 0;      ///< lanes in which a damper acts

  // Of the lane that is being solved, by row or by point.
  std::vector<int> rows, first_row, number;  ///< of points that are pressed
  std::vector<double> matrix, free, normals, sliding, held, effort, slides;
  std::vector<double> remembered, remembers;  ///< of the rows that are pressed
  std::vector<unsigned char> holds;
  // Of all rows: what the normal efforts were found with, what friction found then, and the same of the turn before.
  std::vector<double> given, found, found_before, off_before;
  std::vector<double> measured, rate, memory;  ///< of the law before friction
};

}  // namespace ricochet
