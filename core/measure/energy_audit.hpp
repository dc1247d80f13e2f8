#pragma once
#include <ricochet/algebra/quadratic_form.hpp>
#include <ricochet/engine/marcher.hpp>
#include <vector>

namespace ricochet {

/// Energies of one step, joules, in the frame of the clamp (w = u − φ).
struct EnergySample {
  double kinetic = 0;  ///< ½ vᵀM v, v = (q_{n+1} − q_n)/h
  double elastic = 0;  ///< ½ q̄ᵀK q̄, q̄ = (q_{n+1} + q_n)/2
  double contact = 0;  ///< potential of a compliant law at q̄
  double scheme = 0;   ///< the scheme's own invariant; the common energy where it declares none
  double common() const { return kinetic + elastic + contact; }
};

/// What the audit of a lane adds up, from its first complete step.
struct EnergyTotals {
  EnergySample first, last;
  double scheme_start = 0;       ///< scheme energy from which the balance starts
  double largest_step_gain = 0;  ///< max over steps of ΔE_scheme − W_loads (J), never below 0
  double work_of_damping = 0;    ///< Σ sᵀC r ≥ 0 where the scheme pairs them (J)
  double work_of_loads = 0;      ///< Σ sᵀF̄, and the support's work through the stops (J)
  double work_of_contact = 0;    ///< Σ p̄ᵀ(H s + Δφ): what the stops, at rest in the laboratory, give (J)
  /// E_end − E_start − loads + damping − contact: round-off × steps where the scheme has an exact balance, else what is
  /// left.
  double balance_residual() const {
    return last.scheme - scheme_start - work_of_loads + work_of_damping - work_of_contact;
  }
};

/// Contact seen over a run, per lane.
struct ContactTotals {
  long long impacts = 0;             ///< times that contact began anywhere (from no active point to some)
  long long active_set_changes = 0;  ///< steps whose set of active points (with side) differs from the step before
  long long contact_steps = 0;
  double impulse = 0;                            ///< Σ h Σ_i |p_i| (N s)
  double deepest_penetration = 0;                ///< m
  double residual = 0;                           ///< largest complementarity residual of the law
  double first_impact = -1, first_release = -1;  ///< s; −1: never
  double force = 0;                              ///< Σ_i p_i of the last step, N
  int active = 0;                                ///< points active in the last step
};

/// The energy audit: looks at every step, costs a few band products per lane and step; a march without it pays nothing.
/// A lane whose common energy passes the marcher's bound is frozen at that very step.
class EnergyAudit final : public StepObserver {
 public:
  explicit EnergyAudit(const Marcher& marcher);

  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher& marcher) override;

  const EnergySample& energy(int lane) const { return lanes_[static_cast<std::size_t>(lane)].now; }
  const EnergyTotals& totals(int lane) const { return lanes_[static_cast<std::size_t>(lane)].energy; }
  const ContactTotals& contact(int lane) const { return lanes_[static_cast<std::size_t>(lane)].contact; }
  double penetration(int lane) const { return lanes_[static_cast<std::size_t>(lane)].penetration; }
  /// (u_tip(t_{n+1}) − u_tip(t_n))/h of the last step, absolute, m/s.
  double tip_velocity(int lane) const { return lanes_[static_cast<std::size_t>(lane)].tip_velocity; }

 private:
  struct Lane {
    EnergyTotals energy;
    EnergySample now;
    ContactTotals contact;
    std::vector<double> increment;   // q_{n+1} − q_n, over the stages of the step
    std::vector<signed char> signs;  // side of each active point
    double step_loads = 0, step_damping = 0, step_contact = 0;
    double penetration = 0, tip_velocity = 0;
    bool has_scheme = false, has_first = false, counted = false;
  };
  double scheme_energy(const Marcher& marcher, int lane);
  void combine(const double* const* slots, const double* z, const Combination& c, int lane,
               std::vector<double>& out) const;
  void count_contact(const StageView& view, int lane);

  const MarchModel& model_;
  QuadraticForm mass_, stiffness_;
  Damping damping_;
  double h_;
  int T_;
  bool compliant_;
  std::vector<Lane> lanes_;
  std::vector<double> first_, second_;
};

}  // namespace ricochet
