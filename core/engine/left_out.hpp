#pragma once
#include <optional>
#include <ricochet/engine/compile.hpp>
#include <string>

namespace ricochet {

Refusal refuse_flight(const std::string& cause);
/// Why an integration cannot leave out steps, by what is known before anything is worked out: lanes, loads, modes,
/// memory; empty: nothing speaks against it.
std::string why_grounded(const Program& program, const CompileOptions& options);
/// Makes the tables of flights; why there are none, where there are none.
std::string let_fly(Program& program, const CompileOptions& options);

/// Why a scheme cannot take the restitutions that stops have of their own, or nothing.
std::optional<Refusal> refuse_restitution(const Program& program);

/// Whether a law that touches nothing has seen every point between its stops where the step ends.
bool measures_the_end(const Program& program);

/// Says what a compiled program does without. What stops have of their own and neither law nor scheme has a use for
/// is among it.
void say_left_out(Program& program);

}  // namespace ricochet
