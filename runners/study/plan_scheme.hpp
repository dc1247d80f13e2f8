#pragma once
#include <filesystem>
#include <memory>
#include <ricochet/contract/registry.hpp>
#include <string>

#include "runners/study/study.hpp"

/// \file
/// A time scheme without C++: slots, stages, rows and facts of a StepPlan as formulas in h and named parameters, in
/// JSON (plugins/plan-files.md). It is checked when it is read, and is then a method like any other.
namespace ricochet {

/// A plan as it was written, and where: a file of its own, or a value of a study.
struct PlanSource {
  Json plan;
  std::filesystem::path file;  ///< "" for a plan that stands in a study
  std::string text;            ///< of the file, for lines
  std::string pointer;         ///< of the plan within its document

  /// "FILE:LINE: at /stages/0/matrix: what is wrong", or without file and line where there is none.
  std::string explain(const InputError& error) const;
};

/// Reads a file. Throws InputError, pointer "", whose text names the file: it cannot be read, or is no JSON.
PlanSource read_plan_file(const std::filesystem::path& file);

/// Checks a whole plan and tells what it says of itself: every key, every formula, and, where all parameters have
/// defaults, that the plan is well-formed with these and h = 1 ms on a regular, damped problem with contact. Throws
/// InputError with pointers into the document.
PluginManual check_plan_source(const PlanSource& source);

/// Checks and registers it as a time scheme that comes from `source.file`. Throws InputError.
void register_plan(const PlanSource& source, Registry& registry);

}  // namespace ricochet
