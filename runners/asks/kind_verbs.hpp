#pragma once
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "runners/asks/evidence.hpp"

/// \file
/// What verbs that kinds of study answer have in common.
namespace ricochet::asks {

/// The first of these sentences that has at most thirty words; the last where none has. The fullest stands first.
std::string fitting(const std::vector<std::string>& sentences);

/// An entry of `ask` whose verb stands at `pointer`, "/ask/0/order".
Ask ask_at(const Json& keys, const std::string& pointer);

/// StudyKind::check_measure of a kind whose cases have these measures alone.
std::function<void(const Json& resolved, const std::string& measure, const std::string& pointer)> measures_alone(
    const std::vector<MeasureInfo>& measures);

/// Why no orbit of this study that does not repeat is decided: too few kept periods for the 0–1 test, and no exponent;
/// "" where that is not so.
std::string too_short_to_judge(const Json& resolved);
/// Adds it to what warns.
void warn_too_short(Answered& out, const Json& resolved);

/// Refuses stops, of which such a verb does not speak.
void refuse_stops(const Ask& ask);

/// What is told of the cases of an ask that have no result, as Answered::aside: counted by how they ended
/// (ending_key()).
void leave_out(Answered& out, const Cases& left);
/// The same of those among `cases` of which nothing is told; what is told has its case as `record`.
template <class Told>
void leave_out(Answered& out, const Cases& cases, const std::vector<Told>& told) {
  std::set<const CaseRecord*> known;
  for (const Told& one : told) known.insert(one.record);
  Cases left;
  for (const CaseRecord* one : cases)
    if (!known.contains(one)) left.push_back(one);
  leave_out(out, left);
}

/// Of the orbits or cells of one case: how many there are, and by status those refused or not followed to the end.
struct Places {
  std::size_t all = 0;
  std::map<std::string, std::size_t> ended = {};
};

/// The verb `runs` where each case has many orbits, `name`: theirs count beside the cases.
Answered runs_of_places(const Ask& ask, const Evidence& evidence, const std::string& name,
                        const std::function<Places(const CaseRecord&)>& places);

}  // namespace ricochet::asks
