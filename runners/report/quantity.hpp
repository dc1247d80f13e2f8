#pragma once
#include <string>

#include "runners/store/record.hpp"

/// \file
/// How a report writes names with units, and some numbers.
namespace ricochet::report {

/// A name and a unit, for axes, headers and tooltips.
struct Quantity {
  std::string name, unit;
};

/// A unit as it is shown: "" for "1".
std::string shown_unit(const std::string& unit);

/// "name (unit)", without the unit where it is "1" or unknown.
std::string with_unit(const Quantity& quantity);

/// The name of an axis as it is read: of a stop of a list with the name of that, "stiffness of bar-a".
std::string axis_text(const StudyResults& results, const std::string& column);

/// A kind of error with its unit; "1" where the unit depends on the structure.
Quantity error_quantity(const std::string& error);

/// An order of convergence with two decimals: "1.00", "−0.03".
std::string order_number(double order);

/// 1e-3 as "10⁻³"; other numbers as they are.
std::string power_text(double value);

}  // namespace ricochet::report
