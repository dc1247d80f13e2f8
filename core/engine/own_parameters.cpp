#include <fmt/format.h>

#include <algorithm>
#include <ricochet/engine/own_parameters.hpp>
#include <ricochet/scene/stop_parameters.hpp>

namespace ricochet {

// Of stops' own: by the gates of a rigid law.
std::optional<Refusal> refuse_restitution(const Program& program) {
  const int point = first_with(program.problem->own, ParameterRole::restitution);
  if (point < 0 || program.law->absent() || program.law->reads()) return std::nullopt;
  const std::string& name = program.problem->stops[static_cast<std::size_t>(point)];
  bool gate = false;
  for (const Stage& stage : program.plan.stages) gate = gate || (stage.impact && stage.impact->gate);
  if (gate && program.tangents > 0)
    return Refusal{
        fmt::format("stop {} has a restitution of its own, and tangents know one for all stops: exponents "
                    "are those of twins",
                    name)};
  if (gate || program.plan.facts.restitution == Restitution::ignored) return std::nullopt;
  return Refusal{
      fmt::format("the time scheme has one restitution in its step: leave restitution of stop {} out, or use a "
                  "scheme that closes contact by velocities",
                  name)};
}

// What stops have of their own that neither law nor scheme has a use for.
void say_unused(Program& program) {
  const SemiDiscrete& problem = *program.problem;
  const auto say = [&](ParameterRole role, const char* reason) {
    program.left_out.push_back({fmt::format("{} of stops", role_word(role)), reason});
  };
  if (!program.contact) return;
  for (const UnusedParameter& unused : unused_by(*program.law, problem.own))
    say(unused.role, program.law->reads() ? "the contact law has none" : "the contact law is rigid");
  if (first_with(problem.own, ParameterRole::restitution) < 0) return;
  bool gate = false;
  for (const StageProgram& stage : program.stages) gate = gate || stage.gate;
  if (!gate)
    say(ParameterRole::restitution,
        program.law->reads() ? "a compliant law rebounds by its own force" : "the time scheme has none");
}

double Program::farthest_layer() const {
  double layer = 0;
  if (contact)
    for (int i = 0; i < (own_sets ? problem->points() : 1); ++i) layer = std::max(layer, law->layer(law_set(i, 0)));
  return layer;
}

}  // namespace ricochet
