#pragma once
#include <algorithm>
#include <array>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <ricochet/kernels/quadratic_form.hpp>
#include <span>
#include <vector>

namespace ricochet {

/// A combination as a list of the vectors that it weighs, in the order of the slots, then z, then w.
struct WeighedTerms {
  static constexpr int unknown_z = -1, unknown_w = -2;
  std::vector<int> which;  ///< slot, or an unknown
  std::vector<double> weight;
  std::vector<double> ratio;  ///< weight over the first one

  WeighedTerms() = default;
  explicit WeighedTerms(const Combination& c) {
    for (std::size_t j = 0; j < c.slots.size(); ++j) add(static_cast<int>(j), c.slots[j]);
    add(unknown_z, c.z);
    add(unknown_w, c.w);
  }
  void add(int vector, double by) {
    if (by == 0) return;
    which.push_back(vector);
    weight.push_back(by);
    ratio.push_back(by / weight[0]);
  }
  friend bool operator==(const WeighedTerms&, const WeighedTerms&) = default;
};

/// Σ_k w_k x_k of one lane of blocks that are T wide. What only a form asks of is not written down where T = 1.
class LaneSum {
 public:
  LaneSum(const WeighedTerms& terms, int T, int lane) : terms_(&terms), T_(T), lane_(lane) {}
  /// As the stage finds them: nothing where w did not jump.
  LaneSum(const WeighedTerms& terms, const double* const* slots, const double* z, const double* w, int T, int lane)
      : LaneSum(terms, T, lane) {
    for (const int which : terms.which) {
      const double* x = which >= 0 ? slots[which] : which == WeighedTerms::unknown_z ? z : w;
      if (x) add(x);
    }
  }
  /// The next of the vectors; those that are left out at the end are zero.
  void add(const double* x) { x_[static_cast<std::size_t>(count_++)] = x; }

  /// Its numbers, in `out` where they do not stand already.
  const double* write(Block& out) const {
    const double* weight = terms_->weight.data();
    if (T_ == 1 && count_ == 1 && weight[0] == 1) return x_[0];
    if (T_ == 1 && count_ > 0 && count_ <= most_lane_slots) {
      lane_kernels(1).combine(static_cast<long>(out.size()), count_, x_.data(), weight, out.data());
      return out.data();
    }
    out.fill(0.0);
    const auto T = static_cast<std::size_t>(T_), l = static_cast<std::size_t>(lane_);
    for (int k = 0; k < count_; ++k) {
      const double* from = x_[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < out.size(); ++i) out.data()[i] += weight[k] * from[i * T + l];
    }
    return out.data();
  }

  /// What a form says of it; `numbers` holds it afterwards where it is given. Otherwise `scratch` may be written.
  CombinedForm::Value under(const CombinedForm& form, Block& scratch, Block* numbers = nullptr) const {
    if (T_ == 1 && count_ > 0 && count_ <= CombinedForm::most_terms) {
      const double scale = terms_->weight[0];
      CombinedForm::Value value = form(count_, x_.data(), terms_->ratio.data(), numbers ? numbers->data() : nullptr);
      if (scale == 1) return value;
      if (numbers)
        for (std::size_t i = 0; i < numbers->size(); ++i) numbers->data()[i] *= scale;
      return {scale * scale * value.form, scale * value.projection};
    }
    const double* at = write(numbers ? *numbers : scratch);
    constexpr double one = 1;
    return form(1, &at, &one, numbers && at != numbers->data() ? numbers->data() : nullptr);
  }

 private:
  const WeighedTerms* terms_;
  int T_, lane_, count_ = 0;
  std::array<const double*, most_slots + 3> x_;
};

/// The quadratic energies of a state after a stage: kinetic, elastic, and the scheme's own. Forms of one vector that
/// several of them ask for are evaluated once. Allocates when constructed; one lane at a time.
class StateEnergies {
 public:
  StateEnergies(const Marcher& marcher, const QuadraticForm& mass, const QuadraticForm& stiffness);

  struct Values {
    double kinetic = 0;  ///< ½ vᵀM v
    double elastic = 0;  ///< ½ qᵀK q
    double scheme = 0;   ///< 0 where the plan declares none
  };
  /// Where the velocity is a mean over a sub-step, `increment` is what the position moved by in it, contiguous. It is
  /// read only where no slot holds it. `duration` is how long the sub-step lasted (s).
  Values read(const double* const* slots, const double* increment, double duration, int lane);
  /// The scheme's own alone.
  double scheme(const double* const* slots, int lane);
  /// Where the elastic energy that was last read stands, contiguous; kept for laws that store energy, or when asked
  /// for.
  const double* place() const { return place_.data(); }
  void keep_place() { kept_ = true; }

 private:
  struct Form {
    EnergyMatrix matrix = EnergyMatrix::M;
    WeighedTerms terms;
    bool plain = false;  // few enough vectors of one lane, all of them slots: square times the form of these by ratios
    double square = 0;
    double value = 0;
  };
  struct Share {
    std::size_t form = 0;
    double coefficient = 0;
  };
  std::size_t find(EnergyMatrix matrix, const Combination& c, double of_increment = 0);
  double evaluate(const Form& form, const double* const* slots, const double* increment, int lane, bool kept);

  CombinedForm mass_, stiffness_;
  int T_, slot_count_;
  bool mean_velocity_, kept_;  // kept_: whether place() is
  std::vector<Form> forms_;
  std::size_t kinetic_ = 0, elastic_ = 0;
  std::vector<Share> scheme_;
  Block place_, scratch_;
};

/// Works of one or more steps, J, each in the sense in which the balance of a scheme adds it:
///
///     ΔE = loads − damping − scheme + contact + friction
struct Works {
  double loads = 0;     ///< Σ sᵀF̄, and the support's work through the stops
  double damping = 0;   ///< Σ sᵀC r
  double contact = 0;   ///< Σ p̄ᵀ(H s + Δφ)
  double friction = 0;  ///< Σ p̄_tᵀ(T s + Δφ_t − ∫V dt)
  double scheme = 0;    ///< Σ of the plan's loss terms
  double law = 0;       ///< what the law itself dissipates, of what it gives as `contact`

  /// ΔE beyond what the loads brought, where the balance is exact.
  double gain() const { return contact + friction - damping - scheme; }
  Works& operator+=(const Works& other);
};

/// The works of a stage by its test displacement s, from what the step has found already. Those are the squares that a
/// free step has added up for damping and the clamp, or one pass over the vectors that s weighs. Each loss term takes
/// one more pass. Points that push are added. What a scene does not have is not computed. Keeps what damping and loads
/// ask of each stage, allocates when constructed; one lane at a time, each stage in turn.
///
/// A start rule without work form is no step of the balance, which begins after it. The work of its contact is added
/// all the same: ω pᵀ(H(v⁻ + v⁺)/2 + Δφ/Δt). The plan's velocity is v⁻ before the rule and v⁺ after it; ω p is the
/// momentum given within it.
class StageWorks {
 public:
  /// M and K in the coordinates of the integration.
  StageWorks(const Marcher& marcher, const QuadraticForm& mass, const QuadraticForm& stiffness);

  /// Adds what the stage brings to a lane, its losses only where `losses`. `acting`: whether efforts of stages before
  /// may still be in p̄.
  void add(const Marcher& marcher, const StageView& view, int lane, bool losses, bool acting, Works& works) {
    const StageTerms& stage = (view.starting ? start_ : stages_)[static_cast<std::size_t>(view.stage)];
    const bool contact = view.effort && (acting || ((view.contact_lanes >> lane) & 1u));
    std::fill(friction_works_.begin(), friction_works_.end(), 0.0);
    std::fill(friction_ways_.begin(), friction_ways_.end(), 0.0);
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
  /// Of the lane and stage that was added last, by row that rubs: the work of friction, J, and the way against the
  /// surface, m; of a stage without effort 0.
  std::span<const double> friction_works() const { return friction_works_; }
  std::span<const double> friction_ways() const { return friction_ways_; }
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
    Levels support_levels;
    std::vector<Loss> losses;
    bool impulsive = false;  // a start rule whose contact alone works: `displacement` is the mean velocity
    // Of an operator that adds up squares: those of s over the weight of z, and what they are worth. They hold where
    // damping and clamp are all there is without contact; else no fours.
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
  void add_efforts(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane, const double* s,
                   Works& works);
  void add_friction(const Marcher& marcher, const StageView& view, const StageTerms& stage, int lane, const double* s,
                    Works& works);

  const MarchModel& model_;
  QuadraticForm mass_, stiffness_;  // of two vectors
  CombinedForm first_;              // what damps, K before M, and the shape of the clamp's load
  CombinedForm mass_form_, stiffness_form_;
  Damping damping_;
  std::optional<QuadraticForm> own_damping_;  // of a C that is not made of K and M
  bool damped_, projected_, squares_alone_ = false;
  int T_;
  std::vector<StageTerms> start_, stages_;
  Block displacement_, rate_;  // of one lane
  std::vector<double> friction_works_, friction_ways_;
};

}  // namespace ricochet
