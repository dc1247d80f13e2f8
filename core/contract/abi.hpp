#pragma once
// First: it says what is missing before anything else can fail for it.
#include <ricochet/contract/toolchain.hpp>
//
#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

/// \file
/// The ABI tag of a plugin: the *name* of a symbol, so that a host reads it from the file's symbol table before any
/// code of the library runs. Fields, in order: contract version, Eigen version, Eigen's alignment limits, libstdc++
/// string ABI. The sizes of types stand beside it (see layout.hpp).
#ifndef RICOCHET_ABI_CONTRACT
#define RICOCHET_ABI_CONTRACT 3
#endif
#define RICOCHET_ABI_JOIN_(contract, world, major, align, static_align, cxx11) \
  ricochet_abi__contract_##contract##__eigen_##world##_##major##__align_##align##_##static_align##__cxx11_##cxx11
#define RICOCHET_ABI_JOIN(contract, world, major, align, static_align, cxx11) \
  RICOCHET_ABI_JOIN_(contract, world, major, align, static_align, cxx11)
#define RICOCHET_ABI_SYMBOL                                                                                 \
  RICOCHET_ABI_JOIN(RICOCHET_ABI_CONTRACT, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MAX_ALIGN_BYTES, \
                    EIGEN_MAX_STATIC_ALIGN_BYTES, _GLIBCXX_USE_CXX11_ABI)

namespace ricochet {

/// The tag this program was built with.
std::string abi_tag();

/// Compares a plugin's tag with the program's, field by field; returns "field: expected …, found …" for the first that
/// differs, or nothing.
std::optional<std::string> abi_mismatch(std::string_view plugin_tag);

}  // namespace ricochet
