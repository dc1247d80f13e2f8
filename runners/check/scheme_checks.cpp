#include "runners/check/scheme_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/contract/unit_mass.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>

namespace ricochet::checking {
namespace {

constexpr double round_off = 1e-9;  // of the energies at play, over a few hundred steps

bool all_have_work(const StepPlan& plan) {
  return std::all_of(plan.stages.begin(), plan.stages.end(), [](const Stage& stage) { return stage.work.has_value(); });
}
bool any_has_work(const StepPlan& plan) {
  return std::any_of(plan.stages.begin(), plan.stages.end(), [](const Stage& stage) { return stage.work.has_value(); });
}

template <class Marched>
double throughput(const Marched& totals) {
  double scale = std::max(std::abs(totals.scheme_start), std::abs(totals.last.scheme));
  for (const double work :
       {totals.work_of_loads, totals.work_of_damping, totals.work_of_contact, totals.work_of_scheme})
    scale = std::max(scale, std::abs(work));
  return scale;
}

struct Setting {
  std::string name;
  StructureBench bench;
  std::function<std::unique_ptr<ContactLaw>()> law = no_contact;
};

std::vector<Setting> settings(const StepPlan& plan, bool beam) {
  const auto bench = [&](bool damped, bool load, bool support, bool stops) {
    return StructureBench{beam, damped ? 1e-3 : 0.0, load, support, stops, !beam};
  };
  std::vector<Setting> all = {{"in free flight", bench(false, false, false, false)},
                              {"with damping", bench(true, false, false, false)},
                              {"with a load", bench(false, true, false, false)},
                              {"on a moving support", bench(false, false, true, false)}};
  const auto offers = [&](auto has) { return std::any_of(plan.stages.begin(), plan.stages.end(), has); };
  if (offers([](const Stage& stage) { return stage.impact.has_value(); })) {
    all.push_back({"at rigid stops", bench(false, false, false, true), rigid_stops});
    all.push_back({"at rigid stops, loaded, damped, on a moving support", bench(true, true, true, true), rigid_stops});
  }
  for (const Evaluation evaluation : {Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start})
    if (offers([&](const Stage& stage) { return stage.at(evaluation).has_value(); }))
      all.push_back({std::string("at springs (") + evaluation_word(evaluation) + ") on a moving support",
                     bench(false, false, true, true), [evaluation] { return springs(evaluation, 20); }});
  return all;
}

struct Marched {
  EnergyTotals totals;
  ContactTotals contact;
};
Marched march(const Scheme& scheme, const Setting& setting, int elements, double share, int steps) {
  const ProblemPointer problem = discretised(structure_scene(setting.bench), elements);
  Marcher marcher = marcher_of(scheme, problem, sound_step(scheme, *problem, share), setting.law());
  EnergyAudit audit(marcher);
  marcher.start(&audit);
  marcher.march(steps, &audit);
  if (!marcher.status(0).running)
    throw std::runtime_error("an integration " + setting.name + " stopped: " + text(marcher.status(0).end));
  return {audit.totals(0), audit.contact(0)};
}

// By how much the way of a support, at the levels that a work form gives, misses its test displacement on a motion at
// constant acceleration, in units of acceleration times h². Once everything has settled; parasitic roots −1 are
// averaged out over two steps.
double missed_by_support(const StepPlan& plan, double h, std::size_t stage) {
  constexpr int settling = 64;
  UnitMass mass(plan, 0, 0);
  mass.advance(plan.start, 1);
  std::vector<UnitMass> begins;
  for (int n = 0; n < settling + 3; ++n) {
    begins.push_back(mass);
    mass.advance(plan.stages, 1);
  }
  const WorkForm& work = *plan.stages[stage].work;
  double missed = 0;
  for (std::size_t n = settling; n < settling + 2; ++n) {
    UnitMass now = begins[n];
    for (std::size_t k = 0; k < stage; ++k) now.update(plan.stages[k], now.unknown(plan.stages[k], 1, 0));
    const double speed = (begins[n + 1].slots[0] - begins[n - 1].slots[0]) / (2 * h);
    double way = 0;
    for (const Level& level : work.support) way += level.weight * level.at * h * (speed + 0.5 * level.at * h);
    missed += 0.5 * (way - combined(work.displacement, now.slots, now.unknown(plan.stages[stage], 1, 0))) / (h * h);
  }
  return missed;
}

}  // namespace

Verdict energy_in_free_flight(const Scheme& scheme) {
  const StepPlan plan = plan_of(scheme, 1e-3, {});
  if (plan.energy.empty()) return not_declared("no energy of its own");
  double taken = 0;
  for (const bool beam : {false, true})
    for (const double share : {1.0 / 200, 1.0 / 11}) {
      const Setting flight{"in free flight", {.beam = beam}};
      const EnergyTotals totals = march(scheme, flight, 4, share, 300).totals;
      const double start = totals.scheme_start, scale = throughput(totals);
      if (!(start > 0)) return fails(fmt::format("its energy of a moving structure is {:g} J", start));
      if (!(totals.largest_step_gain <= round_off * scale))
        return fails(fmt::format("the declared energy grows in undamped free flight, by {:.3g} of {:.3g} J in one step",
                                 totals.largest_step_gain, start));
      const double left = totals.last.scheme - start + totals.work_of_scheme;
      if (all_have_work(plan) && !(std::abs(left) <= round_off * scale))
        return fails(
            fmt::format("the declared energy of undamped free flight goes from {:.10g} to {:.10g} J in 300 "
                        "steps, while the declared losses are {:.3g} J",
                        start, totals.last.scheme, totals.work_of_scheme));
      taken = std::max(taken, (start - totals.last.scheme) / start);
    }
  if (taken <= round_off) return fine("constant in undamped free flight");
  return fine(fmt::format("decreases in undamped free flight{}, by {:.3g} at most of what there is",
                          all_have_work(plan) ? " by what the loss terms say" : "", taken));
}

Verdict work_form_closes(const Scheme& scheme) {
  constexpr double h = 1e-3;
  const StepPlan plan = plan_of(scheme, h, {12, 0, true, true});
  if (!any_has_work(plan)) return not_declared("no work form: works and balances are left blank");
  if (!all_have_work(plan)) return fails("some stages declare a work form and some do not: the balance cannot close");
  constexpr double tolerance = 1e-4;  // of levels written as decimals, and of round-off over h²
  if (step_of(plan) != 0)
    for (std::size_t k = 0; k < plan.stages.size(); ++k) {
      if (plan.stages[k].work->support.empty()) continue;
      const double missed = missed_by_support(plan, h, k);
      if (!(std::abs(missed) <= tolerance))
        return fails(
            fmt::format("stage {}: work support misses the test displacement by {:.4g} h² of the acceleration of a "
                        "mass: its levels stand at other times. Left out, they are derived",
                        k + 1, missed));
    }
  double worst = 0;
  for (const bool beam : {false, true})
    for (const Setting& setting : settings(plan, beam)) {
      const Marched marched = march(scheme, setting, 3, 1.0 / 60, 180);
      const double residual = std::abs(marched.totals.balance_residual()) / throughput(marched.totals);
      if (!(residual <= 10 * round_off))
        return fails(fmt::format("the balance of a {} {} does not close: {:.3g} J are left of {:.3g}",
                                 beam ? "beam" : "bar", setting.name, marched.totals.balance_residual(),
                                 throughput(marched.totals)));
      worst = std::max(worst, residual);
    }
  return fine(fmt::format("closes to {:.1g} with loads, damping, moving support and contact", worst));
}

Verdict contact_gains_as_declared(const Scheme& scheme) {
  const StepPlan plan = plan_of(scheme, 1e-3, {12, 0, false, true});
  if (std::none_of(plan.stages.begin(), plan.stages.end(), [](const Stage& stage) { return stage.impact.has_value(); }))
    return not_declared("no impact measure: rigid laws are refused");
  if (plan.facts.contact_never_gains && plan.energy.empty())
    return fails("declares that its own energy never grows at contact, and declares no energy");
  double gain = 0;
  long long impacts = 0;
  for (const bool beam : {false, true})
    for (const bool everywhere : {false, true}) {
      const Setting stops{"at rigid stops", {.beam = beam, .stops = true, .everywhere = everywhere}, rigid_stops};
      Marched marched;
      try {
        marched = march(scheme, stops, 6, 1.0 / 400, 2500);
      } catch (const std::runtime_error& stopped) {
        if (plan.facts.contact_never_gains) return fails(stopped.what());
        gain = std::max(gain, 1.0);
        continue;
      }
      impacts += marched.contact.impacts;
      gain = std::max(gain, marched.totals.largest_step_gain / marched.totals.scheme_start);
    }
  if (plan.facts.contact_never_gains) {
    if (impacts == 0) return fails("declares that contact never gains, yet finds no contact at all");
    if (!(gain <= round_off))
      return fails(
          fmt::format("declares that its energy never grows at a fixed rigid stop; a bar or a beam gains {:.3g} "
                      "of what it has in one step",
                      gain));
    return fine(fmt::format("never grows, {} impacts of a bar and a beam", impacts));
  }
  return not_declared(gain > round_off ? fmt::format("may be gained: up to {:.2g} of what there is in one step", gain)
                                       : std::string("not promised; none gained here"));
}

}  // namespace ricochet::checking
