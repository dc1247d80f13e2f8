#pragma once
#include <array>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "continuous_beam.hpp"

/// \file
/// One trajectory of the continuous beam: flight, impact, contact, release, and so on, each phase exact.
namespace ricochet::event_driven {

struct Settings {
  int modes = 80;
  double tolerance = 1e-12;         ///< of the gap, over the largest displacement of the scene
  double events_per_period = 2000;  ///< of the first mode
};

/// Whether anything can be touched: a contact law, and a stop at one of its points.
bool stops_act(const ReferenceProblem& problem);
/// Whether no other point has stops.
bool only_the_tip(const ReferenceProblem& problem);

/// The motion from event to event, read on the grid as it passes.
class BeamRun {
 public:
  BeamRun(const ReferenceProblem& problem, const SampleGrid& grid, const Settings& settings);

  std::variant<SampledMotion, Refusal> motion();

  /// The motion to the end of the grid from modal displacements and velocities (a, b) of flight at t = 0. Those at the
  /// end are left in a, b. `tangent`: columns over (a, b) that follow it, the instants of switches moving with them. A
  /// state at a stop or in contact at the end is refused.
  std::variant<SampledMotion, Refusal> motion_from(Eigen::ArrayXd& a, Eigen::ArrayXd& b, Eigen::MatrixXd* tangent);
  /// ⟨w, φ⟩ and ⟨w_t, φ⟩ of the initial formulas.
  void project_start(Eigen::ArrayXd& a, Eigen::ArrayXd& b) const;
  const Beam& beam() const { return beam_; }

  /// Share of the initial energy that the modes do not hold: large where the initial displacement is bent at the tip.
  double initial_energy_left_out() const { return initial_energy_ > 0 ? left_out_ / initial_energy_ : 0; }

 private:
  using Failure = std::optional<Refusal>;
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Rows of shapes and curvatures at the places of the grid.
  struct Shapes {
    Shapes(const BeamModes& modes, const std::vector<double>& places);
    Eigen::MatrixXd value, curvature;
  };
  void reserve();
  double stop() const { return side_ < 0 ? lower_ : upper_; }
  double lift(double t) const { return stop() - beam_.support.at(t); }
  double lift_rate(double t) const { return -beam_.support.rate(t); }

  Failure begin();
  void set_scales(double displacement, double velocity);  // largest initial ones
  void move_tangent(const ModalPhase& phase, double t);
  /// How far the instant of a switch moves with each column: δt = −∇g·δ / g'.
  void set_instants(const ModalPhase& phase, double slope);
  /// The tangent columns in the modes of the next phase, which has begun: δ⁺ = R δ⁻ + (R f⁻ + ∂R/∂t − f⁺) δt. R is the
  /// change of modes and of the lift, f the rates on either side.
  template <class Basis>
  void switch_tangent(const ModalPhase& phase, const ModalPhase& next_phase, const ModalState& before,
                      const Basis& basis, const Eigen::ArrayXd& lifted);
  bool held() const { return upper_ - lower_ <= 1e-12 * scale_; }
  double tolerance() const { return settings_.tolerance * scale_; }
  double force_tolerance() const { return 3 * tolerance() / std::pow(beam_.length, 3); }

  /// Whether a tip that starts on a stop would first move beyond it if it were free.
  bool goes_out(const Guard& guard, double noise);
  Failure fly();
  Failure touch();
  void impact(int side, double velocity);

  /// With ⟨w,p⟩, ⟨w_t,p⟩ and all ⟨w,ψ_n⟩, ⟨w_t,ψ_n⟩.
  void enter_contact(int side, double velocity, double on_lift, double rate_on_lift, const Eigen::ArrayXd& on_modes,
                     const Eigen::ArrayXd& rate_on_modes);
  void release(bool at_once = false);

  /// Σ⟨·, p⟩ of the equation of motion, integrated over time, per ρS: its change over a contact phase is the impulse.
  ///
  ///     X = ⟨w_t + φ', p⟩ + η⟨w, p⟩ + (3k²/L³)(∫r dt + αr) − t⟨f/ρS, p⟩
  double momentum(double t, double rate, double position) const;
  /// ∫ of the stop's force since the impact; a_, b_ hold the contact modes at t.
  double contact_impulse(double t) const;

  /// Marches the phase until a guard is passed (its number, the state moved there) or the grid is read (−1).
  std::variant<int, Refusal> march(ModalPhase& phase, std::array<Guard, 2>& guards, double tolerance);

  // Shorter steps would be lost in the round-off of t.
  int deepest_level(const ModalPhase& phase) const;
  int first_passed(ModalPhase& phase, const std::array<Guard, 2>& guards, const Cubic& cubic, double step,
                   double tolerance);

  /// ½ρS Σ(b² + ω₀²a²) of what a_, b_ hold.
  double modal_energy(const ModalPhase& phase) const;
  void sample_until(ModalPhase& phase, double t);
  void sample_fields(const Shapes& shapes, double t);

  // At t = 0 the formulas are known, and the modal sums may converge slowly.
  void sample_start(const PanelSeries& displacement);

  static constexpr long long most_looks = 200'000'000;
  static constexpr int panels = 32;  // of the initial formulas

  const ReferenceProblem& problem_;
  const SampleGrid& grid_;
  Settings settings_;
  Beam beam_;
  ModalPhase flight_, contact_;
  Shapes flight_shapes_, contact_shapes_;
  double lower_ = -infinity, upper_ = infinity;
  double scale_ = 0, first_period_ = 0, shortest_period_ = 0;
  double initial_energy_ = 0, left_out_ = 0;
  int side_ = 0;  // of the stop that is touched, 0 in flight
  ModalState state_, ahead_;
  std::array<Guard, 2> guards_;
  Eigen::ArrayXd a_, b_;  // modal displacements and velocities, whole
  Eigen::MatrixXd* tangent_ = nullptr;
  Eigen::RowVectorXd instants_;
  double tangent_time_ = 0;
  bool mapped_ = false;  // by motion_from
  double impulse_ = 0, momentum_ = 0;
  int level_ = 0;
  long long looks_ = 0;
  std::size_t next_ = 0;
  Eigen::VectorXd field_;
  SampledMotion out_;
};

}  // namespace ricochet::event_driven
