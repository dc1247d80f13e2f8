#include "runners/kinds/stability/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/scene/whole_load.hpp>

#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/all_kinds.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/fields.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

std::vector<Field> stability_keys() {
  using namespace keys;
  ObjectForm steps;
  steps.fields = {single(real("from", "s", positive, std::nullopt, "Smallest step.")),
                  single(real("to", "s", positive, std::nullopt, "Largest step.")),
                  integer("count", {1, 10000, false, false}, 20, "Number of steps, even on a log scale.")};
  Field observe;
  observe.spec.type = ParameterSpec::Type::boolean;
  observe.spec.key = "observe";
  observe.spec.text = "Whether cells are marched too.";
  observe.fallback = true;
  return {object("steps", std::nullopt, "The range of steps.", steps), observe,
          optional(real("duration", "s", positive, std::nullopt, "Time of each cell; null: as growth needs.")),
          budget()};
}

void check_stability(const Json& study) {
  if (const auto steps = study.find("steps"); steps != study.end()) {
    // The square of a step and of its inverse are numbers of a plan.
    constexpr double least = 1e-100, most = 1e100;
    for (const char* end : {"from", "to"})
      if (const double h = (*steps)[end].get<double>(); h < least || h > most)
        throw InputError(std::string("/steps/") + end,
                         fmt::format("a step of {} s; expected one between {:g} and {:g} s", h, least, most));
    if ((*steps)["from"].get<double>() > (*steps)["to"].get<double>())
      throw InputError("/steps/from", fmt::format("the range begins at {} s and ends at {} s; expected from ≤ to",
                                                  (*steps)["from"].get<double>(), (*steps)["to"].get<double>()));
    if ((*steps)["count"].get<int>() == 1 && (*steps)["from"].get<double>() < (*steps)["to"].get<double>())
      throw InputError("/steps/count", "one step of a range tells nothing of it; expected two or more, or from = to");
  }
}

// Marched at some steps, and stable at none of them.
bool never_stable(const CaseRecord& record) {
  const std::vector<ObservedRow> rows = stability_observed_type().read(record.tables);
  return !rows.empty() &&
         std::none_of(rows.begin(), rows.end(), [](const ObservedRow& row) { return stays_bounded(row.behaviour); });
}

std::string limits_text(const CaseRecord& record) {
  std::vector<std::string> parts;
  const auto predicted = measure(record, "limit_predicted"), observed = measure(record, "limit_observed");
  if (predicted) parts.push_back(fmt::format("step limit predicted {:.4g} s", *predicted));
  if (observed) parts.push_back(fmt::format("observed {:.4g} s", *observed));
  if (const auto radius = measure(record, "largest_radius"); radius && !predicted)
    parts.push_back(fmt::format("largest spectral radius {:.6g}", *radius));
  if (never_stable(record)) parts.emplace_back("unstable at every step marched");
  if (const auto steps = measure(record, "contradictions"))
    parts.push_back(fmt::format("spectrum and march disagree without contact at {:.0f} step{}: an error of the method",
                                *steps, *steps == 1 ? "" : "s"));
  if (const auto product = measure(record, "undeclared_limit"))
    parts.push_back(fmt::format("stable up to h·ω = {:.4g}, which the scheme declares otherwise", *product));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<MeasureInfo> stability_measures() {
  using Of = MeasureInfo::Of;
  std::vector<MeasureInfo> all = {
      {"limit_predicted",
       "s",
       "Largest stable step of the range, from the plan alone.",
       Of::motion,
       false,
       "",
       {"the stable step of the plan", 1}},
      {"limit_observed",
       "s",
       "Largest stable step of the range, by marching as long as the case does, and bisection.",
       Of::motion,
       false,
       "",
       {"the stable step of the march", 1},
       false,
       "",
       "limit_resolution"},
      {"limit_resolution", "s", "What the bisection leaves open of limit_observed.", Of::computation, true},
      {"least.limit_predicted", "s",
       "The largest step of the range where each has a stable plan: the limit lies beyond.", Of::computation, true},
      {"least.limit_observed", "s",
       "The largest step of the range where each was marched stably: the limit lies beyond.", Of::computation, true},
      {"largest_radius",
       "1",
       "Largest spectral radius of the step over the range.",
       Of::motion,
       false,
       "",
       {"the largest spectral radius", -1}},
      {"agreement", "1", "Observed over predicted step limit."},
      {"contradictions", "1",
       "Steps of the range at which spectrum and march disagree without contact: an error of the method.",
       Of::computation},
      {"undeclared_limit", "1",
       "h·ω up to which steps were stable, where the scheme declares another limit, or none: an error of its facts.",
       Of::computation},
  };
  for (MeasureInfo& one : all) one.of_each_size = true;
  return all;
}

}  // namespace

namespace {

StudyKind stability_format() {
  StudyKind format;
  format.name = "stability";
  format.text = "Each case goes through a range of steps: the spectrum of the step, and what marching it shows.";
  format.keys = stability_keys();
  format.settings = [](const Json& resolved) { return given_settings(resolved, {"steps", "observe", "budget"}); };
  format.check = check_stability;
  format.check_measure = asks::measures_alone(stability_measures());
  format.verbs = {"steps"};
  format.default_asks = [](const Json&) { return Json::array({{{"steps", "limit"}}}); };
  format.check_ask = [](const Study&, const Json& ask, const std::string& pointer) {
    asks::refuse_stops(asks::ask_at(ask, pointer));
  };
  return format;
}

class StabilityKind final : public Kind {
 public:
  StabilityKind() : Kind(stability_format(), stability_measures()) {}
  CasePlan plan(const StudyCase& study_case, const Registry& registry) const override {
    return plan_stability(study_case, registry);
  }
  CaseRunner start(const RunContext& context) const override {
    CaseRunner runner;
    runner.run = [&registry = context.registry](const StudyCase& study_case, const std::atomic<bool>& stop) {
      return run_stability(study_case, registry, stop);
    };
    return runner;
  }
  Analysis analysis(StudyResults& results, const Choices&) const override {
    describe_stability(results.cases);
    collect_tables(results);
    const auto limits = std::make_shared<const std::vector<LimitRow>>(step_limit_rows(results));
    results.derived.push_back(step_limits_table(results, *limits));
    results.derived.push_back(step_limit_agreement_table(results.derived.back()));
    for (Table table : {stability_cells_table(results), stability_disagreements_table(results)})
      if (!table.rows.empty()) results.derived.push_back(std::move(table));
    return {report::stability_page(), {{"steps", [limits](const asks::Ask& ask, const asks::Evidence& evidence) {
                                          return steps_ask(ask, evidence, *limits);
                                        }}}};
  }
  std::string outcome(const CaseRecord& record) const override { return limits_text(record); }
  std::string contradiction(const CaseRecord& record) const override {
    if (measure(record, "contradictions").value_or(0) > 0) return "spectrum and march disagree without contact";
    return measure(record, "undeclared_limit") ? "the step limit is not the one that the scheme declares" : "";
  }
};

}  // namespace

KindPointer stability_kind() {
  return std::make_unique<StabilityKind>();
}

std::vector<double> steps_of(const StudyCase& study_case) {
  const Json& range = study_case.settings.at("steps");
  const double from = range.at("from").get<double>(), to = range.at("to").get<double>();
  const int count = range.at("count").get<int>();
  if (!std::isfinite(to / from) || !std::isnormal(from))
    throw InputError("/steps/from", fmt::format("steps from {:g} to {:g} s span more than numbers can hold", from, to));
  std::vector<double> steps;
  // Twelve digits: 1e-05 rather than 9.999999999999999e-06.
  for (int i = 0; i < count; ++i)
    steps.push_back(to_digits(count == 1 ? from : from * std::pow(to / from, i / (count - 1.0)), 12));
  return steps;
}

namespace {

bool rests(const SceneSpec& scene, const SemiDiscrete& problem) {
  const LaneSpec lane = scene_lane(problem, {});
  return !is_driven(scene) && lane.position.isZero(0) && lane.velocity.isZero(0);
}

// Modes of the structure, open and held at each set of points, and the roots of the step on each mode. Points that are
// held by springs have one dense step of all slots. 20 spectra more find the limit.
double spectra_seconds(const SemiDiscrete& problem, const StepPlan& plan, const ContactLaw& law, bool touches,
                       std::size_t steps) {
  constexpr double cubic = 1e-8, root = 2e-6;
  const double n = problem.dofs(), slots = static_cast<double>(plan.slots.size());
  const double spectra = static_cast<double>(steps) + 20, sets = touches ? std::min(problem.points(), 20) + 1 : 0;
  const double of_modes = cubic * n * n * n, of_roots = spectra * n * slots * root;
  if (law.reads()) return of_modes + of_roots + spectra * sets * cubic * std::pow(slots * n, 3);
  return (1 + sets) * (of_modes + of_roots);
}

// A step that observation marches, and its energies.
double marched_step_seconds(const std::shared_ptr<const SemiDiscrete>& problem, const StepPlan& plan, double h,
                            const StudyCase& study_case, const Registry& registry) {
  const double unknown = 1e-6 + 2e-8 * problem->dofs();
  try {
    const auto compiled = compile(problem, plan, h, make_law(study_case, registry),
                                  {scene_lane(*problem, study_case.contact.parameters)}, {});
    const auto* program = std::get_if<Program>(&compiled);
    return program ? program->predicted_step_seconds + predict_watch(*program, {.observers = 1, .samples = true})
                   : unknown;
  } catch (const IndefiniteStep&) {
    return unknown;
  }
}

}  // namespace

CasePlan plan_stability(const StudyCase& study_case, const Registry& registry) {
  CasePlan out;
  const auto law = make_law(study_case, registry);
  auto discretised = discretise(study_case.scene, study_case.elements, *make_mass(study_case, registry), law.get(),
                                &study_case.contact.parameters);
  if (const auto* refusal = std::get_if<Refusal>(&discretised)) {
    out.refusal = refusal->sentence.text;
    return out;
  }
  const auto shared = std::make_shared<const SemiDiscrete>(std::move(std::get<SemiDiscrete>(discretised)));
  const SemiDiscrete& problem = *shared;
  out.notes = problem.notes;
  const auto scheme = make_scheme(study_case, registry);
  const std::vector<double> steps = steps_of(study_case);
  const auto made = scheme->plan(steps.front(), problem_facts(problem, *law));
  if (const auto* refusal = std::get_if<Refusal>(&made)) {
    out.refusal = refusal->sentence.text;
    return out;
  }
  out.coarsest_step = std::max(steps.front(), steps.back());
  out.finest_step = std::min(steps.front(), steps.back());
  const bool touches = problem.points() > 0 && !law->absent();
  out.predicted_seconds = spectra_seconds(problem, std::get<StepPlan>(made), *law, touches, steps.size());
  if (!study_case.settings.value("observe", true)) return out;
  if (touches && rests(study_case.scene, problem))
    out.notes.emplace_back(
        "closed: the scene is at rest, so what contact does is predicted and not observed; give it an initial state or "
        "a load");
  for (const double h : steps) {
    out.steps += free_steps;
    if (touches && study_case.duration > 0)
      out.steps += std::clamp(static_cast<long long>(std::min(study_case.duration / h, 1e9)), least_scene_steps,
                              most_scene_steps);
    else if (touches)
      out.steps += 10 * free_steps;
  }
  out.predicted_seconds += static_cast<double>(out.steps) *
                           marched_step_seconds(shared, std::get<StepPlan>(made), steps.front(), study_case, registry);
  return out;
}

}  // namespace ricochet
