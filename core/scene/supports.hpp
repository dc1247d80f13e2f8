#pragma once
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/scene.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {

// Which supports motions move, and what carries stops.

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
/// along with a support that is called like the carrier, a dot and the component. Without one it goes along with the
/// carrier where that holds u₁ or u₂ in the table of dofs. Throws InputError for an unknown name, supports that move
/// apart, one whose way is not known.
std::vector<std::pair<double, int>> carried_by(const SceneSpec& scene, std::size_t number, const MovedSupports& moved);

/// How far a stop moves along its row by a motion of its own of 1: by 1. A side of a clearance moves by its share of
/// the component that the motion says, u₁ where it says none. Throws InputError for another word, and for a
/// component of any other stop.
double own_share(const NamedStop& stop, std::size_t number);

/// Fills names, static modes, loads and places of what holds the structure, and whether it is held.
void hold_by_supports(const StructureSpec& structure, int elements, SemiDiscrete& problem);

/// Names of what holds the structure, in the order of its static modes.
std::vector<std::string> support_names(const StructureSpec& structure);
/// Where each of them holds the displacement of a beam or bar, m; NaN where it holds none.
std::vector<double> support_places(const StructureSpec& structure);

/// What supports that stand at these places add to the displacement at x by themselves: number and weight.
std::vector<std::pair<int, double>> held_by(const std::vector<double>& supports, const FiniteElementSpace& space,
                                            double x, ShapeOf what = ShapeOf::displacement);

/// Columns of supports to columns of motions: the sum over those that each moves.
Eigen::MatrixXd of_motions(const SupportMotions& motions, const Eigen::MatrixXd& shapes);

/// Throws InputError for an unknown support, one that two motions move, a harmonic support beside motions, a frame or a
/// carrier without motions. The same for a stop that would move with supports that move apart.
void check_motions(const SceneSpec& scene);

/// Fills the motions of a problem whose supports, contact points and tip are known, and adds −Σ s_j φ_j'' to its load.
/// `on_supports` (m × r): what supports add to contact points by themselves, beside H ψ.
void add_motions(const SceneSpec& scene, const Eigen::MatrixXd& on_supports, SemiDiscrete& problem,
                 DistributedLoad& load);

/// The same, and the harmonic motion of all supports. Where these lift the stops alike (of given matrices
/// the tip too), it stays the support of the problem. Of given matrices its shape is then Σ s_j. Where they do not, it
/// is a motion of them all.
void add_support(const SceneSpec& scene, const Eigen::MatrixXd& on_supports, SemiDiscrete& problem,
                 DistributedLoad& load);

/// Whether the harmonic support of a scene becomes such a motion. Throws InputError for places that are not there.
bool support_bends(const SceneSpec& scene);

}  // namespace ricochet
