#include <algorithm>
#include <atomic>

#include "runners/kinds/bifurcation/run_bifurcation.hpp"
#include "runners/kinds/sweep/rehearsal.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"

namespace ricochet {
namespace {

constexpr std::size_t few_values = 8;  // as many as march abreast

/// What most orbits start from: random states, where there are any. Of orbits that follow each other the first one
/// begins at rest.
Json start_of_most(const Json& starts) {
  for (const Json& start : starts)
    if (start.is_object()) return {{"random", 1}, {"seed", start.at("seed")}};
  return starts.at(0) == "state" ? "state" : "rest";
}

}  // namespace

double rehearse_bifurcation(const StudyCase& study_case, const Registry& registry) {
  // What leaves out steps costs what bench_flight found: in a part on coarser steps few are left out.
  if (study_case.march == "flights") return 0;
  StudyCase part = study_case;
  const std::vector<double> values = parameter_values(part.settings);
  std::vector<double> some;
  for (std::size_t k = 0; k < std::min(values.size(), few_values); ++k)
    some.push_back(values[(2 * k + 1) * values.size() / (2 * std::min(values.size(), few_values))]);
  part.settings["parameter"]["values"] = some;
  part.settings["start"] = Json::array({start_of_most(part.settings.at("start"))});
  part.settings["exponents"] = 0;
  part.settings["refine"] = nullptr;
  return rehearsed(part, registry, plan_bifurcation, run_bifurcation);
}

}  // namespace ricochet
