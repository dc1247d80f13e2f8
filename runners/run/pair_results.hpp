#pragma once
#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ricochet/contract/worded.hpp>
#include <string>
#include <vector>

#include "runners/asks/verdicts.hpp"
#include "runners/run/analysed_results.hpp"
#include "runners/run/compare_studies.hpp"

/// \file
/// Two results of one kind beside each other: what each knows, and what changed beyond that.
namespace ricochet {

/// What became of a value [a⁻, a⁺] in [b⁻, b⁺]. `beyond`: the intervals share no value, |b − a| > u with u the sum of
/// the half intervals that face each other. `no_interval`: different values, of which one at least has none. Of words:
/// equal, beyond, or `no_interval` where one is "undecided".
enum class PairChange { equal, within, beyond, no_interval, only_a, only_b };
constexpr std::array<const char*, 6> words_of(PairChange) {
  return {"equal", "within u", "changed", "no interval", "only in A", "only in B"};
}

/// The same thing in both: of one ask, measure, level of all choices, stop and unit.
struct PairedValue {
  std::string table;  ///< verdicts, limits or uncertainty
  std::string of;     ///< the ask as JSON; "" of other tables
  std::optional<asks::VerdictRow> a = {}, b = {};
  PairChange change = PairChange::equal;
  bool in_words = false;                          ///< two verdicts at one place, and no numbers
  std::optional<double> difference = {}, u = {};  ///< b − a, and what the intervals leave of it

  const asks::VerdictRow& any() const { return a ? *a : *b; }
  bool has_values() const;
  /// The levels of all choices in words, and what a number without an interval is where the table says it:
  /// "half-width".
  std::string level() const;
};

/// An ask with both answers; a null pointer where one does not ask it. These are of the results.
struct PairedAsk {
  std::string ask;  ///< as JSON
  const asks::Answered *a = nullptr, *b = nullptr;
};

struct PairedResults {
  StudyComparison facts;  ///< inputs, environment and cases that differ
  std::vector<PairedAsk> asks;
  std::vector<PairedValue> values;  ///< table by table, in A's order, then what B alone has

  std::size_t count(PairChange change) const;
  /// Those in words or in numbers alone.
  std::size_t count(PairChange change, bool in_words) const;
};

/// Rows of verdicts, limits and uncertainty. A limit is found again by its case's levels on the axes of both, step and
/// mesh left out. Both outlive what is returned.
PairedResults pair_results(const AnalysedResults& a, const AnalysedResults& b);

/// "3 changed, 5 within u, 1 only in A"; "none".
std::string counts_line(const PairedResults& pairs);
/// The whole in a sentence.
std::string paired_verdict(const PairedResults& pairs);
/// What a person reads, a screen of it; what changed beyond u comes first.
std::string paired_text(const PairedResults& pairs, const AnalysedResults& a, const AnalysedResults& b);
/// A row for each fact that differs and for each value.
Table paired_table(const PairedResults& pairs);
/// {"a", "b", "counts", "rows"}; rows are those of the table.
nlohmann::ordered_json paired_json(const PairedResults& pairs, const AnalysedResults& a, const AnalysedResults& b);
/// The same as a page that needs no network.
std::string paired_page(const PairedResults& pairs, const AnalysedResults& a, const AnalysedResults& b);

}  // namespace ricochet
