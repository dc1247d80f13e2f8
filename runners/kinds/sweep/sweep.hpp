#pragma once
#include "runners/kinds/kind.hpp"
#include "runners/study/fields.hpp"

/// \file
/// The keys that the kinds which go through a parameter share.
namespace ricochet {

/// How long an orbit is marched and what is read of it: transient, keep, section, phase.
std::vector<Field> orbit_keys();

/// from, to, count; `what`: what count numbers.
ObjectForm swept_range(const char* what);

/// pointer: what the values replace.
Field swept_pointer();

// What the kinds that go through a parameter have in common as kinds.

/// Format, runner, tables and study-of-one-case of a kind that goes through a parameter.
class SweepKind : public Kind {
 public:
  CaseRunner start(const RunContext& context) const override;
  void tables(StudyResults& results) const override;
  bool answers_itself() const override { return true; }
  std::string contradiction(const CaseRecord& record) const override;
  nlohmann::ordered_json alone(const StudyResults& results, const CaseRecord& record) const override;
  bool has_points() const override { return true; }

 protected:
  SweepKind(const char* name, const char* text, std::vector<Field> keys, std::vector<MeasureInfo> of_cases = {});

 private:
  /// Runs a case, with the context at which it keeps what would be lost if it were killed.
  virtual CaseRecord run(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                         const std::atomic<bool>& stop) const = 0;
  /// Appends the tables that follow from the cases to results.derived.
  virtual void derive(StudyResults& results) const = 0;
};

/// The measures of orbits.
std::vector<MeasureInfo> orbit_measures();

}  // namespace ricochet
