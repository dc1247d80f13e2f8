#include <fmt/format.h>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/store/store.hpp"

namespace ricochet {
namespace {

// "bifurcation or basins".
std::string kinds_with_points() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds())
    if (kind.point) names.push_back(kind.format.name);
  return fmt::format("{}", fmt::join(names, " or "));
}

}  // namespace

int command_point(const Arguments& arguments, std::ostream& out) {
  const StudyResults results = read_store(arguments.operands[0]);
  const Kind* kind = find_kind(results.kind);
  if (!kind || !kind->point)
    throw UsageError(fmt::format("{} holds a study of kind {}; a point is one of kind {}", arguments.operands[0],
                                 results.kind, kinds_with_points()));
  const PointRequest asked{arguments.operands[1], arguments.plugins, arguments.parameter, arguments.start,
                           arguments.cell,        arguments.periods, arguments.samples};
  try {
    return kind->point(results, asked, out);
  } catch (const PointRefused& refused) {
    throw UsageError(refused.what());
  }
}

}  // namespace ricochet
