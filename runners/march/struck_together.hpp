#pragma once
#include <optional>
#include <ricochet/measure/contact/contact_instants.hpp>
#include <ricochet/measure/contact/stop_places.hpp>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {

/// Looks at which stops with names push at the instants at which one is struck, in lane 0. Told by an ImpactRecorder.
/// Stops without names are one stop along the structure, and nothing is looked at.
class StruckTogether final : public ContactListener {
 public:
  explicit StruckTogether(const Marcher& marcher);

  void instant(const ContactInstant& one) override;
  void over(double time) override;

  /// A sentence where a rigid law chose among outcomes; "" where it did not. Between contacts i and j whose efforts
  /// have the signs s_i and s_j, and W = H S⁻¹ Hᵀ of the step (of its jump where it has one), the outcome of a common
  /// impact is continuous in the data only where
  ///
  ///     W_ij = 0 for a restitution e > 0,     s_i s_j W_ij ≤ 0 for e = 0
  ///
  /// (Paoli 2005, Continuous dependence on data for vibro-impact problems, Math. Models Methods Appl. Sci. 15, 53-93).
  /// `restitution`: the largest e of the stops; none: the scheme has none, and its rebounds are those of e > 0. |W_ij|
  /// below 1e-3 √(W_ii W_jj) is 0.
  Said told(const Marcher& marcher, std::optional<double> restitution) const;

 private:
  using Set = std::vector<std::pair<int, int>>;  // contact points and signs of their efforts
  static constexpr std::size_t most_sets = 32;

  StopList list_;
  bool watches_ = false, struck_ = false;
  Set pushed_;
  std::vector<std::pair<Set, double>> sets_;  // and when each was first met
};

}  // namespace ricochet
