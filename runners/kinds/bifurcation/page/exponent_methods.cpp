#include <map>

#include "runners/kinds/bifurcation/page/page.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"

namespace ricochet::report {

Table exponent_methods(const CaseView& view) {
  Table out{"exponent_methods",
            "One row per method of exponents: how many orbits it was used for.",
            {{"method", "", "tangent, tangent+jump or twin."},
             {"orbits", "1", "Orbits whose exponents come from it."},
             {"all", "1", "Orbits with exponents, over all methods."},
             {"marginal", "1", "Orbits of all methods that have a root on the unit circle by themselves."}},
            {}};
  std::map<std::string, size_t> counts;
  size_t all = 0, marginal = 0;
  for (const CaseRecord* record : view.all())
    for (const OrbitRow& orbit : orbits_of(*record)) {
      if (!orbit.largest_exponent()) continue;
      ++counts[orbit.exponent_method];
      ++all;
      marginal += !orbit.marginal.empty();
    }
  for (const auto& [method, count] : counts) out.rows.push_back({method, count, all, marginal});
  return out;
}

}  // namespace ricochet::report
