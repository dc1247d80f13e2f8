#pragma once
#include <ricochet/engine/flight/flight_motion.hpp>

namespace ricochet {

/// Works over many steps, J.
struct FlightSums {
  double damping = 0;  ///< Σ sᵀC r
  double loads = 0;    ///< Σ sᵀF̄, and the support's work through the stops
  double scheme = 0;   ///< Σ of the plan's loss terms
  double contact = 0;  ///< Σ p̄ᵀ(H s + Δφ); points that rest on rigid stops do none
  double law = 0;      ///< what the law dissipates of it
  double gain = 0;     ///< contact − damping − scheme of the step where that is largest, not below 0

  FlightSums& operator+=(const FlightSums& other);
};

/// Σ over k steps of quantities that are quadratic in the state of each mode, y = (x, e):
///
///     Σ_{i<2k} y_iᵀ Q y_i = y₀ᵀ (Gₖ + Aₖᵀ Gₖ Aₖ) y₀,     Gₖ = Σ_{i<k} (Aⁱ)ᵀ Q Aⁱ (5)
class FlightWorks {
 public:
  /// Q of each mode over (x, e), symmetric; empty: zero.
  using Form = std::vector<Eigen::MatrixXd>;
  struct Forms {
    Form damping, loads, scheme;
  };
  FlightWorks(const FlightMotion& motion, const Forms& forms);

  /// Adds what 2^power steps from (x, e) on bring.
  void add(int power, const double* x, const double* e, FlightSums& sums) const;
  /// Whether neither damping nor the scheme gives energy in any step, whatever the state.
  bool never_gains() const { return never_gains_; }

 private:
  using Tables = std::vector<std::vector<double>>;  // of a power: width(width+1)/2 × modes; empty: zero
  static Tables tables(const FlightMotion& motion, const Form& form);

  int modes_, slots_, drives_;
  Tables damping_, loads_, scheme_;
  bool never_gains_ = true;
};

}  // namespace ricochet
