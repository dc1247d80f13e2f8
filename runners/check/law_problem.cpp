#include <fmt/format.h>

#include <ricochet/kernels/eigenvalues.hpp>

#include "runners/check/bench.hpp"
#include "runners/check/law_checks.hpp"

namespace ricochet::checking {
namespace {

struct ClosedStructure {
  const char* name;
  SceneSpec scene;
  int elements;
};

std::vector<ClosedStructure> closed_structures() {
  const auto structure = [](bool beam, bool everywhere) {
    return structure_scene({.beam = beam, .stops = true, .everywhere = everywhere});
  };
  return {{"a beam with stops at its tip", structure(true, false), 4},
          {"a beam with stops at all nodes", structure(true, true), 6},
          {"a bar with stops at its end", structure(false, false), 4},
          {"a bar with stops at all nodes", structure(false, true), 6},
          {"an oscillator", oscillator_scene({.position = 1, .stop = true}), 1}};
}

// What is wrong with the matrices, or nothing.
std::string wrong_with(const SemiDiscrete& problem) {
  const Eigen::MatrixXd K = problem.stiffness, G = problem.measured();
  if (!K.allFinite() || !G.allFinite()) return "the stiffness or the measure is not finite";
  if (G.rowwise().norm().minCoeff() == 0) return "a point measures nothing";
  const double size = K.cwiseAbs().maxCoeff(), skew = (K - K.transpose()).cwiseAbs().maxCoeff();
  if (skew > 1e-12 * size) return fmt::format("the stiffness is not symmetric: {:.3g} of {:.3g}", skew, size);
  const SymmetricModes modes = symmetric_modes(K, Eigen::MatrixXd(problem.own_stiffness), EigenVectors::none);
  if (!modes.found) return "the modes of the stiffness against that of the structure are not found";
  // Shares of the structure's own stiffness that are left.
  if (!(modes.values.minCoeff() > 1e-9))
    return fmt::format(
        "the stiffness is not positive: {:.3g} of the structure's own is left in one direction, which it "
        "should have refused",
        modes.values.minCoeff());
  return {};
}

}  // namespace

Verdict changed_problem_is_sound(const Law& law) {
  if (!law.make()->changes_problem()) return not_declared("takes structure and measure as they are");
  std::string refused;
  int taken = 0;
  for (const ClosedStructure& one : closed_structures()) {
    const auto first = law.make(), other = law.make();
    auto made = discretise(one.scene, one.elements, *consistent_bench_mass(), first.get());
    if (const auto* refusal = std::get_if<Refusal>(&made)) {
      refused = refusal->sentence;
      if (const std::string poor = poor_refusal(refused, law.entry->manual); !poor.empty())
        return fails(fmt::format("on {}: {}", one.name, poor));
      continue;
    }
    const auto& problem = std::get<SemiDiscrete>(made);
    if (const std::string wrong = wrong_with(problem); !wrong.empty())
      return fails(fmt::format("on {}: {}", one.name, wrong));
    show_problem(*other, problem);  // throws where a second law with the same parameters makes another problem
    ++taken;
  }
  if (taken == 0) throw Refused{refused};
  return fine(fmt::format("{} of {} structures: symmetric, positive, the same twice; the others refused in a sentence",
                          taken, closed_structures().size()));
}

}  // namespace ricochet::checking
