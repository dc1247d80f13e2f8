#pragma once
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/energy/lane_sum.hpp>
#include <vector>

namespace ricochet {

/// The quadratic energies of a state after a stage: kinetic, elastic, and the scheme's own. Forms of one vector that
/// several of them ask for are evaluated once. Allocates when constructed; one lane at a time.
class StateEnergies {
 public:
  StateEnergies(const Marcher& marcher, const QuadraticForm& mass, const QuadraticForm& stiffness);

  struct Values {
    double kinetic = 0;  ///< ½ vᵀM v
    double elastic = 0;  ///< ½ qᵀK q
    double scheme = 0;   ///< 0 where the plan declares none
  };
  /// Where the velocity is a mean over a sub-step: `increment`, what the position moved by in it, contiguous (read only
  /// where no slot holds it), and how long it lasted (s).
  Values read(const double* const* slots, const double* increment, double duration, int lane);
  /// The scheme's own alone.
  double scheme(const double* const* slots, int lane);
  /// Where the elastic energy that was last read stands, contiguous; kept for laws that store energy.
  const double* place() const { return place_.data(); }

 private:
  struct Form {
    EnergyMatrix matrix = EnergyMatrix::M;
    WeighedTerms terms;
    bool plain = false;  // few enough vectors of one lane, all of them slots: square times the form of these by ratios
    double square = 0;
    double value = 0;
  };
  struct Share {
    std::size_t form = 0;
    double coefficient = 0;
  };
  std::size_t find(EnergyMatrix matrix, const Combination& c, double of_increment = 0);
  double evaluate(const Form& form, const double* const* slots, const double* increment, int lane, bool kept);

  CombinedForm mass_, stiffness_;
  int T_, slot_count_;
  bool mean_velocity_, compliant_;
  std::vector<Form> forms_;
  std::size_t kinetic_ = 0, elastic_ = 0;
  std::vector<Share> scheme_;
  Block place_, scratch_;
};

}  // namespace ricochet
