#include <fmt/format.h>

#include <ricochet/engine/cost_model.hpp>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/flight/flight_memory.hpp>
#include <ricochet/engine/flight_choice.hpp>
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
  if (program.load && !program.load_constant) return "the load depends on time";
  if (!program.problem->motions.empty()) return "supports or stops move by histories";
  if (program.problem->damping.own()) return "the damping is not made of K and M";
  if (!program.problem->held || !kind_applies(OperatorKind::modal, *program.problem))
    return "the structure has no modes to fly by: it is not held, or has more than 1000 degrees of freedom";
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

}  // namespace ricochet
