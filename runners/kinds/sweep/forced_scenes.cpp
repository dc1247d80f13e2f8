#include "runners/kinds/sweep/forced_scenes.hpp"

#include <algorithm>
#include <numbers>
#include <ricochet/scene/checks.hpp>

#include "runners/kinds/sweep/forcing.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

// Parameters of the law that need a law of their own: all but those that may differ between lanes.
std::map<std::string, ParameterValue> shared_parameters(const Parameters& all, const PluginManual& manual) {
  std::map<std::string, ParameterValue> shared = all.values();
  for (const ParameterSpec& spec : manual.parameters)
    if (spec.per_lane) shared.erase(spec.key);
  return shared;
}

}  // namespace

ForcedScenes::ForcedScenes(const StudyCase& study_case, const Registry& registry)
    : case_(study_case), registry_(registry), groups_(march_way(study_case)) {}

int ForcedScenes::add(SceneVariant variant) {
  const int number = count();
  scenes_.emplace_back();
  ForcedScene& scene = scenes_.back();
  scene.variant = std::move(variant);
  try {
    const StudyCase one = with_parameters(scene.variant.own_state ? case_ : at_rest(case_), scene.variant.values);
    scene.pulsation = forcing_pulsation(one.scene);
    const auto* entry = registry_.contact(one.contact.name);
    LaneCandidate candidate;
    candidate.h = 2 * std::numbers::pi / scene.pulsation / one.steps_per_period;
    candidate.scheme = one.time.parameters.values();
    candidate.law = shared_parameters(one.contact.parameters, entry->manual);
    candidate.make_law = [entry, parameters = one.contact.parameters] { return entry->make(parameters); };
    candidate.make_friction = friction_maker(one, registry_);
    candidate.friction = one.friction.parameters.values();
    const auto law = make_law(one, registry_);
    auto made = discretise(one.scene, one.elements, *make_mass(one, registry_), law.get(), &one.contact.parameters);
    if (const auto* refusal = std::get_if<Refusal>(&made)) {
      scene.refusal = refusal->sentence;
      return number;
    }
    candidate.problem = std::make_shared<const SemiDiscrete>(std::move(std::get<SemiDiscrete>(made)));
    scene.lane = candidate.lane = scene_lane(*candidate.problem, one.contact.parameters);
    const auto scheme = make_scheme(one, registry_);
    const auto plan_at = [&, facts = problem_facts(*candidate.problem, *law)](double h) {
      return scheme->plan(h, facts);
    };
    const auto plan = plan_at(candidate.h);
    if (const auto* refusal = std::get_if<Refusal>(&plan)) {
      scene.refusal = refusal->sentence;
      return number;
    }
    candidate.plan = std::get<StepPlan>(plan);
    const auto problem = candidate.problem;
    const double h = candidate.h;
    scene.group = groups_.add(std::move(candidate));
    if (reference_ < 0) reference_ = number;
    if (scene.group == static_cast<int>(beyond_limit_.size()))
      beyond_limit_.push_back(beyond_explicit_limit(problem, std::get<StepPlan>(plan), h, plan_at));
    scene.refusal = beyond_limit_[static_cast<std::size_t>(scene.group)];
  } catch (const IndefiniteStep& wrong) {
    name_indefinite(wrong, case_, registry_);
  } catch (const InputError& error) {
    scene.refusal = (error.pointer().empty() ? "" : error.pointer() + ": ") + error.what();
    scene.no_start = dynamic_cast<const BeyondStop*>(&error) != nullptr;
  } catch (const Refusal& refusal) {
    scene.refusal = refusal.sentence;
  }
  return number;
}

int ForcedScenes::add(const std::string& pointer, double value, bool own_state) {
  return add({{{pointer, value}}, own_state});
}

std::vector<std::pair<std::string, std::string>> march_left_out(const ForcedScenes& scenes,
                                                                const StudyCase& study_case) {
  auto pairs = left_out_pairs(scenes.left_out(0));
  if (study_case.settings.value("exponents", 0) > 0)
    std::erase_if(pairs, [](const auto& pair) { return pair.first == "tangent columns"; });
  return pairs;
}

void widen_steps(CasePlan& plan, const StudyCase& study_case) {
  const double step = 2 * std::numbers::pi / forcing_pulsation(study_case.scene) / study_case.steps_per_period;
  plan.coarsest_step = std::max(plan.coarsest_step, step);
  plan.finest_step = plan.finest_step > 0 ? std::min(plan.finest_step, step) : step;
}

}  // namespace ricochet
