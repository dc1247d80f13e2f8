#include "runners/plan_files/plan_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ricochet/contract/stage_facts.hpp>

#include "runners/json/json_text.hpp"
#include "runners/plan_files/plan_reader.hpp"

namespace ricochet {
namespace {

/// Formulas are evaluated anew for each plan: nothing is shared between threads but the text.
class PlanScheme final : public TimeScheme {
 public:
  PlanScheme(std::shared_ptr<const PlanSource> source, Parameters parameters)
      : source_(std::move(source)), parameters_(std::move(parameters)) {}

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    try {
      const JsonPlace place(source_->plan, source_->pointer);
      PlanValues values(place, h, facts, parameters_, Finite::demanded);
      if (auto refusal = plan_refusal(place, values)) return *refusal;
      return read_step_plan(place, values);
    } catch (const InputError& error) {
      // The text is sound; it is these parameters that make no plan of it.
      throw std::runtime_error(source_->explain(error));
    }
  }

 private:
  std::shared_ptr<const PlanSource> source_;
  Parameters parameters_;
};

// Some value in the range of a parameter that has no default: enough to read formulas with.
ParameterValue some_value(const ParameterSpec& spec) {
  if (spec.fallback) return *spec.fallback;
  if (spec.type == ParameterSpec::Type::boolean) return false;
  const Range& range = spec.range;
  double value = 1;
  if (std::isfinite(range.low) && std::isfinite(range.high))
    value = 0.5 * (range.low + range.high);
  else if (std::isfinite(range.low))
    value = range.low + 1;
  else if (std::isfinite(range.high))
    value = range.high - 1;
  return value;
}

// Where the sentence of check_plan() points: it begins with the part that is wrong.
std::string pointer_of(const std::string& sentence, const JsonPlace& plan) {
  if (sentence.starts_with("stage ")) {
    const auto stage = std::strtoul(sentence.c_str() + std::strlen("stage "), nullptr, 10);
    return pointer_to(plan.pointer_of("stages"), stage > 0 ? stage - 1 : 0);
  }
  for (const char* key : {"start", "energy", "velocity", "facts"})
    if (sentence.starts_with(key) && plan.has(key)) return plan.pointer_of(key);
  return plan.pointer();
}

void require_well_formed(const JsonPlace& plan, const Parameters& defaults, double h, const ProblemFacts& facts) {
  PlanValues values(plan, h, facts, defaults, Finite::demanded);
  if (plan_refusal(plan, values)) return;
  const StepPlan step = read_step_plan(plan, values);
  auto wrong = check_plan(step);
  // A plan of numbers cannot tell its h; this one can.
  if (const double own = wrong ? 0.0 : derive(step).h; own != 0 && !(std::abs(own - h) <= 2e-8 * h))
    wrong = fmt::format("a step of {:g} s carries a free mass at 1 m/s by {:g} m", h, own);
  if (wrong)
    throw InputError(pointer_of(*wrong, plan),
                     fmt::format("with the default parameters and h = {:g} s the plan is ill-formed: {}", h, *wrong));
}

}  // namespace

std::string PlanSource::explain(const InputError& error) const {
  if (file.empty()) return error.pointer().empty() ? error.what() : "at " + error.pointer() + ": " + error.what();
  return explained(error, file.string(), text);
}

PlanSource read_plan_file(const std::filesystem::path& file) {
  PlanSource source;
  source.file = file;
  try {
    source.text = read_text(file, "a plan");
    source.plan = parse_json(source.text);
  } catch (const InputError& error) {
    throw InputError("", source.explain(error));
  }
  return source;
}

PluginManual check_plan_source(const PlanSource& source) {
  const JsonPlace plan(source.plan, source.pointer);
  PluginManual manual = read_plan_manual(plan);
  constexpr double h = 1e-3;
  ProblemFacts facts;
  facts.dofs = 1;
  facts.damped = facts.contact = true;
  Parameters sample;
  bool complete = true;
  for (const ParameterSpec& spec : manual.parameters) {
    sample.set(spec.key, some_value(spec));
    complete = complete && spec.fallback.has_value();
  }
  PlanValues values(plan, h, facts, sample, Finite::ignored);
  plan_refusal(plan, values);
  read_step_plan(plan, values);
  if (complete) require_well_formed(plan, sample, h, facts);
  return manual;
}

void register_plan(const PlanSource& source, Registry& registry) {
  PluginManual manual = check_plan_source(source);
  const auto shared = std::make_shared<const PlanSource>(source);
  registry.set_current_file(source.file.string());
  registry.add_time(std::move(manual), [shared](const Parameters& parameters) {
    return std::make_unique<PlanScheme>(shared, parameters);
  });
  registry.set_current_file("");
}

}  // namespace ricochet
