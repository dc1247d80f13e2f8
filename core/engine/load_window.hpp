#pragma once
#include <limits>
#include <ricochet/engine/compile.hpp>
#include <vector>

namespace ricochet {

/// The distributed load F in model coordinates at the time levels that the current step needs, each assembled once.
class LoadWindow {
 public:
  explicit LoadWindow(const Program& program);

  /// Σ φ_k F(t + c_k h), n numbers that stay until the next call.
  const double* sum(const Levels& levels, double t);

 private:
  struct Entry {
    double level = std::numeric_limits<double>::quiet_NaN();  // in steps
    long long used = -1;                                      // when it was last asked for
    std::vector<double> value;
  };
  void assemble(double t, std::vector<double>& out);

  const SemiDiscrete* problem_;
  const MarchModel* model_;
  double h_;
  bool constant_;
  std::vector<Entry> entries_;
  std::vector<double> sum_, nodal_;
  std::vector<std::vector<double>> terms_;  // of the load
  long long clock_ = 0;
};

}  // namespace ricochet
