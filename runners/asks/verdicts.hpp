#pragma once
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "runners/answers/thirty_words.hpp"
#include "runners/table/row_type.hpp"

namespace ricochet::asks {

/// A verdict where the question has a yes or a no.
enum class Verdict { yes, no, open };
constexpr std::array<const char*, 3> words_of(Verdict) {
  return {"yes", "no", "open"};
}
/// Yes where all are, no where none is yes and none open; open otherwise.
Verdict all_of(const std::vector<Verdict>& verdicts);

/// One row of `verdicts`: what is known of one level, or, with a sentence, the answer of an ask.
struct VerdictRow {
  std::size_t ask = 0;
  std::string verb = {}, measure = {}, level = {}, stop = {};
  std::optional<double> value = {}, low = {}, high = {};
  std::string unit = {}, verdict = {}, reason = {};
  std::optional<std::size_t> cases = {}, left_out = {};
  std::string sentence = {};
  std::string of_case = {};  ///< a case with these levels, by id; no column
  bool allowed = false;      ///< whether its numbers must not be exceeded, and are told rounded down; no column
  bool given = false;        ///< whether the value is the ask's own, told in full; no column
};
const TableType<VerdictRow>& verdicts_type();

/// What a case does at one place of a sweep, in a word.
struct WordAtPlace {
  std::string of_case, level;  ///< its id, and its levels in words
  std::string place;           ///< "0.0719 m, start rest"
  std::string word;            ///< "period 2"
  bool known = true;           ///< false of "undecided"
};

/// What answers one ask. The rows hold every number that the sentence says.
struct Answered {
  std::string sentence;                 ///< at most thirty words, yes or no first where it has one
  std::string verdict;                  ///< of the whole
  std::optional<Verdict> passes;        ///< of an ask that has a yes or a no
  std::string reason = {};              ///< why it is open, or has no value
  std::vector<VerdictRow> rows = {};    ///< one for each level
  std::vector<std::string> aside = {};  ///< what was left out and what warns, a sentence each
  std::size_t cases = 0, left_out = 0;
  /// Where the same ask of another result is compared by words, these stand in place of rows.
  std::vector<WordAtPlace> words = {};
  /// What is drawn beside the sentence: {"form", …}; null: nothing.
  nlohmann::ordered_json figure = nullptr;
};

inline constexpr double per_cent = 100;  ///< rows and figures have shares in per cent

using answers::fits, answers::in_thirty_words, answers::words_in;

}  // namespace ricochet::asks
