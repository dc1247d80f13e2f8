#include <fmt/format.h>

#include <ricochet/contract/plugin.hpp>

#include "event_driven.hpp"
#include "linear_structure.hpp"

namespace {

using namespace ricochet;
using namespace ricochet::reference;

constexpr Eigen::Index most_dofs = 60;

/// Exact in time on the mesh of the case: separates what the time scheme does from what the mesh does.
class EventDrivenSemiDiscrete final : public ReferenceSolver {
 public:
  bool of_the_mesh() const override { return true; }

  ReferenceOrRefusal solve(const ReferenceProblem& problem, const SampleGrid& grid) const override {
    if (!problem.discrete) return Refusal{"the matrices of a mesh are missing: this reference is one of the mesh"};
    if (problem.discrete->mass.rows() > most_dofs)
      return Refusal{
          fmt::format("{} dofs: the exact semi-discrete solution is worked out for at most {}, 20 elements of "
                      "a beam; use fewer elements, or the reference event-driven or self",
                      problem.discrete->mass.rows(), most_dofs)};
    if (!problem.load_constant)
      return Refusal{
          "the load depends on time by a formula: between events only constant and harmonic forces are "
          "exact; use the reference self"};
    if (problem.contact_nonlinear)
      return Refusal{
          "the contact law is not linear: between events the motion is not a sum of modes; use the reference self"};
    try {
      EventDriven fine(problem, grid, 0.5);
      ReferenceMotion found;
      found.motion = fine.run();
      found.coarser = EventDriven(problem, grid, 2).run();
      found.how = fmt::format(
          "modes of each contact set of the {} dofs, exact between events; events watched twice per "
          "radian of the fastest mode that matters, and polished to round-off",
          problem.discrete->mass.rows());
      found.notes = fine.notes();
      return found;
    } catch (const Stopped& stopped) {
      return Refusal{stopped.sentence};
    }
  }
};

void register_event_driven_semi_discrete(Registry& registry) {
  registry.add_reference(
      {.name = "event-driven-semi-discrete",
       .summary = "the motion of the case's own mesh, exact in time between changes of the contact set",
       .text = R"(While the set of closed contact points stays as it is, M w'' + C w' + K w = F + Hᵀp is linear with
          constant coefficients, and its modes are known: closed points are bilateral constraints (rigid law) or
          springs (linear compliant law, κ per point), forces are constant or harmonic, and the modes solve it
          exactly, under-, critically and over-damped ones alike. The massless modes of a singular mass follow at
          once (α = 0) or relax with rate 1/α; where they carry all contact points, contact opens and closes without
          any impact and restitution has no part in it. A single point with inertia rebounds by Newton's law, v⁺ =
          −e v⁻, and a bounce below 1e-14 of the highest ends a chattering; several such points under a rigid law
          are refused. Events (a gap, a contact force or a penetration that falls below zero) are watched at a step
          that resolves the fastest mode that still matters, with a bound of the curvature between, and polished to
          round-off. Initial data off the constraint of a singular mass jump to it at t = 0⁺ when α = 0. At most 60
          dofs.)",
       .source = R"(Acary and Brogliato (2008), ch. 8 (event-driven schemes); Renard (2010) for contact without
          inertia; modes as M x = μ K x, so that slow ones keep their digits)",
       .parameters = {}},
      [](const Parameters&) { return std::make_unique<EventDrivenSemiDiscrete>(); });
}

}  // namespace

RICOCHET_PLUGIN(reference, event_driven_semi_discrete, register_event_driven_semi_discrete)
