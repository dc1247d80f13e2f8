#include <fmt/format.h>

#include <ostream>
#include <ricochet/contract/friction_facts.hpp>
#include <ricochet/loader/child.hpp>
#include <ricochet/measure/stability/plan_restitution.hpp>
#include <ricochet/measure/stability/step_map.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <sstream>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/load_study.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

std::string parameter_table(const PluginManual& manual) {
  TextTable table({"parameter", "type", "unit", "default", "range", "meaning"});
  for (const ParameterSpec& spec : manual.parameters)
    table.add({spec.key, type_word(spec), spec.unit, spec.fallback ? plain(to_json(*spec.fallback)) : "required",
               admissible_values(spec), spec.text + (spec.per_lane ? " (may differ between lanes)" : "")});
  return table.text(2);
}

// Defaults, or the first key that has none.
std::optional<Parameters> default_parameters(const PluginManual& manual, std::string& missing) {
  Parameters parameters;
  for (const ParameterSpec& spec : manual.parameters) {
    if (!spec.fallback) {
      missing += (missing.empty() ? "" : ", ") + spec.key;
      continue;
    }
    parameters.set(spec.key, *spec.fallback);
  }
  if (!missing.empty()) return std::nullopt;
  return parameters;
}

const char* restitution_text(Restitution restitution) {
  switch (restitution) {
    case Restitution::exact:
      return "exact";
    case Restitution::asymptotic:
      return "asymptotic";
    case Restitution::ignored:
      break;
  }
  return "ignored";
}

std::string indented(const std::string& text) {
  std::string result = "    ";
  for (std::size_t i = 0; i < text.size(); ++i) {
    result += text[i];
    if (text[i] == '\n' && i + 1 < text.size()) result += "    ";
  }
  return result;
}

void print_facts(const SchemeFacts& facts, std::ostream& out) {
  const std::optional<double> contact_order = facts.contact_order;
  out << "  order " << fmt::format("{}", facts.order) << " without contact, "
      << (contact_order ? fmt::format("{}", *contact_order) : std::string("not declared")) << " at rigid stops\n"
      << "  restitution: " << restitution_text(facts.restitution) << "\n"
      << "  mass matrix: " << (facts.needs_regular_mass ? "must be regular" : "may be singular") << "\n"
      << "  stability: "
      << (facts.stability_limit ? fmt::format("h·ω ≤ {:.6g}", *facts.stability_limit)
                                : std::string("no limit on the step"))
      << "\n"
      << "  energy at a contact with a fixed stop: " << (facts.contact_never_gains ? "never gained" : "may be gained")
      << "\n";
}

// What the plan makes of friction at rigid stops; of a scheme without them, by the implicit evaluation.
std::string friction_line(const StepPlan& plan) {
  const bool rigid =
      std::any_of(plan.stages.begin(), plan.stages.end(), [](const Stage& stage) { return stage.impact; });
  const FrictionFacts facts =
      friction_facts(derive(plan), rigid ? std::nullopt : std::optional(Evaluation::implicit_end));
  if (!facts.why_none.empty()) return "none: " + facts.why_none;
  if (!facts.rings.empty()) return facts.rings;
  return fmt::format("a disturbance of the effort of a held point is {:.3g} times as large after a step",
                     facts.held_root);
}

std::string facts_of(const PluginManual& manual, const TimeScheme& scheme) {
  constexpr double step = 1e-5;
  ProblemFacts facts;
  facts.dofs = 100;
  facts.damped = true;
  facts.contact = true;
  const PlanOrRefusal answer = scheme.plan(step, facts);
  std::ostringstream out;
  out << fmt::format("facts of {} with its default parameters, h = {} s, a regular mass, damping and contact:\n",
                     manual.name, step);
  if (const auto* refusal = std::get_if<Refusal>(&answer)) {
    out << "  refused: " << refusal->sentence.text << "\n";
    return out.str();
  }
  const auto& plan = std::get<StepPlan>(answer);
  print_facts(plan.facts, out);
  if (const auto range = restitution_range(plan, step))
    out << fmt::format(
        "  a free mass leaves a rigid stop with {:.3g} to {:.3g} times its speed over the phases of a step, {:.3g} "
        "in the mean\n",
        range->least, range->most, range->mean);
  const auto root = root_at_infinity(plan);
  out << "  highest frequencies: "
      << (root ? fmt::format("a step leaves {:.4g} of them (ρ∞)", *root) : std::string("beyond an explicit step"))
      << "\n";
  out << "  friction: " << friction_line(plan) << "\n";
  out << "  the step, S z = b + Hᵀp:\n" << indented(print_plan(plan));
  return out.str();
}

std::string facts_of(const PluginManual& manual, const MassStrategy& mass) {
  constexpr int elements = 4;
  std::string text = fmt::format("facts of {} with its default parameters, on {} elements:\n", manual.name, elements);
  BeamSpec beam;
  beam.section = {.type = Section::Type::given, .EI = 1, .rhoS = 1};
  for (const StructureSpec& structure : {StructureSpec(beam), StructureSpec(BarSpec{})}) {
    const FiniteElementSpace space = make_space(structure, elements);
    const InertiaOrRefusal answer = mass.build(space);
    if (const auto* refusal = std::get_if<Refusal>(&answer)) {
      text += "  " + space.structure + ": refused: " + refusal->sentence.text + "\n";
      continue;
    }
    const auto& inertia = std::get<Inertia>(answer);
    text += fmt::format("  {}: {} dofs, kernel of dimension {}, {}\n", space.structure, space.dofs,
                        inertia.kernel_dimension,
                        inertia.factored() ? fmt::format("M = Bᵀ C_v⁻¹ B with {} velocities", inertia.coupling.rows())
                        : inertia.inverted() ? std::string("M⁻¹ as a sparse matrix")
                                             : std::string("a sparse matrix"));
  }
  return text;
}

std::string facts_of(const PluginManual& manual, ContactLaw& law, const Parameters& parameters) {
  std::string text = fmt::format("facts of {} with its default parameters:\n", manual.name);
  if (law.absent()) return text + "  no contact at all\n";
  law.prepare(1, {&parameters, 1});
  if (const auto reads = law.reads()) {
    text += fmt::format("  reads the displacement, evaluated {}{}\n", evaluation_word(*reads),
                        law.reads_rate() ? ", and its rate" : "");
    if (law.conserves_energy()) text += "  gives back to the scheme's energy what it stores\n";
    const auto stiffness = constant_stiffness(law);
    if (law.changes_problem())
      text += "  changes the stiffness of the structure and what is measured at its stops, its own with them\n";
    else
      text += stiffness ? fmt::format("  linear: {:g} N/m whatever the depth\n", *stiffness)
                        : std::string("  not linear: spectra of closed contact and linear references leave it out\n");
    text += law.offers_slopes() ? "  exponents by tangents\n" : "  exponents by twins: it offers no slopes\n";
    if (const double layer = law.layer(0); layer > 0)
      text += fmt::format("  acts from {:g} m before the stop\n", layer);
    if (const int kept = law.memory_per_point(); kept > 0)
      text += fmt::format("  keeps {} number{} per point from step to step\n", kept, kept == 1 ? "" : "s");
  } else {
    text += "  reads the impact measure: rigid\n";
  }
  if (const std::string how = law.how_solved(); !how.empty()) text += "  solved: " + how + "\n";
  return text;
}

// What a method says when it is asked. Throws whatever its plugin does wrong.
std::string facts_of(Role role, const PluginManual& manual, const Registry& registry, const Parameters& parameters) {
  switch (role) {
    case Role::mass:
      return facts_of(manual, *registry.mass(manual.name)->make(parameters));
    case Role::contact:
      return facts_of(manual, *registry.contact(manual.name)->make(parameters), parameters);
    case Role::friction: {
      const auto law = registry.friction(manual.name)->make(parameters);
      const double creep = law->creeps(1), way = law->gives_way();
      return fmt::format("facts of {} with its default parameters:\n  a held point {}\n", manual.name,
                         creep > 0 ? fmt::format("creeps by {:g} m/s at its bound", creep)
                         : way > 0 ? fmt::format("gives way by {:g} m per N", way)
                                   : "stays where it is");
    }
    case Role::time:
      return facts_of(manual, *registry.time(manual.name)->make(parameters));
    case Role::reference:
      break;
  }
  const bool of_the_mesh = registry.reference(manual.name)->make(parameters)->of_the_mesh();
  return fmt::format("facts of {} with its default parameters:\n  {}\n", manual.name,
                     of_the_mesh ? "exact in time on the mesh that the methods have"
                                 : "of the structure itself: computed once for all meshes");
}

// Prints the facts; false where the plugin goes wrong instead, which is printed. A foreign one is asked in a child
// process: whatever it does there, this one goes on.
bool print_answers(Role role, const PluginManual& manual, const Catalogue& catalogue, const Registry& registry,
                   const Parameters& parameters, std::ostream& out) {
  constexpr double seconds = 10;
  const auto ask = [&] { return facts_of(role, manual, registry, parameters); };
  const std::string file = registry.file(role, manual.name);
  std::string failure;
  if (!file.empty() && catalogue.foreign(file)) {
    const ChildOutcome outcome = run_in_child(ask, seconds);
    if (outcome.ok())
      out << outcome.text;
    else
      failure = outcome.sentence();
  } else {
    try {
      out << ask();
    } catch (const PluginFault& fault) {
      failure = fault.what();
    }
  }
  if (!failure.empty()) out << "fails: " << failure << "\n";
  return failure.empty();
}

// False where the plugin goes wrong.
bool print_manual(Role role, const PluginManual& manual, const Catalogue& catalogue, const Registry& registry,
                  std::ostream& out) {
  out << manual.name << " (" << role_name(role) << "): " << manual.summary << "\n\n" << manual.text << "\n\n";
  if (manual.parameters.empty())
    out << "no parameters\n";
  else
    out << "parameters\n" << parameter_table(manual);
  if (!manual.source.empty()) out << "\nsource: " << manual.source << "\n";
  if (const std::string file = registry.file(role, manual.name); !file.empty()) out << "file: " << file << "\n";
  out << "\n";
  std::string missing;
  if (const auto parameters = default_parameters(manual, missing))
    return print_answers(role, manual, catalogue, registry, *parameters, out);
  out << "facts depend on parameters that have no default: " << missing << "\n";
  return true;
}

// A plan that stands in a file, wherever it is.
int describe_plan(const std::filesystem::path& file, std::ostream& out) {
  const Registry registry = registry_of_plan(file);
  const std::string name = registry.names(Role::time).front();
  const Catalogue catalogue({}, {}, {});
  return print_manual(Role::time, *registry.manual(Role::time, name), catalogue, registry, out) ? exit_done
                                                                                                : exit_some_failed;
}

}  // namespace

Registry registry_of_plan(const std::filesystem::path& file) {
  const PlanSource source = read_plan_file(file);
  Registry registry;
  try {
    register_plan(source, registry);
  } catch (const InputError& error) {
    throw StudyError(source.explain(error));
  }
  return registry;
}

int command_describe(const Arguments& arguments, std::ostream& out) {
  if (arguments.operands.front().ends_with(".json")) return describe_plan(arguments.operands.front(), out);
  Catalogue catalogue = standard_catalogue(arguments.plugins);
  Registry registry;
  const std::string& name = arguments.operands.front();
  std::vector<std::string> names;
  bool found = false, sound = true;
  for (const Role role : all_roles) {
    const std::vector<std::string> here = catalogue.names(role);
    names.insert(names.end(), here.begin(), here.end());
    if (!catalogue.require(role, name, registry)) continue;
    if (found) out << "\n----\n\n";
    found = true;
    sound = print_manual(role, *registry.manual(role, name), catalogue, registry, out) && sound;
  }
  std::ostringstream words;
  if (describe_word(name, words)) {
    out << (found ? "\n----\n\n" : "") << words.str();
    found = true;
  }
  if (found) return sound ? exit_done : exit_some_failed;
  for (const Role role : all_roles)
    if (const Unusable* file = catalogue.unusable_provider(role, name))
      throw PluginError(file->file.string() + ": " + file->reason);
  const std::vector<std::string> studies = words_of_studies(), results = words_of_results();
  std::vector<std::string> all = names;
  all.insert(all.end(), studies.begin(), studies.end());
  all.insert(all.end(), results.begin(), results.end());
  std::string message = "no method, structure, kind, ask, measure or error is called \"" + name + "\"" +
                        did_you_mean(name, all) + " (methods: " + quoted_list(names) +
                        "; of studies: " + quoted_list(studies) + "; measures: the columns of cases.csv)";
  for (const Unusable& file : catalogue.unusable())
    message += "\n  cannot serve: " + file.file.string() + ": " + file.reason;
  throw UsageError(message);
}

namespace {

std::vector<Role> roles_asked(const Arguments& arguments) {
  if (arguments.operands.empty()) return {all_roles.begin(), all_roles.end()};
  return {role_called(arguments.operands.front())};
}

}  // namespace

Role role_called(const std::string& word, std::vector<std::string> names) {
  for (const Role role : all_roles) {
    if (word == role_name(role)) return role;
    names.emplace_back(role_name(role));
  }
  throw UsageError("there is no role \"" + word + "\"" + did_you_mean(word, names) +
                   " (expected: " + quoted_list(names) + ")");
}

int command_list(const Arguments& arguments, std::ostream& out) {
  const std::vector<Role> roles = roles_asked(arguments);
  Catalogue catalogue = standard_catalogue(arguments.plugins);
  Registry registry;
  // Only the libraries of the roles asked for are opened; one that fails is told, and the others are listed.
  std::vector<Unusable> failed;
  TextTable table({"role", "name", "summary", "file"});
  for (const Role role : roles)
    for (const std::string& name : catalogue.names(role)) {
      try {
        catalogue.require(role, name, registry);
        table.add({role_name(role), name, registry.manual(role, name)->summary, registry.file(role, name)});
      } catch (const PluginError& error) {
        table.add({role_name(role), name, std::string("cannot be used: ") + error.what(), ""});
        failed.push_back({name, error.what()});
      }
    }
  out << table.text();
  for (const Unusable& file : catalogue.unusable())
    out << "\ncannot serve: " << file.file.string() << ": " << file.reason << "\n";
  return failed.empty() ? exit_done : exit_plugin;
}

int command_schema(const Arguments& arguments, std::ostream& out) {
  Catalogue catalogue = standard_catalogue(arguments.plugins);
  Registry registry;
  catalogue.open_all(registry);
  out << study_schema(registry).dump() << "\n";
  return exit_done;
}

}  // namespace ricochet
