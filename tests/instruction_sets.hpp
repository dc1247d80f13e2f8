#pragma once
#include <ricochet/kernels/instruction_set.hpp>
#include <vector>

namespace ricochet::testing {

/// Those that this processor has.
inline std::vector<InstructionSet> instruction_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512})
    if (set <= best_instruction_set()) sets.push_back(set);
  return sets;
}

}  // namespace ricochet::testing
