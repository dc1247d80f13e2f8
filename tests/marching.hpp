#pragma once
#include <cstdlib>
#include <functional>
#include <map>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <sstream>
#include <string>

#include "tests/places.hpp"
#include "tests/scene/working_set.hpp"

/// \file
/// From a scene and the names of three methods to a marcher, as a study would do it.
namespace ricochet::testing {

struct Choice {
  std::string name;
  std::map<std::string, ParameterValue> values = {};
};

struct Methods {
  Choice mass{"singular"}, contact{"signorini"}, time{"newmark-dumont-paoli"};
};

/// Our plugins, and those of RICOCHET_PLUGIN_PATH: whoever puts a plugin there has subscribed to the conformance suite.
inline Registry& registry() {
  static Catalogue catalogue = [] {
    std::vector<std::filesystem::path> folders;
    if (const char* path = std::getenv("RICOCHET_PLUGIN_PATH")) {
      std::istringstream parts{std::string(path)};
      for (std::string part; std::getline(parts, part, ':');)
        if (!part.empty()) folders.emplace_back(part);
    }
    return Catalogue(tests::places().plugins, folders, {});
  }();
  static Registry all = [] {
    Registry opened;
    catalogue.open_all(opened);
    return opened;
  }();
  return all;
}

inline Parameters complete(const std::vector<ParameterSpec>& specs, std::map<std::string, ParameterValue> values) {
  for (const auto& spec : specs)
    if (spec.fallback && !values.contains(spec.key)) values[spec.key] = *spec.fallback;
  return Parameters(values);
}

template <class Interface>
std::unique_ptr<Interface> make(const Entry<Interface>* entry, const Choice& choice) {
  REQUIRE(entry);
  return entry->make(complete(entry->manual.parameters, choice.values));
}

/// Without a law, the problem of laws that do not change it.
inline std::shared_ptr<const SemiDiscrete> problem_of(const SceneSpec& scene, int elements, const Choice& mass,
                                                      const std::optional<Choice>& contact = {}) {
  const auto* entry = contact ? registry().contact(contact->name) : nullptr;
  const auto law = contact ? make(entry, *contact) : nullptr;
  const Parameters parameters = contact ? complete(entry->manual.parameters, contact->values) : Parameters();
  return std::make_shared<const SemiDiscrete>(
      discretised(scene, elements, *make(registry().mass(mass.name), mass), law.get(), law ? &parameters : nullptr));
}

inline PlanOrRefusal plan_of(const Choice& time, double h, const ProblemFacts& facts) {
  return make(registry().time(time.name), time)->plan(h, facts);
}

using Lanes = std::function<std::vector<LaneSpec>(const LaneSpec&)>;
inline std::vector<LaneSpec> one_lane(const LaneSpec& lane) {
  return {lane};
}

inline ProgramOrRefusal compiled(const std::shared_ptr<const SemiDiscrete>& problem, const Methods& methods, double h,
                                 const CompileOptions& options = {}, const Lanes& lanes = one_lane) {
  const auto* entry = registry().contact(methods.contact.name);
  auto law = make(entry, methods.contact);
  auto plan = plan_of(methods.time, h, problem_facts(*problem, *law));
  if (auto* refusal = std::get_if<Refusal>(&plan)) return *refusal;
  const LaneSpec lane = scene_lane(*problem, complete(entry->manual.parameters, methods.contact.values));
  CompileOptions chosen = options;
  if (!problem->rubbing.empty() && !chosen.make_friction)
    chosen.make_friction = [] { return make(registry().friction("coulomb"), {"coulomb"}); };
  return compile(problem, std::get<StepPlan>(plan), h, std::move(law), lanes(lane), chosen);
}

inline Marcher marcher(const SceneSpec& scene, int elements, const Methods& methods, double h,
                       const CompileOptions& options = {}, const Lanes& lanes = one_lane) {
  auto program = compiled(problem_of(scene, elements, methods.mass, methods.contact), methods, h, options, lanes);
  INFO((std::holds_alternative<Refusal>(program) ? std::get<Refusal>(program).sentence.text : ""));
  REQUIRE(std::holds_alternative<Program>(program));
  return Marcher(std::move(std::get<Program>(program)));
}

/// Starts and marches until `duration` (a whole number of steps), under the audit.
inline EnergyAudit audited(Marcher& made, double duration) {
  EnergyAudit audit(made);
  made.start(&audit);
  made.march(std::llround(duration / made.program().h) - made.step(), &audit);
  return audit;
}

/// Starts and marches without an observer.
inline void run(Marcher& made, double duration) {
  made.start();
  made.march(std::llround(duration / made.program().h) - made.step());
}

/// The tip at every step, of a time integration that runs to its end.
inline std::vector<double> tip_history(const SceneSpec& scene, int elements, const Methods& methods, double h,
                                       double duration, const CompileOptions& options = {}) {
  Marcher made = marcher(scene, elements, methods, h, options);
  made.start();
  std::vector<double> out;
  for (long long n = made.step(); n < std::llround(duration / h); ++n) {
    made.march(1);
    out.push_back(made.tip(0));
  }
  REQUIRE(made.status(0).running);
  return out;
}

inline double largest_gap(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

inline double line_density(const SceneSpec& scene) {
  const auto& beam = std::get<BeamSpec>(scene.structure);
  return section_properties(beam.section, beam.young, beam.density).rhoS;
}

/// Displacements of the contact points after each step.
inline std::vector<Eigen::VectorXd> contact_history(const SceneSpec& scene, int elements, const Methods& methods,
                                                    double h, double duration) {
  Marcher made = marcher(scene, elements, methods, h);
  made.start();
  std::vector<Eigen::VectorXd> out;
  for (long long n = made.step(); n < std::llround(duration / h); ++n) {
    made.march(1);
    out.push_back(made.program().problem->contact * made.position(0));
  }
  REQUIRE(made.status(0).running);
  return out;
}

}  // namespace ricochet::testing
