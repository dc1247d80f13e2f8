#pragma once
// What a compiler must be told before it reads any other header of the contract.
#if __cplusplus < 202002L
#error "Ricochet plugins need C++20: compile through the CMake target Ricochet::plugin, or with -std=c++20"
#endif
#ifndef EIGEN_MAX_ALIGN_BYTES
#error "Ricochet plugins share Eigen's alignment with the program: compile through the CMake target Ricochet::plugin"
#endif
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <ricochet/contract/registry.hpp>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// The ABI tag of a plugin. It is the *name* of a symbol: a host reads it from the file's symbol table before any code
/// of the library runs. Fields, in order: contract version, Eigen version, Eigen's alignment limits, libstdc++ string
/// ABI. The sizes of types stand beside it (RICOCHET_LAYOUTS).
#ifndef RICOCHET_ABI_CONTRACT
#define RICOCHET_ABI_CONTRACT 10
#endif
#define RICOCHET_ABI_JOIN_(contract, world, major, align, static_align, cxx11) \
  ricochet_abi__contract_##contract##__eigen_##world##_##major##__align_##align##_##static_align##__cxx11_##cxx11
#define RICOCHET_ABI_JOIN(contract, world, major, align, static_align, cxx11) \
  RICOCHET_ABI_JOIN_(contract, world, major, align, static_align, cxx11)
#define RICOCHET_ABI_SYMBOL                                                                                 \
  RICOCHET_ABI_JOIN(RICOCHET_ABI_CONTRACT, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MAX_ALIGN_BYTES, \
                    EIGEN_MAX_STATIC_ALIGN_BYTES, _GLIBCXX_USE_CXX11_ABI)

/// The sizes of the types that cross between program and plugin. A plugin exports for each type an array of chars as
/// large as the type. The size stands in the symbol table, so a host compares it before any code of the library runs.
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
  X(StopState, ricochet::StopState)                   \
  X(FrictionProblem, ricochet::FrictionProblem)       \
  X(FiniteElementSpace, ricochet::FiniteElementSpace) \
  X(ContactStructure, ricochet::ContactStructure)     \
  X(Inertia, ricochet::Inertia)                       \
  X(DiscreteProblem, ricochet::DiscreteProblem)       \
  X(ReferenceProblem, ricochet::ReferenceProblem)     \
  X(SampleGrid, ricochet::SampleGrid)                 \
  X(SampledMotion, ricochet::SampledMotion)           \
  X(ReferenceMotion, ricochet::ReferenceMotion)       \
  X(ReferenceMapImage, ricochet::ReferenceMap::Image)

#define RICOCHET_EXPORT_LAYOUT_(name, ...)                                     \
  extern "C" __attribute__((visibility("default"), used, section("ricochet"))) \
  const char ricochet_layout__##name[sizeof(__VA_ARGS__)] = {};

namespace ricochet {

/// The tag this program was built with.
std::string abi_tag();

/// Compares a plugin's tag with the program's, field by field; returns "field: expected …, found …" for the first that
/// differs, or nothing.
std::optional<std::string> abi_mismatch(std::string_view plugin_tag);

namespace layout {
using Map = std::map<std::string, double>;
}

/// "Stage" → 296 bytes.
using Layout = std::map<std::string, std::uint64_t>;

/// Compares a plugin's sizes with the program's, in the order of RICOCHET_LAYOUTS. Returns "layout: Stage: expected 296
/// bytes, found 304" for the first that differs or is missing. Types that the program does not know come last. Nothing
/// where all agree.
std::optional<std::string> layout_mismatch(const Layout& plugin);

}  // namespace ricochet
