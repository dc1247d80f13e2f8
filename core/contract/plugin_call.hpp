#pragma once
#include <cstdint>
#include <ricochet/contract/errors.hpp>
#include <string>

namespace ricochet {

/// Who provides the code that is about to run: "time 'bathe' (/path/time.so)".
struct PluginIdentity {
  std::string role, name, file;  ///< file: "" when registered in-process
  std::string text() const;
};

/// What this thread asks of a plugin right now: readable at any moment, also from a signal handler.
struct PluginCall {
  const PluginIdentity* plugin = nullptr;
  const char* function = nullptr;  ///< "plan", "solve", "build", …
  std::uint64_t serial = 0;        ///< of this thread's calls: equal at two moments, the call never returned between
};

/// The call under way in this thread; `plugin` is null between calls.
const PluginCall& current_plugin_call();

/// Marks this thread as being inside a plugin's function for as long as it lives; scopes nest.
class PluginCallScope {
 public:
  PluginCallScope(const PluginIdentity& plugin, const char* function);
  ~PluginCallScope();
  PluginCallScope(const PluginCallScope&) = delete;
  PluginCallScope& operator=(const PluginCallScope&) = delete;

 private:
  PluginCall before_;
};

/// A plugin did what the contract forbids: threw, returned nothing, sizes that do not fit, numbers that are none. The
/// message names plugin, file and function. A case that meets one is `failed`, never `refused`.
class PluginFault : public std::runtime_error {
 public:
  PluginFault(const PluginIdentity& plugin, const char* function, const std::string& what);
};

}  // namespace ricochet
