#pragma once
#include "runners/store/record.hpp"

/// \file
/// Time schemes side by side, by what studies measured of each.
namespace ricochet {

/// One row per time scheme, with those of its parameters that tell it from others of its name. A cell is the least and
/// the largest value over the cases of the first of these studies that measured it, and in brackets that study's name
/// less what all their names begin with; nothing where none has. An order counts where its 95 % interval is not wider
/// than 0.5; the cell says of how many cases it does, "not told" where of none. The studies have their derived tables.
Table league_table(const std::vector<StudyResults>& studies);

/// What the names of these studies begin with, up to a hyphen: "family-" of "family-free" and "family-beam".
std::string common_beginning(const std::vector<StudyResults>& studies);

/// A table in Markdown, columns with their units.
std::string markdown(const Table& table);

}  // namespace ricochet
