#pragma once
#include <string>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet {

/// What a case that was marched again has in common with what is stored of it.
struct Comparison {
  std::size_t measures = 0, series = 0, tables = 0;  ///< compared: measures of the motion, columns of numbers, tables
  std::vector<std::string> differences;              ///< one sentence each; empty: the same to the last bit
};

/// Status, steps, measures (not those of the computation: its times), curve and tables of two records of a case, bit
/// for bit.
Comparison compare(const CaseRecord& stored, const CaseRecord& again);

/// "as stored to the last bit: 31 measures, 16 series, 2 tables", or what differs, a line each.
std::string text(const Comparison& comparison);

}  // namespace ricochet
