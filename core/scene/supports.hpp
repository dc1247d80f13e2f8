#pragma once
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {

/// Fills names, static modes, loads and places of what holds the structure, and whether it is held.
void hold_by_supports(const StructureSpec& structure, int elements, SemiDiscrete& problem);

/// Throws InputError for an unknown support, one that two motions move, a stop that would move with supports that move
/// apart or rest, a frame without motions.
void check_motions(const SceneSpec& scene);

/// Fills the motions of a problem whose supports, contact points and tip are known, and adds −Σ s_j φ_j'' to its load.
/// `on_supports` (m × r): what supports add to contact points by themselves, beside H ψ.
void add_motions(const SceneSpec& scene, const Eigen::MatrixXd& on_supports, SemiDiscrete& problem,
                 DistributedLoad& load);

}  // namespace ricochet
