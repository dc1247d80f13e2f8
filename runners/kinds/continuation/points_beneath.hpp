#pragma once
#include <nlohmann/json.hpp>
#include <vector>

namespace ricochet {

/// Points of the section of a bifurcation study.
struct PointsBeneath {
  std::vector<double> parameter, tip;  ///< tip: m, at the strobe, absolute
  std::size_t stored = 0;              ///< of which these are evenly chosen
};
/// Those of the folder that a study of kind `continuation` names as `beneath`, at most so many. Throws InputError where
/// it holds no strobes at phase 0 of the same scene along the same parameter.
PointsBeneath points_beneath(const nlohmann::ordered_json& study, std::size_t most);
/// Throws what points_beneath() does; nothing where the study names no folder.
void check_beneath(const nlohmann::ordered_json& study);

}  // namespace ricochet
