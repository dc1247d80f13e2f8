#pragma once
#include <optional>
#include <ricochet/measure/statistics/refinement.hpp>
#include <string>
#include <vector>

#include "runners/answers/compared.hpp"

namespace ricochet {

/// One method's errors along a refinement, at the finest of the other.
struct MethodRun {
  Cases cases;
  const CaseRecord* finest = nullptr;
  OrderRun run;
  std::optional<double> declared, motion;  ///< what the scheme declares; what a motion at rest would err by
};

/// Of every method with two sizes or more. `refined`: "step" or "elements".
std::vector<MethodRun> runs_of(const answers::Compared& study, const std::string& error, const std::string& refined);

}  // namespace ricochet
