#include "runners/kinds/bifurcation/bifurcation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <ricochet/contract/errors.hpp>
#include <ricochet/measure/orbits/impact_jump.hpp>

#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/all_kinds.hpp"
#include "runners/kinds/bifurcation/page/page.hpp"
#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/kinds/sweep/march_point.hpp"
#include "runners/kinds/sweep/orbit_exponents.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/kinds/sweep/sweep.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/study/fields.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

/// Integrates one orbit again, from where its kept periods begin: --parameter and --start as in values.csv.
int march_orbit_again(const StudyResults& results, const PointRequest& asked, std::ostream& out);

namespace {

std::vector<Field> bifurcation_keys() {
  using namespace keys;
  ObjectForm listed;
  Field values = of_form(Field::Form::numbers, "values", std::nullopt, "The values, all different.");
  values.spec = real_parameter("values", "as the parameter", std::nullopt, any, values.spec.text);
  listed.fields = {std::move(values)};
  ObjectForm parameter;
  parameter.fields = {swept_pointer()};
  parameter.ways = {listed, swept_range("Number of values, evenly spaced.")};

  ObjectForm random;
  random.fields = {integer("random", {1, 10000, false, false}, std::nullopt, "Number of random initial states."),
                   integer("seed", {0, 9007199254740992.0, false, false}, 1, "Seed of the random states.")};
  Field start =
      of_form(Field::Form::starts, "start", Json::array({"rest"}),
              "Where orbits begin: at rest, as the scene says, where the next lower (up) or higher (down) value "
              "ended, or at random.");
  start.spec = word_parameter("start", {"rest", "state", "up", "down"}, std::nullopt, start.spec.text);
  start.nested.push_back(std::move(random));

  std::vector<Field> fields = {
      object("parameter", std::nullopt, "What the diagram is drawn against.", std::move(parameter)), steps_per_period(),
      march("every-step"), std::move(start)};
  for (Field& field : orbit_keys()) fields.push_back(std::move(field));
  fields.push_back(integer("exponents", {0, 100000, false, false}, 0, "Number of Lyapunov exponents, largest first."));
  fields.push_back(optional(real("refine", "as the parameter", positive, std::nullopt,
                                 "Width to which changes of class are located; null: none.")));
  fields.push_back(budget());
  return fields;
}

asks::Places ended_orbits(const CaseRecord& record) {
  asks::Places out;
  for (const OrbitRow& orbit : orbits_of(record)) {
    ++out.all;
    if (!orbit.done()) ++out.ended[orbit.status];
  }
  return out;
}

class BifurcationKind final : public SweepKind {
 public:
  BifurcationKind()
      : SweepKind("bifurcation", "Each case goes through a parameter: sections, classes and exponents of its orbits.",
                  bifurcation_keys(), {"motions", "effect on motions"}, check_sweep_ask, default_sweep_asks,
                  orbit_measures()) {}
  CasePlan plan(const StudyCase& study_case, const Registry& registry) const override {
    return plan_bifurcation(study_case, registry);
  }
  int point(const StudyResults& results, const PointRequest& asked, std::ostream& out) const override {
    return march_orbit_again(results, asked, out);
  }

 private:
  CaseRecord run(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                 const std::atomic<bool>& stop) const override {
    return run_bifurcation(study_case, registry, context, stop);
  }
  Analysis derive(StudyResults& results) const override {
    const auto swept = std::make_shared<const SweptMotions>(derive_dynamics(results));
    return {report::bifurcation_page(),
            {{"motions", [swept](const asks::Ask& ask,
                                 const asks::Evidence& evidence) { return motions_of_sweep(ask, evidence, *swept); }},
             {"effect on motions",
              [swept](const asks::Ask& ask, const asks::Evidence& evidence) {
                return effect_on_sweep(ask, evidence, *swept);
              }},
             {"runs", [](const asks::Ask& ask, const asks::Evidence& evidence) {
                return asks::runs_of_places(ask, evidence, "orbits", ended_orbits);
              }}}};
  }
};

}  // namespace

KindPointer bifurcation_kind() {
  return std::make_unique<BifurcationKind>();
}

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

// Measured: 220 bytes for each kept period, and as much again for what is said of the orbit.
constexpr double bytes_of_period = 220, bytes_of_orbit = 2000;

// Lanes of a block of orbits that begin by themselves. Values that change the step have a factorisation each: there
// only starts are lanes of one block.
int lanes_abreast(const ForcedScenes& scenes, int first, int last, double starts, double values) {
  const bool apart = scenes[last].refusal.empty() && scenes[last].group != scenes[first].group;
  return static_cast<int>(std::clamp((apart ? 1.0 : values) * starts, 1.0, 8.0));
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
    if (out.refusal.empty()) out.refusal = fmt::format("at {:g}: {}", value, scenes[scene].refusal.text);
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
  // Measured on diagrams of the shaken beam: about half of the orbits reach the cap of the transient. Contacts cost 0.3
  // of free flight on top of it. The cost of marches that leave out steps is predicted from the beam of bench_flight,
  // which is never at rest. Two diagrams took 0.6 and 1.05 times as much.
  const double contact_share = scenes.flies() ? 0.8 : 1.3;
  const auto kept = settings.at("keep").get<double>(), exponents = settings.value("exponents", 0.0);
  const double transient = 0.5 * (settings.at("transient").at("periods").get<double>() +
                                  settings.at("transient").at("at_most").get<double>());
  double chains = 0, singles = 0;
  for (const StartSpec& start : starts)
    (start.kind == StartSpec::up || start.kind == StartSpec::down ? chains : singles) += 1;
  const double count = static_cast<double>(values.size()), period = study_case.steps_per_period;
  const auto lane = [&](int width) { return contact_share * scenes.predicted_step_seconds(0, width) / width; };
  const int width =
      lanes_abreast(scenes, representative, scenes.add(pointer, values.back(), own_state), singles, count);
  const double orbit = (transient + kept) * period;
  out.steps = static_cast<long long>(orbit * count * (chains + singles));
  out.predicted_seconds =
      orbit * count * (singles * lane(width) + chains * lane(std::max(1, static_cast<int>(chains))));
  const Refined more = refined(values, settings.value("refine", Json(nullptr)));
  out.steps += static_cast<long long>(orbit * more.orbits * (chains + singles));
  out.predicted_seconds += orbit * more.orbits * (chains + singles) * lane(more.abreast);
  // Chains march abreast, through all values; the others in blocks. Refined values wait for both.
  const double alone = contact_share * scenes.predicted_step_seconds(0, 1);
  const double block = contact_share * scenes.predicted_step_seconds(0, width);
  const double rounds = more.orbits > 0 ? more.orbits / more.abreast : 0;
  out.chain_seconds =
      orbit * (chains > 0 ? count * alone : block) + orbit * rounds * (chains + singles > 0 ? block : 0);
  out.bytes = (count + more.orbits) * (chains + singles) * (bytes_of_orbit + bytes_of_period * kept);
  // The orbit again, one column more than exponents, and the twin.
  const bool blind = exponents > 0 && nothing_tells(scenes, 0, scenes[representative].lane);
  if (blind) out.notes.push_back(fmt::format("no exponents of orbits with impacts: {}", why_blind));
  if (exponents > 0 && !blind)
    out.predicted_seconds += kept * period * count * (chains + singles) * (exponents + 3) * lane(8);
  return out;
}

namespace {

const OrbitRow& find_orbit(const std::vector<OrbitRow>& orbits, double wanted, const std::string& start) {
  std::vector<std::string> starts;
  std::vector<double> marched;  // from this start
  for (const OrbitRow& orbit : orbits) {
    if (std::find(starts.begin(), starts.end(), orbit.start) == starts.end()) starts.push_back(orbit.start);
    if (orbit.start != start) continue;
    marched.push_back(orbit.parameter);
    if (is_value(orbit.parameter, wanted)) return orbit;
  }
  if (!marched.empty())
    throw PointRefused(fmt::format("no orbit from \"{}\" was marched at {}; the nearest values are {}", start, wanted,
                                   nearest_values(marched, wanted)));
  const std::string nearest = nearest_name(start, starts);
  throw PointRefused(fmt::format("the case has no start \"{}\"{}; its starts are {}", start,
                                 nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?",
                                 fmt::join(starts, ", ")));
}

// "periodic 1; 2 impacts per period; exponent_1 -0.31 in [-0.32, -0.3] 1/s (tangent)".
std::string description(const OrbitRow& orbit) {
  std::string text = regime_text(orbit.regime, orbit.period);
  if (orbit.impacts_per_period) text += fmt::format("; {} impacts per period", csv_number(*orbit.impacts_per_period));
  for (std::size_t k = 0; k < orbit.exponents.size() && orbit.exponents[k].value; ++k)
    text += fmt::format("; exponent_{} {} in [{}, {}] 1/s", k + 1, csv_number(*orbit.exponents[k].value),
                        Cell(orbit.exponents[k].low).text(), Cell(orbit.exponents[k].high).text());
  if (!orbit.exponent_method.empty()) text += " (" + orbit.exponent_method + ")";
  return text;
}

}  // namespace

int march_orbit_again(const StudyResults& results, const PointRequest& asked, std::ostream& out) {
  if (!asked.parameter || asked.start.empty() || !asked.cell.empty() || asked.solves())
    throw PointRefused(
        "this is a study of kind bifurcation; expected --parameter VALUE and --start NAME, as in "
        "values.csv");
  const CaseRecord& record = find_case(results, asked.case_id);
  const std::vector<OrbitRow> orbits = orbits_in(stored_table(record, values_name));
  const OrbitRow& orbit = find_orbit(orbits, *asked.parameter, asked.start);
  if (!orbit.done()) throw PointRefused(fmt::format("this orbit is {}: {}", orbit.status, orbit.reason));
  PointTask task;
  task.parameter = orbit.parameter;
  task.start = asked.start;
  task.count = wanted_count(asked);
  auto entry = find_entry(record, task.parameter, task.start);
  if (!entry)
    throw PointRefused(record.partial
                           ? "the case is still running: its states are kept when it ends"
                           : "this case keeps no states of its orbits, there are too many; run the study with "
                             "fewer values or starts");
  task.entry = std::move(*entry);

  const StoredStudy stored(results, asked.plugins);
  const StudyCase& study_case = stored.find(record.id);
  std::vector<double> strobes;  // as the run stored them; none where its section is another one
  if (study_case.settings.at("section") == "strobe")
    strobes = orbit_numbers(record, points_type(), &SectionColumns::displacement, task.parameter, task.start);
  std::size_t compared = 0, equal = 0;
  SamplePrinter print(out);
  march_point(study_case, stored.registry, task, [&](const PointSample& sample) {
    print(sample);
    if (sample.strobe < 0 || static_cast<std::size_t>(sample.strobe) >= strobes.size()) return;
    ++compared;
    equal += sample.displacement == strobes[static_cast<std::size_t>(sample.strobe)];
  });
  std::cerr << description(orbit) << comparison_text(equal, compared) << "\n";
  return 0;
}

}  // namespace ricochet
