#pragma once
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/contact/contact_instants.hpp>
#include <ricochet/measure/motion/row_readings.hpp>
#include <ricochet/measure/statistics/running_moments.hpp>
#include <vector>

namespace ricochet {

/// What stops with a tangent wear: an instant of contact that gives I (N s) while the surface goes from V⁻ to V⁺ (m/s)
/// slides by ½(|V⁻| + |V⁺|) a second,
///
///     wear power = (1/T) Σ I ½ (|V⁻| + |V⁺|)   (W),
///
/// V⁻ over the sub-step before the instant and V⁺ over that of the instant. Tangents are read, never pushed. It looks
/// at a step before the ImpactRecorder that tells it of instants. Every step is shown to it where there are tangents.
class TangentWatch final : public StepObserver, public ContactListener {
 public:
  TangentWatch(const Marcher& marcher, const WindowParts& window);

  bool any() const { return rows_.count() > 0; }
  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher&) override {}
  void instant(const ContactInstant& one) override;
  /// To be called once, when the integration is over.
  void finish(const Marcher& marcher);

  bool has(int point) const { return tangent_of(point) >= 0; }
  /// Work of a contact point in a part of the window, J; of one that has a tangent.
  double work(int point, int part) const;
  /// Mean power over the window, W.
  double power(int point) const;
  /// Speed along the surface before an impact, by its row in the list of impacts, m/s; NaN where it has none.
  double speed_at(std::size_t impact) const;

 private:
  struct Tangent {
    double place = 0, speed = 0;  // at the last opening, over the sub-step before it
    double given = 0, slid = 0;   // of instants that wait for V⁺: Σ I, Σ I |V⁻|
    double time = 0;              // of the last of them
  };
  int tangent_of(int point) const {
    const auto j = static_cast<std::size_t>(point);
    return j < tangents_of_.size() ? tangents_of_[j] : -1;
  }
  void know(const Marcher& marcher, const double* position, double t);

  WindowParts window_;
  double h_;
  RowReadings rows_;
  std::vector<int> tangents_of_;
  std::vector<Tangent> tangents_;
  std::vector<double> work_;  // tangents × parts, J
  std::vector<double> at_impacts_;
  bool known_ = false;
  double time_ = 0;
};

}  // namespace ricochet
