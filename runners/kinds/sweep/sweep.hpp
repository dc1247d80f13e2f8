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

/// A case of a sweep, with the context at which it keeps what would be lost if it were killed.
using RunSweep = CaseRecord (*)(const StudyCase&, const Registry&, const CaseContext&, const std::atomic<bool>& stop);

/// Appends the tables that follow from the cases to results.derived.
using DeriveTables = void (*)(StudyResults&);

/// Format, runner, tables and study-of-one-case of a kind that goes through a parameter; name, text, keys, plan,
/// measures and point are its own.
Kind sweep_kind(RunSweep run, DeriveTables derive);

/// The measures of orbits.
std::vector<MeasureInfo> orbit_measures();

}  // namespace ricochet
