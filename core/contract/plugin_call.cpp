#include <ricochet/contract/plugin_call.hpp>

namespace ricochet {
namespace {

// constinit and trivially destructible: a signal handler may read it before and after everything else.
constinit thread_local PluginCall call;
constinit thread_local std::uint64_t calls = 0;

}  // namespace

std::string PluginIdentity::text() const {
  return role + " '" + name + "'" + (file.empty() ? "" : " (" + file + ")");
}

const PluginCall& current_plugin_call() {
  return call;
}

PluginCallScope::PluginCallScope(const PluginIdentity& plugin, const char* function) : before_(call) {
  call = {&plugin, function, ++calls};
}
PluginCallScope::~PluginCallScope() {
  call = before_;
}

PluginFault::PluginFault(const PluginIdentity& plugin, const char* function, const std::string& what)
    : std::runtime_error("plugin " + plugin.text() + ", " + function + "(): " + what) {}

}  // namespace ricochet
