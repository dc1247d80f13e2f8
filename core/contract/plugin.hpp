#pragma once
#include <ricochet/contract/abi.hpp>
#include <ricochet/contract/plan_algebra.hpp>
#include <ricochet/contract/registry.hpp>

/// \file
/// What a plugin file ends with:
///
///     static void register_all(ricochet::Registry& registry) { registry.add_time({...}, ...); }
///     RICOCHET_PLUGIN(time, central_difference, register_all)
///
/// The macro leaves three things in the library's symbol table, readable without running any of its code. They are the
/// ABI tag, the sizes of the contract's types (both abi.hpp), and the role and name provided ('-' written '_'). So a
/// host opens only libraries that a study names. A library that provides several methods adds RICOCHET_PROVIDES(role,
/// name) for each further one.
///
/// Where RICOCHET_SHARES_LIBRARY is defined, the macro leaves the name and a function register_ROLE_NAME(). One file of
/// such a library calls these functions and ends with RICOCHET_LIBRARY.
#define RICOCHET_PROVIDES(role, name)                                          \
  extern "C" __attribute__((visibility("default"), used, section("ricochet"))) \
  const char ricochet_provides__##role##__##name = 0;

#define RICOCHET_LIBRARY(register_function)                                                                        \
  extern "C" __attribute__((visibility("default"), used, section("ricochet"))) const char RICOCHET_ABI_SYMBOL = 0; \
  RICOCHET_LAYOUTS(RICOCHET_EXPORT_LAYOUT_)                                                                        \
  extern "C" __attribute__((visibility("default"))) void ricochet_register(ricochet::Registry& registry) {         \
    register_function(registry);                                                                                   \
  }

#ifdef RICOCHET_SHARES_LIBRARY
#define RICOCHET_PLUGIN(role, name, register_function) \
  RICOCHET_PROVIDES(role, name)                        \
  namespace ricochet {                                 \
  void register_##role##_##name(Registry& registry) {  \
    register_function(registry);                       \
  }                                                    \
  }
#else
#define RICOCHET_PLUGIN(role, name, register_function) \
  RICOCHET_PROVIDES(role, name)                        \
  RICOCHET_LIBRARY(register_function)
#endif
