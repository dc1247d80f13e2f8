#pragma once
#include <complex>
#include <ricochet/measure/stability/stability.hpp>
#include <ricochet/measure/stability/step_map.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// Gathers the roots of a step: the largest, and those that ought not to be marginal.
class RootCollector {
 public:
  RootCollector(const Damping& damping, double h, Detail detail) : damping_(damping), h_(h), detail_(detail) {}

  bool full() const { return detail_ == Detail::full; }
  double h() const { return h_; }
  const Damping& damping() const { return damping_; }
  void largest(const Root& root, double pulsation, bool on_kernel, const std::string& mode);

  /// A root that lives on a motion (m, c, k), of which `others` roots with this one are on the unit circle.
  void judge(const Root& root, double m, double c, double k, int others, double tolerance, RootPlace place,
             const std::string& where);

  StepSpectrum finish(const std::string& contact);

  StepSpectrum spectrum;

 private:
  void name(const Root& root, RootPlace place, const std::string& where);

  Damping damping_;
  double h_;
  Detail detail_;
  static constexpr std::size_t most_findings = 3;
};

}  // namespace ricochet
