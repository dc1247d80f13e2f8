#include <fmt/format.h>

#include <algorithm>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/flight/flight_set.hpp>
#include <ricochet/engine/left_out.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/scene/stop_parameters.hpp>

namespace ricochet {
namespace {

// Bytes that nobody asks the machine for: what it has free is read from files.
constexpr double small_tables = 16e6;

double memory_for(double needed, const CompileOptions& options) {
  if (options.memory) return *options.memory;
  return needed > small_tables ? available_memory() : infinity;
}

}  // namespace

Refusal refuse_flight(const std::string& cause) {
  return Refusal{"the steps in which nothing happens cannot be left out (" + cause + "): march every step"};
}

std::string why_grounded(const Program& program, const CompileOptions& options) {
  if (program.lanes.size() > 1) return "several lanes march as one block";
  if (program.friction) return "a stop that rubs is marched";
  if (options.audited && program.plan.energy.empty())
    return "the time scheme has no energy of its own, so that the energy of each step is read";
  if (program.load && !program.load_constant) {
    if (program.load_pulsation == 0) return "the load depends on time otherwise than by one sine";
    if (program.support) return "the load depends on time and the support moves";
  }
  if (!program.problem->motions.empty()) return "supports or stops move by histories";
  if (program.problem->damping.matrix) return "the damping is a matrix of its own";
  if (!program.problem->held)
    return program.problem->dofs() == 1 ? "a single degree of freedom is marched"
                                        : "the structure is not held, and has no modes to fly by";
  if (!kind_applies(OperatorKind::modal, *program.problem))
    return fmt::format("beyond {} degrees of freedom there are no modes to fly by", most_marched_by_modes);
  if (options.kind != OperatorKind::automatic && options.kind != OperatorKind::modal)
    return "another operator than the modal one is asked for";
  const double needed = flight_bytes(program.problem->dofs(), static_cast<int>(program.plan.slots.size()),
                                     program.contact ? program.problem->points() : 0, options.expected_steps);
  const double there = memory_for(needed, options);
  if (needed > there)
    return fmt::format("the tables may take {:.3g} MB of memory, and there are {:.3g} MB", needed / 1e6, there / 1e6);
  return "";
}

std::string let_fly(Program& program, const CompileOptions& options) {
  if (program.contact) {
    const Parameters parameters[] = {program.lanes.front().law};
    prepare_law(*program.law, program.problem->points(), parameters, program.problem->own);
  }
  auto flight = std::make_shared<Flight>(program, program.farthest_layer(), options.expected_steps);
  if (!flight->cause().empty()) return flight->cause();
  if (options.audited && !flight->free_never_gains())
    return "a step without contact may gain energy of the time scheme, so that the energy of each step is read";
  program.flight = std::move(flight);
  const std::string &closed = program.flight->closed_cause(), &steps = program.flight->steps_cause();
  program.left_out.push_back(
      {"steps in which no contact changes",
       closed.empty() ? "open or closed, they are composed"
       : steps.empty()
           ? "those without contact are composed; with it (" + closed + ") they are made without a search or a reading"
           : "those without contact are composed; with it (" + (program.law->reads() ? steps : closed) +
                 ") every step is marched"});
  return "";
}

// Of stops' own: by the gates of a rigid law.
std::optional<Refusal> refuse_restitution(const Program& program) {
  const int point = first_with(program.problem->own, ParameterRole::restitution);
  if (point < 0 || program.law->absent() || program.law->reads()) return std::nullopt;
  const std::string& name = program.problem->stops[static_cast<std::size_t>(point)];
  bool gate = false;
  for (const Stage& stage : program.plan.stages) gate = gate || (stage.impact && stage.impact->gate);
  if (gate || program.plan.facts.restitution == Restitution::ignored) return std::nullopt;
  return Refusal{
      said("the time scheme has one restitution in its step: leave restitution of stop {} out, or use a "
           "scheme that closes contact by velocities",
           name)};
}

bool measures_the_end(const Program& program) {
  if (!program.contact || program.problem->changed_by_law() || program.stages.empty()) return false;
  const StageProgram& last = program.stages.back();
  if (!last.reads_contact || last.gate || last.restores > 0) return false;
  const auto numbers = [](const Combination& c) {
    std::vector<double> all = c.slots;
    all.resize(most_slots);
    all.push_back(c.z);
    all.push_back(c.w);
    return all;
  };
  double at_end = 0, elsewhere = 0;
  for (const Level& level : last.measure_levels) (level.at == 1 ? at_end : elsewhere) += std::abs(level.weight);
  return at_end == 1 && elsewhere == 0 && numbers(last.measure) == numbers(program.plan.stages.back().update[0]);
}

namespace {

// What stops have of their own that neither law nor scheme has a use for.
void say_unused(Program& program) {
  const SemiDiscrete& problem = *program.problem;
  const auto say = [&](ParameterRole role, const char* reason) {
    program.left_out.push_back({fmt::format("{} of stops", role_word(role)), reason});
  };
  if (!program.contact) return;
  if (!problem.circles().empty())
    program.left_out.push_back({"sides of clearances", "a compliant law meets the circle itself"});
  for (const UnusedParameter& unused : unused_by(*program.law, problem.own))
    say(unused.role, program.law->reads() ? "the contact law has none" : "the contact law is rigid");
  if (first_with(problem.own, ParameterRole::restitution) < 0) return;
  bool gate = false;
  for (const StageProgram& stage : program.stages) gate = gate || stage.gate;
  if (!gate)
    say(ParameterRole::restitution,
        program.law->reads() ? "a compliant law rebounds by its own force" : "the time scheme has none");
}

}  // namespace

void say_left_out(Program& program) {
  const SemiDiscrete& problem = *program.problem;
  const auto say = [&](std::string item, std::string reason) {
    program.left_out.push_back({std::move(item), std::move(reason)});
  };
  say("damping matrix C", problem.damping.by_modes() ? "C is a number for each mode"
                          : problem.damping.matrix   ? "C is a matrix of its own"
                          : problem.damped()         ? "C = αK + ηM is folded into the weights of K and M"
                                                     : "the structure is undamped");
  if (!program.support && problem.motions.empty()) say("inertia load of the support", "the support does not move");
  if (!program.load)
    say("distributed load", "it is zero");
  else if (program.load_constant)
    say("assembly of the distributed load at each step", "it does not depend on t");
  if (!program.contact) {
    say("contact rows and box problem", program.law->absent() ? "contact law none" : "no stop anywhere");
  } else {
    const auto absent = [&](bool lower) {
      for (const LaneSpec& lane : program.lanes)
        for (int i = 0; i < problem.points(); ++i)
          if (std::isfinite(lower ? lane.lower[i] : lane.upper[i])) return false;
      return true;
    };
    if (absent(true)) say("lower stop", "absent");
    if (absent(false)) say("upper stop", "absent");
    if (program.law->closed_form(problem.points()))
      say("active-set search", problem.points() == 1 ? "one contact point: closed form" : "the law has a closed form");
    if (!program.eager_delassus)
      say("Delassus columns of points never touched", "computed when a point is first touched");
  }
  for (std::size_t k = 0; k < program.stages.size(); ++k)
    if (!program.stages[k].op && program.stages[k].folded.solves())
      say(fmt::format("solve of stage {}", k + 1), "without contact nothing drives it");
  bool mass_products = false;
  for (const StageProgram& stage : program.stages) mass_products = mass_products || stage.folded.uses_mass();
  if (!mass_products) say("products with M", "the scheme's right-hand side has none");
  if (problem.inertia.factored() && program.kind != OperatorKind::modal)
    say("the mass matrix itself", "M = Bᵀ C_v⁻¹ B acts through its factors");
  if (problem.inertia.inverted() && program.kind != OperatorKind::modal)
    say("the mass matrix itself", "M⁻¹ is known: without K a stage is a product with it, with K it is a border");
  say_unused(program);
  if (program.tangents == 0) say("tangent columns", "no exponent is asked for");
}

double Program::farthest_layer() const {
  double layer = 0;
  if (contact)
    for (int i = 0; i < (own_sets ? problem->points() : 1); ++i) layer = std::max(layer, law->layer(law_set(i, 0)));
  return layer;
}

}  // namespace ricochet
