#pragma once

namespace ricochet {

/// A contact point closed at one of its stops.
struct ClosedPoint {
  int point = 0;  ///< row of H
  bool lower = true;
  bool operator==(const ClosedPoint&) const = default;
};

}  // namespace ricochet
