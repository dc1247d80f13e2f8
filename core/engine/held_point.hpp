#pragma once

namespace ricochet {

/// A contact point held at one of its stops.
struct HeldPoint {
  int point = 0;  ///< row of H
  bool lower = true;
  bool operator==(const HeldPoint&) const = default;
};

}  // namespace ricochet
