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

/// The works of a stage by its test displacement s, from what the step has found already: the squares that a free step
/// has added up for damping and the clamp, or one pass over the vectors that s weighs; one more per loss term, and the
/// points that push. What a scene does not have is not computed. Keeps what damping and loads ask of each stage,
/// allocates when constructed; one lane at a time, each stage in turn.
///
/// A start rule without work form is no step of the balance, which begins after it. What its contact works is added all
/// the same: ω pᵀ(H(v⁻ + v⁺)/2 + Δφ/Δt), v the plan's velocity before and after it, ω p the momentum given within it.
class StageWorks {
 public:
  /// M and K in the coordinates of the march.
  StageWorks(const Marcher& marcher, const QuadraticForm& mass, const QuadraticForm& stiffness);

  /// Adds what the stage brings to a lane, its losses only where `losses`. `acting`: whether efforts of stages before
  /// may still be in p̄.
  void add(const Marcher& marcher, const StageView& view, int lane, bool losses, bool acting, Works& works) {
    const StageTerms& stage = (view.starting ? start_ : stages_)[static_cast<std::size_t>(view.stage)];
    const bool contact = view.effort && (acting || ((view.contact_lanes >> lane) & 1u));
    if (contact || !view.sum || view.sum != &stage.sum)
      return add_all(marcher, view, stage, lane, losses, contact, works);
    works.damping += stage.by_sum * stage.sum.form;
    if (projected_) works.loads += marcher.support(lane, stage.sum_load) * stage.sum.projection;
  }
  /// The same of a step that was not shown, of a plan of one stage: where squares_alone().
  void add(const Marcher& marcher, const FreeStep& step, Works& works) const {
    const StageTerms& stage = stages_.front();
    works.damping += stage.by_sum * step.form;
    if (projected_) works.loads += marcher.support(0, stage.sum_load, step) * step.projection;
  }
  /// Whether a step without contact asks nothing but its squares, or not even these.
  bool squares_alone() const { return squares_alone_; }
  /// What a free step may add up of a stage of the plan; null where that is not all that it asks without contact.
  SquareSum* squares(int stage) {
    StageTerms& terms = stages_[static_cast<std::size_t>(stage)];
    if (terms.fours.rows() == 0) return nullptr;
    terms.sum.fours = terms.fours.data();
    return &terms.sum;
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
    bool impulsive = false;  // a start rule whose contact alone works: `displacement` is the mean velocity
    // Where damping and clamp are all there is without contact, of an operator that adds up their squares: of s over
    // the weight of z, and what these are worth. Else no fours.
    Block fours;
    SquareSum sum;
    double by_sum = 0;
    PhaseWeights sum_load;
  };
  void ask_for_squares(const QuadraticForm& form, const double* shape, int width, StageTerms& stage) const;
  StageTerms describe(const Stage& plan, double pulsation, double h) const;
  StageTerms describe_start(const StepPlan& plan, std::size_t index, const StageFacts& facts, double pulsation,
                            double h) const;
  void add_all(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane, bool losses,
               bool contact, Works& works);
  void add_contact(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane, const double* s,
                   Works& works) const;

  const MarchModel& model_;
  QuadraticForm mass_, stiffness_;  // of two vectors
  CombinedForm first_;              // what damps, K before M, and the shape of the clamp's load
  CombinedForm mass_form_, stiffness_form_;
  Damping damping_;
  bool damped_, projected_, squares_alone_ = false;
  int T_;
  std::vector<StageTerms> start_, stages_;
  Block displacement_, rate_;  // of one lane
};

}  // namespace ricochet
