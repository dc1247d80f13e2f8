#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <ricochet/contract/contact_structure.hpp>
#include <ricochet/contract/registry.hpp>
#include <span>
#include <string>
#include <vector>

/// \file
/// The sizes of the types that cross between program and plugin. A plugin exports for each one an array of chars as
/// large as the type: its size stands in the symbol table, so a host compares it before any code of the library runs.
/// One more field, or a debugging standard library, is then told instead of met as garbage.

/// X(name of the symbol, type), those of the standard library first: a type that holds them differs as well.
#define RICOCHET_LAYOUTS(X)                           \
  X(string, std::string)                              \
  X(vector, std::vector<double>)                      \
  X(function, std::function<double(double)>)          \
  X(map, ricochet::layout::Map)                       \
  X(SparseMatrix, ricochet::SparseMatrix)             \
  X(ParameterSpec, ricochet::ParameterSpec)           \
  X(Parameters, ricochet::Parameters)                 \
  X(PluginManual, ricochet::PluginManual)             \
  X(Registry, ricochet::Registry)                     \
  X(Combination, ricochet::Combination)               \
  X(Impulse, ricochet::Impulse)                       \
  X(ImpactMeasure, ricochet::ImpactMeasure)           \
  X(ComplianceMeasure, ricochet::ComplianceMeasure)   \
  X(WorkForm, ricochet::WorkForm)                     \
  X(SchemeFacts, ricochet::SchemeFacts)               \
  X(Stage, ricochet::Stage)                           \
  X(StepPlan, ricochet::StepPlan)                     \
  X(ProblemFacts, ricochet::ProblemFacts)             \
  X(LaneOutcome, ricochet::LaneOutcome)               \
  X(ReducedProblem, ricochet::ReducedProblem)         \
  X(FiniteElementSpace, ricochet::FiniteElementSpace) \
  X(ContactStructure, ricochet::ContactStructure)     \
  X(Inertia, ricochet::Inertia)                       \
  X(DiscreteProblem, ricochet::DiscreteProblem)       \
  X(ReferenceProblem, ricochet::ReferenceProblem)     \
  X(SampleGrid, ricochet::SampleGrid)                 \
  X(SampledMotion, ricochet::SampledMotion)           \
  X(ReferenceMotion, ricochet::ReferenceMotion)

#define RICOCHET_EXPORT_LAYOUT_(name, ...)                                     \
  extern "C" __attribute__((visibility("default"), used, section("ricochet"))) \
  const char ricochet_layout__##name[sizeof(__VA_ARGS__)] = {};

namespace ricochet {
namespace layout {
using Map = std::map<std::string, double>;
}

/// "Stage" → 296 bytes.
using Layout = std::map<std::string, std::uint64_t>;

/// Compares a plugin's sizes with the program's; returns "layout: Stage: expected 296 bytes, found 304" for the first
/// that differs or is missing, in the order of RICOCHET_LAYOUTS, or nothing.
std::optional<std::string> layout_mismatch(const Layout& plugin);

}  // namespace ricochet
