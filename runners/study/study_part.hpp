#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace ricochet {

/// One of the parts into which the cases of a study are dealt, each for a run of its own; 0 of 0: all of the study.
struct StudyPart {
  int number = 0, of = 0;

  bool whole() const { return of == 0; }
  /// "part 3 of 64", "the whole study".
  std::string text() const;
  bool operator==(const StudyPart&) const = default;
};

/// Reads "3/64"; nothing where the text is not K/N with 1 ≤ K ≤ N.
std::optional<StudyPart> part_from(std::string_view text);

}  // namespace ricochet
