#pragma once
#include <Eigen/Core>
#include <memory>

/// \file
/// C++17, and nothing of Ricochet's own: headers of Siconos 4.4 do not compile as C++20.
namespace ricochet::benchmarks {

/// M q'' + C q' + K q = −φ'' s + Hᵀp, lower ≤ H q + φ ≤ upper, C = αK, φ = A sin ωt; r has H r = 1.
struct ShakenBeam {
  Eigen::MatrixXd M, K, H;
  double viscosity = 0;                             ///< α, s
  Eigen::VectorXd support_shape, translation, tip;  ///< s (kg), r, the tip's row
  Eigen::VectorXd lower, upper, position, velocity;
  double amplitude = 0, pulsation = 0;  ///< A (m), ω (rad/s)
};

/// A trajectory of Siconos: Moreau–Jean with θ = ½ and e = 0 on the matrices of a problem, one relation per contact
/// point and side, LCP. Siconos knows no moving clamp, so it marches the absolute displacement u = q + r χ(t) between
/// fixed stops, r the rigid translation (H r = 1) and v_u = v + r φ'. With
///
///     κ = tan(ωh/2)/(ωh/2),     χ = φ/κ,     F = φ''(κ M r − s) + φ' C r + χ K r
///
/// its discrete equations of motion and impacts are those of q, term by term. φ' is the trapezoidal derivative of χ,
/// and κφ'' that of φ'. Gap tests alone see χ in place of φ, (ωh)²/12 of it apart.
class SiconosBeam {
 public:
  /// How the linear part is stored.
  enum class Form {
    dense,   ///< LagrangianLinearTIDS, M, K and C as dense matrices
    sparse,  ///< the same, stored sparse
    modes,   ///< LagrangianLinearDiagonalDS: q = Φη, ΦᵀMΦ = 1, ΦᵀKΦ diagonal, relations through HΦ
  };
  enum class Solver { lemke, pgs };
  /// What holds of a point that passes the gap test but leaves its stop, w⁻ > 0.
  enum class Leaving {
    stopped,  ///< w⁺ ≥ 0: Siconos's own rule
    passing,  ///< w⁺ ≥ −w⁻: Ricochet's rule
  };

  SiconosBeam(ShakenBeam beam, double h, long long steps, Form form, Leaving leaving, Solver solver);
  ~SiconosBeam();
  SiconosBeam(SiconosBeam&&) noexcept;

  void step();
  /// Absolute displacement of the tip, m.
  double tip() const;
  /// Σ of the impulses of the last step, N s, and how many points were pushed.
  double impulse() const;
  int pushed() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ricochet::benchmarks
