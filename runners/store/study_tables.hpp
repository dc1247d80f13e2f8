#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runners/table/row_type.hpp"

/// \file
/// Rows of the tables that studies of several kinds have.
namespace ricochet {

/// The column that names a measure of cases.csv.
inline constexpr char measure_name[] = "measure";

/// One row of `effects`: what a choice, or several together, explain of the spread of a measure.
struct EffectRow {
  std::string measure, factor;
  double share = 0;
  std::optional<double> low, high;
  bool log = false;
};
TableType<EffectRow> effects_type();

/// One row of `reasons`: why cases have no result, or a doubtful one.
struct ReasonRow {
  std::string status, reason;
  std::size_t cases = 0;
  std::string first;  ///< of these cases
};
TableType<ReasonRow> reasons_type();

/// Why a measure is left out of a case that no step approaches; the item is its name.
inline constexpr const char* no_limit =
    "no limit as the step shrinks: a rigid law throws a point with mass back within a step, by impulse over step";

/// The same of a number of impacts.
inline constexpr const char* no_count =
    "no limit as the step shrinks: a point that rebounds comes to rest on its stop, which it hits without number";

/// Whether a measure is left out for one of these: then its coarser steps have no limit either.
inline bool is_without_limit(const std::string& reason) {
  return reason == no_limit || reason == no_count;
}

namespace answers {

/// One thing that a sentence says of some methods: a row of `answers`.
struct Clause {
  int order = 0;  ///< of the sentence within the answer, from 1
  std::string
      form;  ///< keeps, gains, differ, none, open, matters, part, value, order, cheapest, limit, diagram, basin, status
  std::string measure = {}, choice = {};
  std::string who = {};      ///< the methods in words
  std::string methods = {};  ///< a case of each, blanks between
  std::optional<double> value = {}, low = {}, high = {}, uncertainty = {};
  std::string status = {};  ///< of the limit, or the verdict on a choice
  std::string unit = {};
  std::optional<double> at_step = {}, at_mesh = {};  ///< the finest, s and elements
  std::string sentence = {};                         ///< on the first clause of each sentence
};
const TableType<Clause>& answers_type();

}  // namespace answers
}  // namespace ricochet
