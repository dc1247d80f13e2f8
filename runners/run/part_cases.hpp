#pragma once
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "runners/study/study.hpp"
#include "runners/study/study_part.hpp"

namespace ricochet {

/// A part that cannot be run as it was asked for; the message is complete.
class PartRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws PartRefused where the study has fewer cases to run than parts: a case is not split.
void check_part(const Study& study, const StudyPart& part);

/// The cases of one part, in the study's order: all of the study are sorted by what they are predicted to cost, the
/// dearest first, and dealt like cards, so that the parts are disjoint, hold every case, and cost about the same.
/// `seconds`: the predictions by case id, as plans make them; of one that is missing, 0. Three digits of them count,
/// and excluded cases come last: every machine deals alike. Equals stand by their ids, which are hashes: in the study's
/// order a part would have one method alone wherever the number of parts is a multiple of theirs.
std::vector<const StudyCase*> cases_of_part(const Study& study, const StudyPart& part,
                                            const std::map<std::string, double>& seconds);

}  // namespace ricochet
