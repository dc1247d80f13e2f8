#pragma once
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/contact/contact_instants.hpp>
#include <ricochet/measure/contact/stop_places.hpp>
#include <ricochet/measure/statistics/running_moments.hpp>
#include <vector>

namespace ricochet {

/// How stops with a tangent wear. An instant of contact gives I (N s) while the surface goes from V⁻ to V⁺ (m/s). It
/// slides by ½(|V⁻| + |V⁺|) a second,
///
///     wear power = (1/T) Σ I ½ (|V⁻| + |V⁺|)   (W),
///
/// V⁻ over the sub-step before the instant and V⁺ over that of the instant. A clearance met in the direction n has
/// |V|² = (n × v)² + (r n·θ')². The first part is along the circle. The second, of a surface of radius r that bends, is
/// along the beam. The rows are u₁, u₂ and r θ₁, r θ₂. Of two tangents V is the length of both. Tangents are read,
/// never pushed; points are stops. It looks at a step before the ImpactRecorder that tells it of instants. Every step
/// is shown to it where there are tangents.
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
  /// Work of a stop in a part of the window, J; of one that has a tangent.
  double work(int point, int part) const;
  /// Mean power over the window, W.
  double power(int point) const;
  /// Speed along the surface before an impact, by its row in the list of impacts, m/s; NaN where it has none.
  double speed_at(std::size_t impact) const;

 private:
  struct Waiting {
    double given = 0;
    std::array<double, 2> normal{};
  };
  struct Tangent {
    int first = 0, count = 1;  // its rows
    bool round = false;        // of a clearance
    static constexpr std::size_t rim = 4, rows_and_rim = 5;
    std::array<double, rows_and_rim> place{}, speed{};  // against the surface: at the last opening, over the sub-step
    std::vector<RunningSurface> surfaces = {};          // that run along its rows, or of its rim
    std::vector<Waiting> waiting = {};                  // Σ I of instants that wait for V⁺, by their directions
    double slid = 0;                                    // Σ I |V⁻| of these
    double time = 0;                                    // of the last of them
    double along(const std::array<double, 2>& normal) const;  // V; of a clearance without a sign
    void moves(const RunningSurface& surface, std::array<double, rows_and_rim>& of, double by) const;
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
