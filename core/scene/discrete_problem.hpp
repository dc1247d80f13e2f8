#pragma once
#include <ricochet/contract/reference.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <vector>

namespace ricochet {

/// The problem as references of the semi-discrete problem are given it: the matrices that a method would march, dense,
/// and rows that give w and its strain at `places` (x, m). A load that depends on t is given by its value at 0.
DiscreteProblem discrete_problem(const SemiDiscrete& problem, const std::vector<double>& places);

/// The displacement at `places` (x, m) as rows (places × n); of matrices that are given, which have no x, that of the
/// tip.
SparseRows place_rows(const SemiDiscrete& problem, const std::vector<double>& places);

/// The strains that the elastic energy integrates, at `places` (x, m), as rows (places × n); zero without elements.
SparseRows strain_rows(const SemiDiscrete& problem, const std::vector<double>& places);

}  // namespace ricochet
