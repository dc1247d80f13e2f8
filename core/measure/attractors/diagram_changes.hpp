#pragma once
#include <string>
#include <vector>

namespace ricochet {

/// A change of the motion along the parameter, as one case located it.
struct DiagramChange {
  std::string start, from, to, kind;    ///< the start that met it, the classes before and after it
  double value = 0, low = 0, high = 0;  ///< of the parameter
  /// Whether it may be the same change, seen by another case.
  bool like(const DiagramChange& other) const {
    return start == other.start && from == other.from && to == other.to && kind == other.kind;
  }
};

/// What each change of a reference became in another case: its index there, −1 where none like it is left within
/// `reach`. The nearest pairs come first; each change is taken once.
std::vector<int> match_changes(const std::vector<DiagramChange>& reference, const std::vector<DiagramChange>& here,
                               double reach);

}  // namespace ricochet
