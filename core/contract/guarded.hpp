#pragma once
#include <functional>
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/contract/plugin_call.hpp>
#include <ricochet/contract/reference.hpp>
#include <ricochet/contract/time_scheme.hpp>

namespace ricochet {

/// The factory of one method, as a plugin registers it.
template <class Interface>
using Maker = std::function<std::unique_ptr<Interface>(const Parameters&)>;

/// The same factory, whose objects answer for what they do: every function runs inside a PluginCallScope; whatever it
/// throws (but an InputError or a PluginError, which already say what to do) arrives as a PluginFault that names
/// plugin, file and function; and so does an answer that the contract forbids: no object, an ill-formed plan, a refusal
/// without a sentence, a mass that is none (check_inertia), a motion that does not fit its grid. The registry puts
/// every factory through this, so that nobody holds an unguarded object.
Maker<MassStrategy> guarded(PluginIdentity plugin, Maker<MassStrategy> make);
Maker<ContactLaw> guarded(PluginIdentity plugin, Maker<ContactLaw> make);
Maker<TimeScheme> guarded(PluginIdentity plugin, Maker<TimeScheme> make);
Maker<ReferenceSolver> guarded(PluginIdentity plugin, Maker<ReferenceSolver> make);

}  // namespace ricochet
