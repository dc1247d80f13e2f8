#pragma once
#include <ricochet/algebra/block.hpp>
#include <ricochet/algebra/quadratic_form.hpp>
#include <ricochet/engine/marcher.hpp>
#include <vector>

namespace ricochet {

/// Works of one or more steps, J, each in the sense in which the balance of a scheme adds it:
///
///     ΔE = loads − damping − scheme + contact
struct Works {
  double loads = 0;    ///< Σ sᵀF̄, and the support's work through the stops
  double damping = 0;  ///< Σ sᵀC r
  double contact = 0;  ///< Σ p̄ᵀ(H s + Δφ)
  double scheme = 0;   ///< Σ of the plan's loss terms
  double law = 0;      ///< what the law itself dissipates, of what it gives as `contact`

  /// ΔE beyond what the loads brought, where the balance is exact.
  double gain() const { return contact - damping - scheme; }
  Works& operator+=(const Works& other);
};

/// The works of a stage by its test displacement s, from what the step has found already: a combination of vectors for
/// s, one quadratic form where there is damping, one more per loss term, and the points that push. What a scene does
/// not have is not computed. Keeps what damping and loads ask of each stage, allocates when constructed; one lane at a
/// time, each stage in turn.
class StageWorks {
 public:
  /// M and K in the coordinates of the march.
  struct Forms {
    const QuadraticForm &mass, &stiffness;
  };
  explicit StageWorks(const Marcher& marcher);

  /// Adds what the stage brings to a lane, its losses only where `losses`. `acting`: whether efforts of stages before
  /// may still be in p̄.
  void add(const Marcher& marcher, const StageView& view, int lane, const Forms& forms, bool losses, bool acting,
           Works& works);

 private:
  /// A combination as a sum of the vectors that it weighs.
  struct Terms {
    std::vector<int> which;  // slot; below 0: an unknown
    std::vector<double> weight;
  };
  struct StageTerms {
    Terms displacement, rate;
    double along = 0;  // c with r = c s, where there is one; else 0
    PhaseWeights load, support;
    std::vector<Terms> losses;
  };
  static Terms terms_of(const Combination& c);
  StageTerms describe(const Stage& plan, double pulsation, double h) const;
  const double* combine(const StageView& view, const Terms& terms, int lane, Block& out) const;
  void add_contact(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane, const double* s,
                   Works& works) const;

  const MarchModel& model_;
  const LaneKernels& kernels_;
  Damping damping_;
  int T_;
  std::vector<StageTerms> start_, stages_;
  Block displacement_, rate_;  // of one lane
};

}  // namespace ricochet
