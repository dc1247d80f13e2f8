#pragma once
#include <array>
#include <ricochet/contract/worded.hpp>

namespace ricochet {

/// What is special about a point of a branch. A change of contact is a first contact where no contact is on one side,
/// and a lift-off where one opens that never did; tables of cases call all three `contact`.
enum class PointKind : unsigned char { fold, torus, symmetry, flip, first_contact, lift_off, contact, mark, end };

constexpr std::array<const char*, 9> words_of(PointKind) {
  return {"fold", "torus", "symmetry", "flip", "first contact", "lift-off", "contact", "mark", "end"};
}

/// Whether the orbit changes there: neither at a mark of the user nor where the branch ends.
constexpr bool changes_orbit(PointKind kind) {
  return kind < PointKind::mark;
}

/// LP, TR, BP, PD, GR, UZ, EP, most of them the labels of AUTO (Doedel, 1981).
constexpr const char* label(PointKind kind) {
  constexpr std::array labels = {"LP", "TR", "BP", "PD", "GR", "GR", "GR", "UZ", "EP"};
  return labels[static_cast<std::size_t>(kind)];
}

}  // namespace ricochet
