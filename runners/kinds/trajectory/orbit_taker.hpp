#pragma once
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/contact/stop_places.hpp>
#include <ricochet/measure/statistics/running_moments.hpp>
#include <vector>

#include "runners/table/number_type.hpp"

namespace ricochet {

/// Where a place is within its clearance, at equal fractions of the window, on whole steps.
class OrbitTaker final : public StepObserver {
 public:
  static constexpr int most_samples = 2000;  ///< of each clearance

  OrbitTaker(const Marcher& marcher, const WindowParts& window, long long steps);

  /// Whether there is any clearance.
  bool any() const { return !stops_.empty(); }
  void stage_solved(const Marcher&, const StageView&) override {}
  void step_done(Marcher& marcher) override;
  NumberTable finish() const;

 private:
  long long step_of(long long k) const { return from_ + (to_ - from_) * k / count_; }

  StopList list_;
  StopPlaces places_;
  std::vector<int> stops_;
  long long from_ = 0, to_ = 0, count_ = 1, next_ = 0;
  std::vector<double> t_, values_;  // of each sample u₁, u₂ of each clearance
};

/// Columns of `orbits`.
struct OrbitColumns {
  const Series *stop = nullptr, *t = nullptr, *first = nullptr, *second = nullptr, *radius = nullptr;
};
const NumberType<OrbitColumns>& orbits_type();

}  // namespace ricochet
