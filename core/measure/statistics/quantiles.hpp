#pragma once
#include <vector>

namespace ricochet {

/// The value below which a share `at` ∈ [0, 1] of sorted values lies: linear between neighbours, the first of which
/// stands at 0 and the last at 1. There is at least one.
double sorted_quantile(const std::vector<double>& sorted, double at);

/// The middle value; the mean of the two middle ones of an even number. There is at least one.
double median(std::vector<double> values);

/// The middle value that is one of them: the lower of the two middle ones of an even number.
double lower_median(std::vector<double> values);

}  // namespace ricochet
