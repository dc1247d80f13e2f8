#pragma once
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <vector>

/// \file
/// What slides along stops, and what of it rubs.
namespace ricochet {

/// The rows of what slides along a stop: its tangent, or two that span a plane. Of a damper its own row; of the first
/// side of a clearance u₁, u₂ and, of a surface that bends, r θ₁, r θ₂. Empty where nothing is said to slide.
/// `number`: of the stop, for pointers. Throws InputError for a tangent that its place does not have.
std::vector<PlaceRow> surface_rows(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop,
                                   std::size_t number);

/// Throws InputError for tangents that the structure or the place of their stop does not have. The same for those of a
/// stop that rubs along its normal, and for two that are not at right angles.
void check_surfaces(const SceneSpec& scene, const FiniteElementSpace& space);

/// H and, below it, the rows along which stops rub and that are not its own: what efforts push (m and more × n).
SparseRows pushed_rows_of(const SceneSpec& scene, const SemiDiscrete& problem);

/// Fills what rubs of a problem whose tangents are known.
void find_rubbing(const SceneSpec& scene, SemiDiscrete& problem);

/// Where something presses what rubs, states at rest are many: throws InputError at /scene/initial/equilibrium unless
/// the one without friction is asked for.
void check_rest(const InitialSpec& initial, const Equilibrium& found, SemiDiscrete& problem);

/// Why clearances that are met as polygons do not rub: a side pushes along itself alone.
std::optional<Refusal> refuse_polygon(const StopsSpec& stops);

}  // namespace ricochet
