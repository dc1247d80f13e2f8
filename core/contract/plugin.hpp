#pragma once
#include <ricochet/contract/toolchain.hpp>
//
#include <ricochet/contract/abi.hpp>
#include <ricochet/contract/layout.hpp>
#include <ricochet/contract/plan_algebra.hpp>
#include <ricochet/contract/registry.hpp>

/// \file
/// What a plugin file ends with:
///
///     static void register_all(ricochet::Registry& registry) { registry.add_time({...}, ...); }
///     RICOCHET_PLUGIN(time, central_difference, register_all)
///
/// The macro leaves three things in the library's symbol table, readable without running any of its code: the ABI tag
/// (see abi.hpp), the sizes of the contract's types (see layout.hpp), and the role and name provided ('-' written '_'),
/// so that a host opens only libraries that a study names. A library that provides several methods adds
/// RICOCHET_PROVIDES(role, name) for each further one.
#define RICOCHET_PROVIDES(role, name)                                          \
  extern "C" __attribute__((visibility("default"), used, section("ricochet"))) \
  const char ricochet_provides__##role##__##name = 0;

#define RICOCHET_PLUGIN(role, name, register_function)                                                             \
  extern "C" __attribute__((visibility("default"), used, section("ricochet"))) const char RICOCHET_ABI_SYMBOL = 0; \
  RICOCHET_LAYOUTS(RICOCHET_EXPORT_LAYOUT_)                                                                        \
  RICOCHET_PROVIDES(role, name)                                                                                    \
  extern "C" __attribute__((visibility("default"))) void ricochet_register(ricochet::Registry& registry) {         \
    register_function(registry);                                                                                   \
  }
