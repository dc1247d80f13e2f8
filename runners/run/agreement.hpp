#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runners/run/analysed_results.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {

class RoundOff;

/// How a case that was computed again agrees with the stored one.
///   bits    status, steps, measures, curve and tables are the same to the last bit, times left out
///   digits  every number is within |Δ| ≤ 1e-6 |x| + 2⁻⁵² n X
///   within  of the measures beyond that, each has |Δ| ≤ u; curve and tables are of another motion, and not compared
///   no      all else
/// x is the measure computed again, or the largest number of a column; n counts steps. X is the largest number of the
/// same unit in the case. u is what steps and meshes leave open of the measure for its method: of the value computed
/// again beside those stored of the other cases, as a stored value that is off would widen its own u.
enum class Agreement { bits, digits, within, no };

/// Compares cases of one study; both outlive this.
class AgreementOf {
 public:
  explicit AgreementOf(const AnalysedResults& results);

  /// `said` tells it in a line or more: "equal to six digits", or what differs.
  Agreement operator()(const CaseRecord& stored, const CaseRecord& again, std::string& said) const;

 private:
  struct Measures {
    std::vector<std::string> wrong = {};  ///< a sentence each
    std::size_t within_u = 0;             ///< beyond six digits
    double largest = 0;                   ///< difference of those, over u
  };
  Measures measures(const CaseRecord& stored, const CaseRecord& again, const RoundOff& round_off) const;

  /// The cases of the method that differ in step and mesh alone, this one with what was computed again.
  StudyResults of_its_method(const CaseRecord& stored, const CaseRecord& again) const;
  /// u of a measure that has this value; nothing where the method says none.
  std::optional<double> left_open(const Choices& method, const std::string& measure, double value) const;

  const AnalysedResults& results_;
  bool keeps_energy_;
  std::map<std::string, Cases> methods_ = {};  // by what tells them apart
};

}  // namespace ricochet
