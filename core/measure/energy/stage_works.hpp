#pragma once
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/energy/lane_sum.hpp>
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

/// The works of a stage by its test displacement s, from what the step has found already: one pass over the vectors
/// that s weighs for damping and the clamp, one more per loss term, and the points that push. What a scene does not
/// have is not computed. Keeps what damping and loads ask of each stage, allocates when constructed; one lane at a
/// time, each stage in turn.
class StageWorks {
 public:
  /// M and K in the coordinates of the march.
  StageWorks(const Marcher& marcher, const QuadraticForm& mass, const QuadraticForm& stiffness);

  /// Adds what the stage brings to a lane, its losses only where `losses`. `acting`: whether efforts of stages before
  /// may still be in p̄.
  void add(const Marcher& marcher, const StageView& view, int lane, bool losses, bool acting, Works& works) {
    const StageTerms& stage = (view.starting ? start_ : stages_)[static_cast<std::size_t>(view.stage)];
    const bool contact = view.effort && (acting || ((view.contact_lanes >> lane) & 1u));
    if (stage.passes == 0 || contact) return add_all(marcher, view, stage, lane, losses, contact, works);
    const double* x[CombinedForm::most_terms];
    for (int k = 0; k < stage.passes; ++k) {
      const int which = stage.displacement.which[static_cast<std::size_t>(k)];
      x[k] = which >= 0 ? view.slots[which] : view.z;
    }
    const CombinedForm::Value value = first_(stage.passes, x, stage.displacement.ratio.data());
    works.damping += stage.by_pass * value.form;
    if (projected_) works.loads += marcher.support(lane, stage.pass_load) * value.projection;
  }

 private:
  struct Loss {
    EnergyMatrix matrix = EnergyMatrix::M;
    double coefficient = 0;
    WeighedTerms value;
  };
  struct StageTerms {
    WeighedTerms displacement, rate;
    double along = 0;     // c with r = c s, where there is one; else 0
    double by_first = 0;  // c α where K damps, else c η
    double by_mass = 0;   // c η where K damps too
    PhaseWeights load;    // times ω²: −φ'' = ω² φ for the harmonic support
    PhaseWeights support;
    std::vector<Loss> losses;
    // Where one lane's damping and clamp are all there is without contact: how many vectors s weighs, and what the pass
    // over them is worth, the first of them taken once. Else 0.
    int passes = 0;
    double by_pass = 0;
    PhaseWeights pass_load;
  };
  StageTerms describe(const Stage& plan, double pulsation, double h) const;
  void add_all(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane, bool losses,
               bool contact, Works& works);
  void add_contact(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane, const double* s,
                   Works& works) const;

  const MarchModel& model_;
  QuadraticForm mass_, stiffness_;  // of two vectors
  CombinedForm first_;              // what damps, K before M, and the shape of the clamp's load
  CombinedForm mass_form_, stiffness_form_;
  Damping damping_;
  bool damped_, projected_;
  int T_;
  std::vector<StageTerms> start_, stages_;
  Block displacement_, rate_;  // of one lane
};

}  // namespace ricochet
