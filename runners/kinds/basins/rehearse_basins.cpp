#include <algorithm>

#include "runners/kinds/basins/run_basins.hpp"
#include "runners/kinds/sweep/rehearsal.hpp"

namespace ricochet {
namespace {

constexpr std::size_t few_cells = 5;  // of each axis

}  // namespace

double rehearse_basins(const StudyCase& study_case, const Registry& registry) {
  StudyCase part = study_case;
  for (Json& axis : part.settings["axes"]) {
    const auto values = axis.at("values").get<std::vector<double>>();
    const std::size_t count = std::min(values.size(), few_cells);
    std::vector<double> some;
    for (std::size_t k = 0; k < count; ++k) some.push_back(values[(2 * k + 1) * values.size() / (2 * count)]);
    axis["values"] = some;
  }
  part.settings["refine"] = false;
  return rehearsed(part, registry, plan_basins, run_basins);
}

}  // namespace ricochet
