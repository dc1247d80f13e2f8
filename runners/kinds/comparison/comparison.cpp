#include "runners/kinds/comparison/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/motion/motion_sampler.hpp>
#include <set>
#include <string_view>

#include "runners/asks/kind_verbs.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/kinds/comparison/references.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/trajectory/stop_tables.hpp"
#include "runners/kinds/trajectory/trajectory.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {

namespace {

/// What the eight errors are: their measures are `error.NAME`, `floor.NAME` and `size.NAME`, in this unit.
struct ErrorInfo {
  std::string name;
  const char *unit, *text, *words;
  bool reads_velocity = false;
  std::string error = "error." + name, floor = "floor." + name, size = "size." + name;
};

const std::vector<ErrorInfo>& error_infos() {
  static const std::vector<ErrorInfo> all = {
      {"tip-linf", "m", "Largest difference of the tip's displacement from the reference, over the samples.",
       "the largest error of the tip"},
      {"tip-l2", "m", "Root mean square over time of the difference of the tip's displacement.",
       "the root mean square error of the tip"},
      {"displacement-l2", "m^3/2",
       "Root mean square over time of the L² norm along x of the difference of the displacement; of an oscillator, "
       "which has no x, in m.",
       "the error of the displacement"},
      {"displacement-h2", "m^-1/2",
       "Root mean square over time of the L² norm of the difference of the curvature (a bar: of the strain).",
       "the error of the curvature"},
      {"velocity-l2", "m^3/2/s",
       "Root mean square over time of the L² norm of the difference of the velocity; of an oscillator, in m/s.",
       "the error of the velocity", true},
      {"energy", "J", "Mean over time of the modulus of the difference of the mechanical energy.",
       "the error of the energy", true},
      {"impact-times", "s",
       "Largest distance from an impact of either motion to the nearest of the other on the same side. One while the "
       "reference is in contact is at none.",
       "the error of the impact times"},
      {"impulse", "N s", "Largest difference of the impulse so far: the contact force in the dual norm of W^{1,1}.",
       "the error of the impulse"}};
  return all;
}

}  // namespace

const std::vector<std::string>& error_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const ErrorInfo& one : error_infos()) out.push_back(one.name);
    return out;
  }();
  return names;
}

std::string error_words(const std::string& error) {
  for (const ErrorInfo& one : error_infos())
    if (one.name == error) return one.words;
  return "the error of " + error;
}

ShownOrder shown_order(const CaseRecord& record, const std::string& error) {
  ShownOrder out{measure(record, "declared_order")};
  const std::vector<ErrorInfo>& all = error_infos();
  const bool velocity =
      std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.name == error && one.reads_velocity; });
  const auto reading = velocity ? measure(record, "velocity_order") : std::nullopt;
  if (!out.order || !reading || *reading >= *out.order) return out;
  out.because = fmt::format("velocities are read by order {:g}, the scheme declares {:g}", *reading, *out.order);
  out.order = reading;
  return out;
}

std::vector<Field> comparison_keys() {
  using namespace keys;
  Field reference =
      methods("reference", Role::reference,
              "A reference, \"self\" (the method on finer steps and meshes) or a list, whose first counts; its gap to "
              "the others, where less than the motion, enters the error floor.");
  reference.marched = true;
  Field errors = of_form(Field::Form::words, "errors", std::nullopt, "Errors.");
  errors.spec = word_parameter("errors", error_names(), std::nullopt, errors.spec.text.c_str());
  errors.fallback = Json(error_names());
  return {step(),
          duration(),
          samples(),
          march("every-step"),
          std::move(reference),
          std::move(errors),
          optional(real("horizon", "s", positive, std::nullopt,
                        "End of the comparison; null: the end, or where two nearby runs have drifted apart.")),
          budget()};
}

void check_comparison(const Json& study) {
  if (const auto horizon = study.find("horizon"); horizon != study.end() && !horizon->is_null())
    if (horizon->get<double>() > study["duration"].get<double>())
      throw InputError("/horizon", fmt::format("a horizon of {} s lies beyond the duration of {} s",
                                               horizon->get<double>(), study["duration"].get<double>()));
}

namespace {

InputError no_reference(const std::set<std::string>& refusals) {
  return {"/reference", fmt::format("no reference applies to this scene: {}; \"{}\" applies wherever the methods march",
                                    fmt::join(refusals, "; "), marched_reference)};
}

bool marches_itself(const StudyCase& one) {
  return std::any_of(one.references.begin(), one.references.end(),
                     [](const MethodChoice& choice) { return choice.name == marched_reference; });
}

// A study none of whose cases has a reference is told so before anything runs. Where it marches its methods themselves,
// what these refuse is theirs to say, in the rows of their cases.
void require_reference(const Study& study, References& references, const CheckpointStore& checkpoints,
                       const std::atomic<bool>& stop) {
  std::set<std::string> refusals;
  for (const StudyCase& one : study.cases) {
    if (one.excluded) continue;
    if (marches_itself(one)) return;
    if (checkpoints.failed && checkpoints.failed(one.id)) return;
    try {
      const ReferenceSet set = references.of(one, stop);
      if (!set.applicable.empty()) return;
      for (const Said& refusal : set.refusals) refusals.insert(refusal.text);
    } catch (const Interrupted&) {
      throw;
    } catch (const InputError&) {
      throw;
    } catch (...) {
      return;  // a method or a reference that fails is told in the rows of its cases
    }
  }
  if (!refusals.empty()) throw no_reference(refusals);
}

// Said by a plan as well, where the beginnings that it solves tell: of all cases, of which it may see a part.
void require_some(const References& references, const Study& study) {
  std::vector<const StudyCase*> cases;
  for (const StudyCase& one : study.cases) {
    if (marches_itself(one)) return;
    if (!one.excluded) cases.push_back(&one);
  }
  const References::Solutions all = references.solutions(cases);
  if (all.none_applies()) throw no_reference(all.refusals);
}

}  // namespace

Json comparison_settings(const Json& resolved) {
  return given_settings(resolved, {"reference", "errors", "horizon", "repeats", "budget"});
}

CaseRunner compare_cases(const RunContext& context) {
  // Made when the store is open.
  const auto references = std::make_shared<std::unique_ptr<References>>();
  CaseRunner runner;
  runner.open = [references, &study = context.study, &registry = context.registry](CheckpointStore checkpoints,
                                                                                   const std::atomic<bool>& stop) {
    if (!*references) *references = std::make_unique<References>(study, registry, checkpoints);
    require_reference(study, **references, checkpoints, stop);
  };
  runner.run = [references, &registry = context.registry](const StudyCase& study_case, const std::atomic<bool>& stop) {
    return run_comparison(study_case, registry, **references, stop);
  };
  return runner;
}

double seconds_beside(const ForecastContext& context) {
  // Reading a motion at 128 places, and measuring it against the reference, for each of its samples; of an oscillator
  // there is one place.
  constexpr double per_sample = 1.2e-5, per_sample_of_one_place = 2e-6;
  const References references(context.study, context.registry, {});
  const References::Solutions solved = references.solutions(context.cases);
  if (solved.none_applies()) require_some(references, context.study);
  double seconds = solved.seconds;
  for (const auto& [study_case, steps, times] : references.marches(context.cases))
    seconds += steps * times * context.step_seconds(*study_case);
  for (const StudyCase* one : context.cases) {
    const double repeats = one->settings.value("repeats", 0.0);
    const bool one_place = std::holds_alternative<OscillatorSpec>(one->scene.structure);
    seconds += (one_place ? per_sample_of_one_place : per_sample) * (one->samples + 1) +
               repeats * one->duration / one->step * context.step_seconds(*one);
  }
  return seconds;
}

std::string errors_text(const CaseRecord& record) {
  constexpr std::size_t shown = 3;
  const std::string prefix = "error.";
  std::vector<std::string> parts;
  for (const auto& [name, value] : record.measures)
    if (name.starts_with(prefix) && parts.size() < shown)
      parts.push_back(fmt::format("{} {:.2e}", name.substr(prefix.size()), value));
  return parts.empty() ? energies_text(record) : fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<MeasureInfo> comparison_measures() {
  using Of = MeasureInfo::Of;
  std::vector<MeasureInfo> all = {
      {"horizon", "s", "Time up to which the motion is compared with its reference.", Of::computation},
      {"reference_of_mesh", "1",
       "1 where the reference has the case's own mesh, so that the error is the time scheme's; 0 where it has none.",
       Of::computation},
      {"reference_of_law", "1",
       "1 where the reference has the case's own stops. 0 where it has rigid ones and the case a compliant law: the "
       "error is then the law's as well.",
       Of::computation},
      {"declared_order", "1", "Order in the step that the scheme declares for such a run.", Of::computation},
      {"velocity_order", "1",
       "Order in the step with which velocities are read: 2 where most samples are at steps, else 3. Errors of "
       "velocity "
       "and energy show no more.",
       Of::computation},
  };
  for (const ErrorInfo& one : error_infos()) {
    MeasureInfo& error = all.emplace_back(MeasureInfo{one.error.c_str(), one.unit, one.text});
    error.reading.words = one.words;
    error.floor = one.floor.c_str();
  }
  for (const ErrorInfo& one : error_infos())
    all.push_back({one.floor.c_str(), one.unit,
                   "What the reference itself is uncertain by: below it the error says nothing.", Of::computation});
  for (const ErrorInfo& one : error_infos())
    all.push_back({one.size.c_str(), one.unit,
                   one.name == "impact-times"
                       ? "The horizon: errors over it are relative ones."
                       : "What this error would be of a motion at rest: errors over it are relative ones.",
                   Of::computation, true});
  for (MeasureInfo& one : all) one.of_each_size = true;
  return all;
}

namespace {

/// What a comparing case knows of its motion: nothing is observed that its march would pay for.
constexpr const char* motion_measures[] = {
    "impacts",    "peak_contact_force", "contact_time",          "tip_displacement_end", "energy_start",
    "energy_end", "active_set_changes", "microseconds_per_step", "steps_visited"};

StudyKind comparison_format(const char* name, const char* text, std::vector<Field> keys, std::vector<std::string> verbs,
                            const std::vector<MeasureInfo>& of_cases, Json (*default_asks)(const Json&)) {
  StudyKind format;
  format.name = name;
  format.text = text;
  format.keys = std::move(keys);
  format.settings = comparison_settings;
  format.check = check_comparison;
  format.verbs = std::move(verbs);
  std::vector<MeasureInfo> known = comparison_measures();
  known.insert(known.end(), of_cases.begin(), of_cases.end());
  for (const char* one : motion_measures) known.push_back({one, "", ""});
  format.check_measure = [alone = asks::measures_alone(known)](const Json& resolved, const std::string& measure,
                                                               const std::string& pointer) {
    if (measure.find('[') == std::string::npos) alone(resolved, measure, pointer);
  };
  format.check_ask = check_error_ask;
  format.default_asks = default_asks;
  return format;
}

}  // namespace

ComparisonKind::ComparisonKind(const char* name, const char* text, std::vector<Field> keys,
                               const std::vector<MeasureInfo>& of_cases, std::vector<std::string> verbs,
                               Json (*default_asks)(const Json&))
    : Kind(comparison_format(name, text, std::move(keys), std::move(verbs), of_cases, default_asks), of_cases) {}

CasePlan ComparisonKind::plan(const StudyCase& study_case, const Registry& registry) const {
  return plan_case(study_case, registry);
}

CaseRecord ComparisonKind::march(const StudyCase& study_case, const Registry& registry,
                                 const std::atomic<bool>& stop) const {
  return run_case(study_case, registry, stop);
}

void ComparisonKind::put_tables(StudyResults& results, const Choices& study,
                                std::vector<Table> (*costs)(const StudyResults&)) {
  results.derived.push_back(errors_table(results));
  results.derived.push_back(orders_table(results));
  results.derived.push_back(order_verdicts_table(results.derived.back()));
  results.derived.push_back(order_runs_table(study));
  if (costs)
    for (Table& table : costs(results)) results.derived.push_back(std::move(table));
  describe_contact(results.cases);
  collect_tables(results);
}

Table ComparisonKind::curve(const StudyResults&) const {
  return curves_head();
}

nlohmann::ordered_json ComparisonKind::alone(const StudyResults& results, const CaseRecord& record) const {
  return minimal_study(results, record);
}

}  // namespace ricochet
