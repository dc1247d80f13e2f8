#pragma once
#include <optional>
#include <ricochet/engine/compile.hpp>

namespace ricochet {

/// Fills what an effort of each stage is worth (momentum, shares in its work), and which stages share a contact
/// instant. The refusal of a plan whose efforts give no definite momentum.
std::optional<Refusal> add_contact_facts(Program& program);

/// Fills what an effort of friction of each stage is worth.
void add_friction_facts(Program& program);

}  // namespace ricochet
