#pragma once
#include <ricochet/contract/contact_law.hpp>

namespace ricochet {

/// Where one side of one contact point stands when its force is asked.
struct ContactState {
  double depth = 0;   ///< δ, beyond the bound that the solver was given, m (positive: beyond)
  double rate = 0;    ///< δ̇, the speed of closing, m/s; 0 where the problem has no rate
  double before = 0;  ///< δ⁻, the depth one step before, m; 0 where the problem has none
  int point = 0, lane = 0;
};

/// The force of one side, and how it answers. Slopes ≥ 0 for a law that does not soften.
struct PointForce {
  double value = 0;        ///< p ≥ 0, N
  double stiffness = 0;    ///< ∂p/∂δ, N/m
  double viscosity = 0;    ///< ∂p/∂δ̇, N s/m
  double before = 0;       ///< ∂p/∂δ⁻, N/m
  double dissipation = 0;  ///< power that does not come back, (p − U′(δ)) δ̇ ≥ 0, W
};

/// A compliant law, one point and one side at a time: p = Φ(δ, δ̇, δ⁻), zero where neither δ nor δ⁻ is positive, and
/// growing, at least not falling, with δ and δ̇. Both sides have the same law; what a point feels is Φ of the lower stop
/// minus Φ of the upper one.
class PointwiseLaw {
 public:
  virtual ~PointwiseLaw() = default;
  virtual PointForce force(const ContactState& state) const = 0;
};

}  // namespace ricochet
