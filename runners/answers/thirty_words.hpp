#pragma once
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Sentences of at most thirty words.
namespace ricochet::answers {

std::ptrdiff_t words_in(const std::string& sentence);
/// Whether a sentence has at most thirty words.
bool fits(const std::string& sentence);

/// What must be said, and of the rest as much as thirty words hold. Each part begins with its own mark, "; …"; of its
/// wordings the first that fits is taken.
std::string in_thirty_words(std::string must, const std::vector<std::vector<std::string>>& rest);

/// What must be said with its reason, "MUST: REASON.". A reason that is too long loses what stands in brackets, then
/// its last clauses; its first clause stays. `ending` is said behind a reason that has numbers: ", in the first of
/// them".
std::string with_reason(const std::string& must, const std::string& reason, const std::string& ending = "");

}  // namespace ricochet::answers
