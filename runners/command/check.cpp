#include <fmt/format.h>

#include <ostream>

#include "runners/check/checks.hpp"
#include "runners/command/command.hpp"
#include "runners/command/found_methods.hpp"
#include "runners/command/subcommand.hpp"

namespace ricochet {
namespace {

using checking::CheckResult;
using checking::Finding;

std::vector<CheckResult> checked(const Registry& registry, Role role, const std::string& name) {
  const checking::Isolation isolation;
  switch (role) {
    case Role::mass:
      return checking::check_mass(*registry.mass(name), isolation);
    case Role::contact:
      return checking::check_law(*registry.contact(name), isolation);
    case Role::time:
      return checking::check_scheme(*registry.time(name), isolation);
    case Role::reference:
      break;
  }
  return checking::check_reference(*registry.reference(name), isolation);
}

void print(const CheckResult& result, std::ostream& out) {
  constexpr std::size_t indent = 38;
  out << fmt::format("  {:<18}  {:<14}", result.check, checking::finding_word(result.finding));
  bool first = true;
  for (const std::string& sentence : result.sentences) {
    out << (first ? "  " : "\n" + std::string(indent, ' ')) << sentence;
    first = false;
  }
  out << "\n";
}

}  // namespace

int command_check(const Arguments& arguments, std::ostream& out) {
  const checking::FoundMethods found = checking::find_methods(arguments.operands.front(), arguments.plugins);
  int failed = 0, all = 0;
  for (const auto& [role, name] : found.methods) {
    const std::string file = found.registry.file(role, name);
    out << role_name(role) << " " << name << (file.empty() ? "" : " (" + file + ")") << "\n" << std::flush;
    for (const CheckResult& result : checked(found.registry, role, name)) {
      print(result, out);
      ++all;
      if (result.finding == Finding::fails) ++failed;
    }
  }
  out << (failed == 0 ? fmt::format("{} checks, none fails\n", all)
                      : fmt::format("{} of {} checks fail\n", failed, all));
  return failed == 0 ? exit_done : exit_some_failed;
}

}  // namespace ricochet
