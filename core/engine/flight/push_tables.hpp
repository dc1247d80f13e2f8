#pragma once
#include <ricochet/engine/flight/flight_set.hpp>
#include <vector>

namespace ricochet {

/// Sums of one closed point's effort over many steps, by doubling. With p = w y of a step over the state y = (x, e) of
/// all modes, y⁺ = A y,
///
///     Σ_{i<2k} p_i = (l_k + l_k Aᵏ) y₀,     Σ_{i<2k} p_i² = y₀ᵀ (G_k + (Aᵏ)ᵀ G_k Aᵏ) y₀,     l_1 = w, G_1 = wᵀw (8)
///
/// A couples no two modes; G does. Error: round-off of the sums.
class PushTables {
 public:
  /// The shortest run, 2^shortest steps: shorter ones are read step by step for less.
  static constexpr int shortest = 9;

  PushTables(const FlightMotion& motion, const StepReadings& reading);
  /// Steps whose efforts cost about as much to read as tables cost to make, as bench_flight measures.
  static long long worth(const FlightMotion& motion);
  /// Bytes of the tables of one run.
  static double bytes(const FlightMotion& motion);

  /// Adds what 2^power steps from (x, e) on bring to Σ p (N) and Σ p² (N²); power ≥ shortest.
  void add(int power, const double* x, const double* e, double& sum, double& squares);

 private:
  void make_next();
  void keep();
  void times_motion(int power, const double* row, double* out) const;

  const FlightMotion& motion_;
  std::size_t size_;
  int made_ = 0;                                   // the power that row_ and form_ are of
  std::vector<double> row_, form_, state_;         // l, G by rows; y
  std::vector<std::vector<double>> rows_, forms_;  // of each power from the shortest run on; halves
  std::vector<double> moved_;                      // of the same size as G
};

}  // namespace ricochet
