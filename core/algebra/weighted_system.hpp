#pragma once
#include <ricochet/algebra/band_ldlt.hpp>
#include <ricochet/contract/mass_strategy.hpp>

namespace ricochet {

/// S = k K + m M as (1) of band_ldlt.hpp: a mass that is not assembled enters through its border, scaled so that both
/// blocks have the same units. K is n × n; m ≥ 0.
QuasiDefinite weighted_system(double k, const SparseMatrix& stiffness, double m, const Inertia& inertia);

}  // namespace ricochet
