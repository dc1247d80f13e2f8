#pragma once
#include <ricochet/scene/scene.hpp>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Which supports motions move, and what carries stops.
namespace ricochet {

/// The supports that each motion moves, and the motion of each support, −1 where it rests.
struct MovedSupports {
  std::vector<std::vector<std::size_t>> supports;
  std::vector<int> motion;
};
/// Throws InputError for an unknown support, one that two motions move, a component that no support moves along.
MovedSupports moved_supports(const SceneSpec& scene);

/// The support that a stop names as what carries it, and where the study says so.
const std::string& carrier_of(const SceneSpec& scene, std::size_t stop);
std::string carrier_pointer(const SceneSpec& scene, std::size_t stop);

/// What carries a stop: shares of motions (−1: supports at rest) in the displacement that it bounds. A clearance goes
/// along with a support that holds u₁ or u₂ in the table of dofs, or is called like the carrier, a dot and the
/// component. Throws InputError for an unknown name, supports that move apart, one whose way is not known.
std::vector<std::pair<double, int>> carried_by(const SceneSpec& scene, std::size_t number, const MovedSupports& moved);

/// How far a stop moves along its row by a motion of its own of 1: by 1, a side of a clearance by its share of the
/// component that the motion says, u₁ where it says none. Throws InputError for another word.
double own_share(const NamedStop& stop, std::size_t number);

}  // namespace ricochet
