#pragma once
#include <memory>
#include <optional>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/engine/march_model.hpp>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <string>
#include <variant>
#include <vector>

namespace ricochet {

enum class OperatorKind { automatic, diagonal, modal, band, sparse };
const char* operator_name(OperatorKind kind);

/// The coefficients of one stage with C = αK + ηM folded into K and M: S = s_M M + s_K K, b = Σ_j (β^M_j M + β^K_j K)
/// x_j + … Those of a C that is not made of K and M stand beside them, else 0.
struct FoldedStage {
  double mass = 0, stiffness = 0;
  std::vector<double> mass_history, stiffness_history;  ///< one per slot
  double damping = 0;
  std::vector<double> damping_history;
  bool uses_mass() const;
  /// Whether the slots drive it.
  bool driven() const;
  bool solves() const { return mass != 0 || stiffness != 0 || damping != 0; }
};
FoldedStage fold(const Stage& stage, const Damping& damping, int slots);
/// The same of a single operator, which has no history.
FoldedStage fold(const OperatorWeights& weights, const Damping& damping);

/// S of a stage, with a C of its own too.
QuasiDefinite stage_system(const MarchModel& model, const FoldedStage& stage);

/// What the marcher hands over for a free step. All blocks have the width that the operator was made for.
struct FreeStepInput {
  const double* const* slots = nullptr;     ///< n × T each
  const double* k = nullptr;                ///< Σ β^K_j x_j, kept by the marcher (only where keeps_combination())
  const double* scale = nullptr;            ///< T: Σ φ_k A ω² sin(ω(t+c_k h)+ψ); null: no support motion
  const double* load = nullptr;             ///< n: Σ φ_k F(t+c_k h) of the distributed load; null: none
  const IncrementUpdate* update = nullptr;  ///< to be made first (only where takes_update(), without load)
  PointTest* test = nullptr;                ///< to be made last (only where takes_points(), without load)
  SquareSum* sum = nullptr;                 ///< to be added up besides (only where sums_squares(), without load)
};

/// z° = S⁻¹ b for every lane of a block.
class StageOperator {
 public:
  virtual ~StageOperator() = default;
  /// Whether it reads `k`: the marcher then combines slots as it updates them.
  virtual bool keeps_combination() const = 0;
  /// Whether it makes the update of two slots that came before it by itself, and needs no `k` then.
  virtual bool takes_update() const { return false; }
  /// Whether it measures such points by itself from now on, with these weights of two slots and z; `rows` stays where
  /// it is.
  virtual bool takes_points([[maybe_unused]] const LaneRows& rows, [[maybe_unused]] const double* weight) {
    return false;
  }
  /// The numbers of modes with two slots, and of the point that it takes; null: it is no such operator.
  virtual const Modes* modes() const { return nullptr; }
  /// Half-bandwidth of the squares of z° and the second of two slots that it adds up besides; nothing: it adds up none.
  virtual std::optional<int> sums_squares() const { return std::nullopt; }
  virtual void free_step(const FreeStepInput& input) = 0;
  /// The unknown, n × T; free_step writes it and the marcher corrects it.
  virtual double* unknown() = 0;
  /// x = S⁻¹ rhs for one vector of n.
  virtual void solve_column(const double* rhs, double* x) = 0;
};

using OperatorOrRefusal = std::variant<std::unique_ptr<StageOperator>, Refusal>;

/// Makes the operator of a stage in the coordinates of `model`, for T lanes.
OperatorOrRefusal make_operator(OperatorKind kind, const MarchModel& model, const FoldedStage& stage, int lanes);

/// The operator of a stage that is solved once, without a factor of its own. Made where S = a S₀ + b M with a > 0,
/// b ≥ 0 and S₀ = s₀_M M + s₀_K K of another stage, whose positive operator it keeps. Null where the stages are not so,
/// or where the condition 1 + b / (a s₀_M) of S₀⁻¹S is above 3.
std::unique_ptr<StageOperator> make_near_operator(const MarchModel& model, const FoldedStage& stage, int lanes,
                                                  const FoldedStage& other, StageOperator& of_other);

/// The operator of a stage where `model` has modal coordinates. Refuses a mode on which S vanishes.
OperatorOrRefusal make_modal_operator(const MarchModel& model, const FoldedStage& stage, int lanes);

}  // namespace ricochet
