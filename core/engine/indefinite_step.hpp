#pragma once
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/engine/compile.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <stdexcept>
#include <string>

namespace ricochet {

/// What make_operator() throws: S is negative along some motion, beyond round-off. `where` shows it.
struct IndefiniteMatrix {
  std::string where;
};

/// A matrix of a step is negative along some motion, where M is not: somebody's numbers are wrong. A combination that
/// leaves it singular is refused; this is a fault.
class IndefiniteStep : public std::runtime_error {
 public:
  enum class Of {
    scheme,     ///< the plan weighs M, C or K negatively
    law,        ///< the contact law leaves the structure a negative stiffness
    structure,  ///< C, or what else the scene gives, is negative
  };
  IndefiniteStep(Of whose, const std::string& what) : std::runtime_error(what), of(whose) {}
  Of of;
};

/// Throws an IndefiniteStep where a contact law has left the structure a stiffness that is negative along some motion.
void check_stiffness_of_law(const SemiDiscrete& problem);

/// make_operator() of S or R of a stage, called `name`. Throws an IndefiniteStep that says whose numbers make it
/// indefinite. `weights`: those of that matrix in the plan.
OperatorOrRefusal definite_operator(const Program& whole, const FoldedStage& folded, int lanes, const char* name,
                                    const OperatorWeights& weights);

}  // namespace ricochet
