#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <ricochet/engine/marcher.hpp>
#include <string>
#include <vector>

#include "runners/check/bench.hpp"

/// \file
/// What is looked at in a time scheme. Each declared fact has a check that measures it, apart from the others.
namespace ricochet::checking {

/// Whether rigid laws have a measure in some stage.
inline bool measures(const StepPlan& plan) {
  return std::any_of(plan.stages.begin(), plan.stages.end(),
                     [](const Stage& stage) { return stage.impact.has_value(); });
}

// Form and answers (scheme_form.cpp).
Verdict plan_is_well_formed(const Scheme& scheme);
Verdict plan_is_the_same_twice(const Scheme& scheme);
Verdict refusals_name_cause(const Scheme& scheme);
Verdict singular_mass_as_declared(const Scheme& scheme);

// Marching against the plan itself (scheme_form.cpp, scheme_orders.cpp).
Verdict march_is_the_plan(const Scheme& scheme);
Verdict spectrum_is_the_march(const Scheme& scheme);
Verdict stability_as_declared(const Scheme& scheme);

// Against closed forms (scheme_orders.cpp).
Verdict order_as_declared(const Scheme& scheme);
Verdict velocity_stands_right(const Scheme& scheme);
Verdict loads_at_their_times(const Scheme& scheme);
Verdict supports_at_their_times(const Scheme& scheme);
Verdict compliance_is_right(const Scheme& scheme);

// Contact and energies (scheme_contact.cpp, scheme_checks.cpp).
Verdict rigid_stops_hold(const Scheme& scheme);
Verdict restitution_as_declared(const Scheme& scheme);
Verdict start_at_a_stop(const Scheme& scheme);
Verdict contact_order_as_declared(const Scheme& scheme);
Verdict impulse_is_momentum(const Scheme& scheme);
Verdict force_at_rest(const Scheme& scheme);
Verdict energy_in_free_flight(const Scheme& scheme);
Verdict work_form_closes(const Scheme& scheme);
Verdict contact_gains_as_declared(const Scheme& scheme);

/// The same, in the order of the report.
const std::vector<Check<TimeScheme>>& scheme_checks();

/// The plan of a marcher evaluated anew beside it, with dense matrices: S, b, weighted efforts, updates. Of the engine
/// it takes nothing but the efforts that its law found. Then it asks whether those answer the measures found here.
class DenseMarch final : public StepObserver {
 public:
  explicit DenseMarch(const Marcher& marcher);
  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher& marcher) override;
  /// What differs by more than round-off, or "".
  const std::string& difference() const { return difference_; }

 private:
  struct Lane {
    LaneSpec spec;
    std::vector<Eigen::VectorXd> slots;
    std::vector<Eigen::VectorXd> past;  // p₋₁, p₋₂, …
    Eigen::VectorXd last_start;         // of the start rule's last stage
    bool starting = true;
    double fastest = 0;
    std::vector<Eigen::VectorXd> efforts, ways;  // of each stage of the step: p, and H s + Δφ of its work form
  };
  /// What a stage has found.
  struct Found {
    Eigen::VectorXd z, w, p;
    Eigen::VectorXd free;  ///< z without p
  };
  /// What brings p into a stage; null where nothing does.
  struct Efforts {
    const std::vector<double>* weights = nullptr;
    double impulse = 0;
  };
  Efforts efforts_of(const Stage& stage) const;
  /// z, w and free of a stage whose p is known.
  void solve(const Lane& lane, const StageView& view, const Efforts& efforts, Found& found) const;
  Eigen::VectorXd combined(const Lane& lane, const Combination& c, const Found& found) const;
  double support(const Lane& lane, double t, const Levels& levels, bool rate) const;
  Eigen::VectorXd load(const Lane& lane, double t, const Levels& levels) const;
  void look_at_contact(const Stage& stage, const Lane& lane, const Found& found, double t);
  void look_at_work(const Lane& lane, std::size_t k, std::size_t source);
  void look_at_gate(const ImpactMeasure& impact, const Lane& lane, const Eigen::VectorXd& y, const Found& found,
                    double t);
  void note(const std::string& sentence);

  const SemiDiscrete& problem_;
  StepPlan plan_;
  double h_;
  std::optional<Evaluation> reads_;
  bool absent_;
  Eigen::MatrixXd M_, C_, K_, H_;
  std::vector<Lane> lanes_;
  std::string difference_;
  long long step_ = 0;
};

}  // namespace ricochet::checking
