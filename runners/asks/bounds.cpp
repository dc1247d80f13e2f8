#include "runners/asks/bounds.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ricochet::asks {
namespace {

/// Whether nothing happened in runs that could not show it.
bool nothing_seen(const Point& point) {
  return untouched(point) && doubtful(point);
}

/// Whether no case has steps that resolve its contacts.
bool unresolved(const Point& point) {
  return !point.behind.empty() && std::all_of(point.behind.begin(), point.behind.end(), [](const CaseRecord* one) {
    return measure(*one, contact_steps_measure).value_or(fewest_contact_steps) < fewest_contact_steps;
  });
}

/// Whether a whole interval keeps to them.
bool keeps(const Bounds& bounds, double low, double high) {
  return bounds.holds(low) && bounds.holds(high);
}

/// Whether a whole interval lies beyond.
bool breaks(const Bounds& bounds, double low, double high) {
  return (bounds.below && low >= *bounds.below) || (bounds.above && high <= *bounds.above);
}

}  // namespace

Kept kept(const Line& line, const Bounds& bounds) {
  Kept out;
  // What nothing touches stays below any limit of what is told in contact.
  if (line.point.of_untouched_stop && bounds.below && !bounds.above && !doubtful(line.point))
    out.verdict = Verdict::yes;
  if (!line.known() || !line.estimate().has_interval() || unresolved(line.point)) return out;
  const Estimate& one = line.estimate();
  bool all = keeps(bounds, one.least(), one.most()), beyond = breaks(bounds, one.least(), one.most());
  const MeasureInfo* info = measure_info(line.measure + (line.stop.empty() ? "" : "[" + line.stop + "]"));
  const bool mean = !line.point.halves.empty() || (info && info->mean);
  if (const auto& draws = line.point.values.at(*line.point.finest); draws.size() > 1 && !mean) {
    const double refinement = one.left();
    out.draws = draws.size();
    for (const auto& [seed, value] : draws) {
      all = all && keeps(bounds, value - refinement, value + refinement);
      out.beyond += breaks(bounds, value - refinement, value + refinement) ? 1 : 0;
    }
    beyond = beyond || out.beyond > 0;
  }
  out.verdict = beyond ? Verdict::no : all && !nothing_seen(line.point) ? Verdict::yes : Verdict::open;
  return out;
}

std::string beyond_text(const Kept& one) {
  if (one.beyond == 0) return "";
  return fmt::format("{} of {} seeds {} beyond", one.beyond, one.draws, one.beyond == 1 ? "is" : "are");
}

std::string why_open(const Line& line, const Bounds& bounds) {
  if (!line.known()) return line.point.none;
  if (unresolved(line.point)) return "contact is not resolved by any step";
  if (nothing_seen(line.point)) return "no stop is touched, in a doubtful run";
  const Estimate& one = line.estimate();
  if (!one.unknown().empty()) return one.unknown();
  if (one.grows) return "it " + one.motion;
  const bool all = one.has_interval() && keeps(bounds, one.least(), one.most());
  const bool within = !breaks(bounds, one.low(), one.high()) && !keeps(bounds, one.low(), one.high());
  if (!all && (!within || one.disproved)) return "it " + one.unsettled();
  if (all) return "one seed is too near to it";
  return "the limit lies within its interval" + (one.few.empty() ? "" : ", and it " + one.few);
}

}  // namespace ricochet::asks
