#include "runners/study/bases.hpp"

#include <algorithm>

namespace ricochet {
namespace {

std::vector<std::string> words_of(const Json& value) {
  if (value.is_array()) return value.get<std::vector<std::string>>();
  return {value.get<std::string>()};
}

}  // namespace

std::vector<std::optional<BasisSpec>> bases_of(const Json& mesh, bool modal) {
  if (!mesh.contains("modes") && !mesh.contains("residual")) return {std::nullopt};
  if (!mesh.contains("modes") && !modal)
    throw InputError("/mesh/residual", "there is no mesh.modes whose residual it could be; expected modes too");
  std::vector<std::optional<BasisSpec>> bases;
  const Json counts = mesh.value("modes", Json(nullptr));
  for (const Json& modes : counts.is_array() ? counts : Json::array({counts}))
    for (const std::string& residual : words_of(mesh.value("residual", Json("stops"))))
      if (!modes.is_null())
        bases.push_back(BasisSpec{modes.get<int>(), residual == "stops"});
      else if (modal && residual != "stops")
        bases.push_back(BasisSpec{0, false});
      else if (std::find(bases.begin(), bases.end(), std::nullopt) == bases.end())
        bases.emplace_back();
  return bases;
}

}  // namespace ricochet
