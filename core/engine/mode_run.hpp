#pragma once
#include <ricochet/engine/marcher.hpp>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/lane_kernels.hpp>

namespace ricochet {

/// What a kernel works with that makes many steps of modes at once, up to the next check.
struct ModeRunBlocks {
  ModeRun kernel;
  Block scale, offset;  ///< (steps + 1) × T
  Block column;         ///< of z, of an effort of 1 N; not read until something pushes

  ModeRunBlocks(int rows, int width)
      : scale(static_cast<int>(Marcher::check_interval) + 1, width),
        offset(static_cast<int>(Marcher::check_interval) + 1, width),
        column((rows + 7) / 8 * 8, 1) {}
};

}  // namespace ricochet
