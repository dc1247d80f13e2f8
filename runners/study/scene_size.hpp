#pragma once
#include <ricochet/scene/scene.hpp>

namespace ricochet {

/// Throws InputError at /scene/structure for matrices of more than 20 000 dofs, with the time of a step that the cost
/// model predicts.
void check_size(const StructureSpec& structure);

}  // namespace ricochet
