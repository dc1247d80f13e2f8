// Every contact law with every scheme on every mass, on a beam that rubs at its tip: it runs, or says why not.
#include <map>

#include "tests/engine/rubbing.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// A tube of steel that strikes its stop at the tip, whose surface turns there.
SceneSpec striking_beam() {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-5;
  scene.initial.displacement = Formula(0.0);
  NamedStop stop{.name = "tip", .at = {}, .to = {}, .lower = -0.02, .upper = 0.02};
  stop.at.x = 1.501;
  stop.tangent = TangentSpec{.slope_radius = 0.005, .direction = {}, .component = "", .speed = 0};
  stop.friction = FrictionSpec{0.2, 0.2};
  scene.stops = {};
  scene.stops.named = {stop};
  return scene;
}

// What a manual leaves to the study, as studies/family-matrix.json chooses it.
Choice fitting(const PluginManual& manual) {
  static const std::map<std::string, double> values{{"stiffness", 1e5},   {"augmentation", 1e7}, {"damping", 0.2},
                                                    {"restitution", 0.8}, {"viscosity", 10},     {"yield_force", 20},
                                                    {"gamma0", 10},       {"force", 10},         {"length", 1e-3}};
  Choice out{manual.name, {}};
  for (const ParameterSpec& spec : manual.parameters) {
    const auto known = values.find(spec.key);
    if (spec.fallback) continue;
    if (spec.type == ParameterSpec::Type::table)
      out.values[spec.key] = ParameterTable{{0, 0}, {1e-3, 100}};
    else
      out.values[spec.key] = known != values.end() ? known->second : 1.0;
  }
  return out;
}

struct Tally {
  int ran = 0, refused = 0;
};

/// One combination from its start to its end, or why it does not run.
struct Run {
  std::string refused;
  bool ended_well = false;
  double residual = 0;
  EnergyTotals energy;
  bool balances = false;
};

Run run_of(const SceneSpec& scene, const Methods& methods, double h) {
  Run out;
  const auto law = make(registry().contact(methods.contact.name), methods.contact);
  const auto parameters = complete(registry().contact(methods.contact.name)->manual.parameters, methods.contact.values);
  auto problem = discretise(scene, 2, *make(registry().mass(methods.mass.name), methods.mass), law.get(), &parameters);
  if (const auto* refusal = std::get_if<Refusal>(&problem)) {
    out.refused = refusal->sentence.text;
    return out;
  }
  auto program = compiled(std::make_shared<const SemiDiscrete>(std::get<SemiDiscrete>(problem)), methods, h);
  if (const auto* refusal = std::get_if<Refusal>(&program)) {
    out.refused = refusal->sentence.text;
    return out;
  }
  Marcher made(std::move(std::get<Program>(program)));
  EnergyAudit audit(made);
  FrictionWatch watch(made, audit, {0, 0.02, 1});
  const Observers observers{&audit, &watch};
  made.start(observers);
  made.march(std::llround(0.02 / h) - made.step(), observers);
  INFO(text(made.status(0).end));
  out.ended_well = made.status(0).running && made.position(0).allFinite();
  CHECK(out.ended_well);
  out.residual = watch.residual();
  out.energy = audit.totals(0);
  out.balances = audit.balances();
  return out;
}

SceneSpec without_friction(SceneSpec scene) {
  for (NamedStop& stop : scene.stops.named) stop.friction.reset();
  return scene;
}

// Friction leaves no more of the balance open than the motion without it: a large acceleration of what has no mass
// leaves its round-off.
void check_balance(const SceneSpec& scene, const Methods& methods, double h, const EnergyTotals& energy) {
  const double open = std::abs(energy.balance_residual()), small = 1e-9 * energy.first.common();
  if (open <= small) return;
  CHECK(open <= 4 * std::abs(run_of(without_friction(scene), methods, h).energy.balance_residual()) + small);
}

// An impact turns what slides: of its work the part along the surface may be positive, that of both is not. What a step
// gains at a reversal under load is of order 1.
void check_heat(const SceneSpec& scene, const Methods& methods, double h, const EnergyTotals& energy) {
  const double small = 1e-9 * energy.first.common();
  if (energy.work_of_friction <= small || energy.work_of_friction + energy.work_of_contact <= small) return;
  CHECK(run_of(scene, methods, h / 8).energy.work_of_friction <= 0.25 * energy.work_of_friction);
}

}  // namespace

TEST_CASE("friction: every law, scheme and mass runs with it or says why not", "[friction]") {
  constexpr double h = 1e-4;
  const SceneSpec scene = striking_beam();
  std::map<std::string, Tally> laws, schemes, masses;
  for (const std::string& mass : registry().names(Role::mass))
    for (const std::string& contact : registry().names(Role::contact))
      for (const std::string& time : registry().names(Role::time)) {
        INFO(mass << ", " << contact << ", " << time);
        const Methods methods{{mass}, fitting(registry().contact(contact)->manual), {time}};
        Tally* all[] = {&laws[contact], &schemes[time], &masses[mass]};
        const Run one = run_of(scene, methods, h);
        for (Tally* tally : all) ++(one.refused.empty() ? tally->ran : tally->refused);
        if (!one.refused.empty()) {
          CHECK(one.refused.size() > 20);
          continue;
        }
        CHECK(one.residual <= 1e-10);
        if (!one.balances) continue;
        check_balance(scene, methods, h, one.energy);
        check_heat(scene, methods, h, one.energy);
      }
  // What never runs with friction does not run here without it either.
  for (const auto& [mass, tally] : masses)
    for (const std::string& time : registry().names(Role::time)) {
      if (tally.ran > 0) break;
      INFO(mass << ", " << time);
      CHECK_FALSE(
          run_of(without_friction(scene), {{mass}, {"penalty", {{"stiffness", 1e5}}}, {time}}, h).refused.empty());
    }
  int ran = 0;
  for (const auto* all : {&laws, &schemes})
    for (const auto& [name, tally] : *all) {
      INFO(name);
      CHECK(tally.ran > 0);
    }
  for (const auto& [mass, tally] : masses) ran += tally.ran;
  CHECK(ran > 1500);
}
