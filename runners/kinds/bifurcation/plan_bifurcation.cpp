#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/orbits/impact_jump.hpp>

#include "runners/kinds/bifurcation/run_bifurcation.hpp"
#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/kinds/sweep/orbit_exponents.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"

namespace ricochet {
namespace {

/// Orbits that halving adds to one start, and how many of them march side by side: one per change of class and halving.
struct Refined {
  double orbits = 0;
  int abreast = 1;
};

// One interval in four holds a change: of diagrams of the shaken beam, and of two values around a bifurcation the one.
Refined refined(const std::vector<double>& values, const Json& tolerance) {
  if (!tolerance.is_number() || values.size() < 2) return {};
  const double spacing = (values.back() - values.front()) / static_cast<double>(values.size() - 1);
  const double halvings = std::ceil(std::log2(std::max(1.0, spacing / tolerance.get<double>())));
  const double changes = std::max(1.0, static_cast<double>(values.size() - 1) / 4);
  return {changes * halvings, static_cast<int>(std::clamp(changes, 1.0, 8.0))};
}

}  // namespace

CasePlan plan_bifurcation(const StudyCase& study_case, const Registry& registry) {
  CasePlan out;
  const std::vector<double> values = parameter_values(study_case.settings);
  const std::vector<StartSpec> starts = starts_of(study_case.settings);
  const std::string pointer = study_case.settings.at("parameter").at("pointer").get<std::string>();
  ForcedScenes scenes(study_case, registry);
  int representative = -1;
  // Orbits that go through the values begin at rest.
  const bool own_state = !any_start(starts, false);
  for (const double value : values) {
    const int scene = scenes.add(pointer, value, own_state);
    if (scenes[scene].refusal.empty()) {
      representative = scene;
      break;
    }
    if (out.refusal.empty()) out.refusal = fmt::format("at {:g}: {}", value, scenes[scene].refusal);
  }
  if (representative < 0) return out;
  out.refusal.clear();
  describe_march(out, scenes, study_case);
  for (const double value : {values.front(), values.back()}) {
    try {
      widen_steps(out, with_parameter(own_state ? study_case : at_rest(study_case), pointer, value));
    } catch (const InputError&) {  // not marched at this end
    }
  }
  const Json& settings = study_case.settings;
  // Measured on diagrams of the shaken beam: about half of the orbits wait for the cap of the transient, and contacts
  // cost 0.3 of free flight on top of it. What leaves out steps is told from the beam of bench_flight, which is never
  // at rest: two diagrams took 0.6 and 1.05 times as much.
  const double contact_share = scenes.flies() ? 0.8 : 1.3;
  const auto kept = settings.at("keep").get<double>(), exponents = settings.value("exponents", 0.0);
  const double transient = 0.5 * (settings.at("transient").at("periods").get<double>() +
                                  settings.at("transient").at("at_most").get<double>());
  double chains = 0, singles = 0;
  for (const StartSpec& start : starts)
    (start.kind == StartSpec::up || start.kind == StartSpec::down ? chains : singles) += 1;
  const double count = static_cast<double>(values.size()), period = study_case.steps_per_period;
  const auto lanes = [&](int width) { return contact_share * scenes.predicted_step_seconds(0, width) / width; };
  const double orbit = (transient + kept) * period;
  out.steps = static_cast<long long>(orbit * count * (chains + singles));
  out.predicted_seconds = orbit * count * (singles * lanes(8) + chains * lanes(std::max(1, static_cast<int>(chains))));
  const Refined more = refined(values, settings.value("refine", Json(nullptr)));
  out.steps += static_cast<long long>(orbit * more.orbits * (chains + singles));
  out.predicted_seconds += orbit * more.orbits * (chains + singles) * lanes(more.abreast);
  // Chains march abreast, through all values; the others in blocks. Refined values wait for both.
  const double alone = contact_share * scenes.predicted_step_seconds(0, 1);
  const double block = contact_share * scenes.predicted_step_seconds(0, 8);
  const double rounds = more.orbits > 0 ? more.orbits / more.abreast : 0;
  out.chain_seconds =
      orbit * (chains > 0 ? count * alone : block) + orbit * rounds * (chains + singles > 0 ? block : 0);
  // Measured: 220 bytes for each kept period, and as much again for what is said of the orbit.
  constexpr double bytes_of_period = 220, bytes_of_orbit = 2000;
  out.bytes = (count + more.orbits) * (chains + singles) * (bytes_of_orbit + bytes_of_period * kept);
  // The orbit again, one column more than exponents, and the twin.
  const bool blind = exponents > 0 && tangents_miss_impacts(scenes.program(0, {scenes[representative].lane}));
  if (blind) out.notes.push_back(fmt::format("no exponents of orbits with impacts: {}", why_blind));
  if (exponents > 0 && !blind)
    out.predicted_seconds += kept * period * count * (chains + singles) * (exponents + 3) * lanes(8);
  return out;
}

}  // namespace ricochet
