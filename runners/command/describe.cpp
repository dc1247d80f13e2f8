#include <fmt/format.h>

#include <ostream>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/command/table.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/stated_plan.hpp"

namespace ricochet {
namespace {

const char* type_name(const ParameterSpec& spec) {
  switch (spec.type) {
    case ParameterSpec::Type::real:
      return "number";
    case ParameterSpec::Type::integer:
      return "whole number";
    case ParameterSpec::Type::boolean:
      return "true or false";
    case ParameterSpec::Type::word:
      break;
  }
  return "word";
}

std::string admissible(const ParameterSpec& spec) {
  switch (spec.type) {
    case ParameterSpec::Type::real:
    case ParameterSpec::Type::integer:
      return spec.range.text();
    case ParameterSpec::Type::boolean:
      return "true, false";
    case ParameterSpec::Type::word:
      break;
  }
  std::string words;
  for (const std::string& word : spec.words) words += (words.empty() ? "" : ", ") + word;
  return words;
}

std::string parameter_table(const PluginManual& manual) {
  TextTable table({"parameter", "type", "unit", "default", "range", "meaning"});
  for (const ParameterSpec& spec : manual.parameters)
    table.add({spec.key, type_name(spec), spec.unit, spec.fallback ? plain(to_json(*spec.fallback)) : "required",
               admissible(spec), spec.text + (spec.per_lane ? " (may differ between lanes)" : "")});
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
  out << "  order " << fmt::format("{}", facts.order) << " without contact\n"
      << "  restitution: " << restitution_text(facts.restitution) << "\n"
      << "  mass matrix: " << (facts.needs_regular_mass ? "must be regular" : "may be singular") << "\n"
      << "  stability: "
      << (facts.stability_limit ? fmt::format("h·ω ≤ {:.6g}", *facts.stability_limit)
                                : std::string("no limit on the step"))
      << "\n"
      << "  energy at a contact with a fixed stop: " << (facts.contact_never_gains ? "never gained" : "may be gained")
      << "\n";
}

void print_scheme(const PluginManual& manual, const TimeScheme& scheme, std::ostream& out) {
  constexpr double step = 1e-5;
  ProblemFacts facts;
  facts.dofs = 100;
  facts.damped = true;
  facts.contact = true;
  const PlanOrRefusal answer = scheme.plan(step, facts);
  out << "\n"
      << fmt::format("facts of {} with its default parameters, h = {} s, a regular mass, damping and contact:\n",
                     manual.name, step);
  if (const auto* refusal = std::get_if<Refusal>(&answer)) {
    out << "  refused: " << refusal->sentence << "\n";
    return;
  }
  const auto& plan = std::get<StepPlan>(answer);
  print_facts(plan.facts, out);
  out << "  the step, S z = b + Hᵀp:\n" << indented(print_plan(plan));
}

void print_manual(Role role, const PluginManual& manual, const Registry& registry, std::ostream& out) {
  out << manual.name << " (" << role_name(role) << "): " << manual.summary << "\n\n" << manual.text << "\n\n";
  if (manual.parameters.empty())
    out << "no parameters\n";
  else
    out << "parameters\n" << parameter_table(manual);
  if (!manual.source.empty()) out << "\nsource: " << manual.source << "\n";
  if (const std::string file = registry.file(role, manual.name); !file.empty()) out << "file: " << file << "\n";
  if (role != Role::time) return;
  std::string missing;
  if (const auto parameters = default_parameters(manual, missing))
    print_scheme(manual, *registry.time(manual.name)->make(*parameters), out);
  else
    out << "\nfacts depend on parameters that have no default: " << missing << "\n";
}

// A plan that stands in a file, wherever it is.
int describe_plan(const std::filesystem::path& file, std::ostream& out) {
  const PlanSource source = read_plan_file(file);
  Registry registry;
  try {
    register_plan(source, registry);
  } catch (const InputError& error) {
    throw StudyError(source.explain(error));
  }
  const std::string name = registry.names(Role::time).front();
  print_manual(Role::time, *registry.manual(Role::time, name), registry, out);
  return exit_done;
}

}  // namespace

int command_describe(const Arguments& arguments, std::ostream& out) {
  if (arguments.operands.front().ends_with(".json")) return describe_plan(arguments.operands.front(), out);
  Catalogue catalogue = standard_catalogue(arguments.plugins);
  Registry registry;
  const std::string& name = arguments.operands.front();
  std::vector<std::string> names;
  bool found = false;
  for (const Role role : all_roles) {
    const std::vector<std::string> here = catalogue.names(role);
    names.insert(names.end(), here.begin(), here.end());
    if (!catalogue.require(role, name, registry)) continue;
    if (found) out << "\n----\n\n";
    found = true;
    print_manual(role, *registry.manual(role, name), registry, out);
  }
  if (found) return exit_done;
  for (const Role role : all_roles)
    if (const Unusable* file = catalogue.unusable_provider(role, name))
      throw PluginError(file->file.string() + ": " + file->reason);
  std::string message =
      "no method is called \"" + name + "\"" + did_you_mean(name, names) + " (found: " + quoted_list(names) + ")";
  for (const Unusable& file : catalogue.unusable())
    message += "\n  cannot serve: " + file.file.string() + ": " + file.reason;
  throw UsageError(message);
}

}  // namespace ricochet
