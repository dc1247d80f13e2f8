#pragma once
#include <optional>
#include <ricochet/engine/compile.hpp>

namespace ricochet {

/// Why a scheme cannot take the restitutions that stops have of their own, or nothing.
std::optional<Refusal> refuse_restitution(const Program& program);

/// Says what stops have of their own that neither law nor scheme has a use for.
void say_unused(Program& program);

}  // namespace ricochet
