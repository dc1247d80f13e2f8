#pragma once
#include <optional>
#include <string>

#include "runners/store/record.hpp"
#include "runners/table/text.hpp"

/// \file
/// Numbers as sentences say them: no digit that the uncertainty does not bear.
namespace ricochet::answers {

/// How values of a measure are said: those of a comparison are shares of a scale, or numbers with a unit.
struct MeasureWords {
  std::string measure;          ///< its key
  std::string words;            ///< "energy left"
  std::string unit;             ///< "%", "N s", …; "" of counts
  double factor = 1;            ///< 100 of per cents
  std::string scale;            ///< see MeasureInfo
  bool decades = false;         ///< differences are factors
  int direction = 0;            ///< 1: more is better, −1: less is, 0: neither
  std::optional<double> truth;  ///< what an exact method gives, in a conservative scene
  std::optional<double> most;   ///< what no method without a gain exceeds, in any scene
};
/// Of a measure that its kind declares; words of its key where it says none.
MeasureWords measure_words(const std::string& measure);

/// A value as its uncertainty u allows: to one digit of u, two where that begins with 1. Near 100 %, 100 − v keeps two
/// digits. Without an uncertainty four digits.
std::string value_text(const MeasureWords& measure, double value, std::optional<double> uncertainty,
                       bool with_unit = true);
/// "83 to 87 %": both to one digit of half the width; one value where they are equal then.
std::string range_text(const MeasureWords& measure, double low, double high, std::optional<double> uncertainty = {});
/// An uncertainty alone: "0.006 %".
std::string uncertainty_text(const MeasureWords& measure, double uncertainty);
/// "43.12 ± 0.03 %"; without an uncertainty the value alone.
std::string with_uncertainty(const MeasureWords& measure, double value, std::optional<double> uncertainty);

/// A share in per cent to two digits: "0.012 %", "39 %", "the same" below 1e-7 %, "12 times" from 1000 % on.
std::string percent(double share);

/// The same with as many more digits as tell it from another share.
std::string percent_beside(double share, double other);

/// "1 of 48 cases".
std::string capitalised(std::string text);

}  // namespace ricochet::answers
