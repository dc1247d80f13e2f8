#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "runners/report/asked_part.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/curve_data.hpp"

namespace ricochet::report {

/// What a kind puts on the page of its studies; what every page has (cases, effects, tables, environment) is not its
/// to say. Anything may be left empty.
struct KindPage {
  std::vector<std::string_view> scripts;     ///< the figures as JavaScript, in the page's order; what they share before
  std::vector<std::string_view> tables;      ///< tables of all cases that they read
  std::vector<std::string_view> own_tables;  ///< tables of single cases
  std::vector<std::string_view> curves;      ///< columns of the sampled curves, over t
  /// Tables that are worked out so that the page has nothing to work out; one without rows is left out.
  std::vector<std::function<Table(const Choices&)>> derived;
  /// The section "Answer" as HTML: sentences and tables made of rows.
  std::function<std::string(const Choices&)> answer;
  /// Tables of the page that a file keeps, between its answer and its figure.
  std::function<std::string(const Choices&)> summary;
  /// A section on the methods, after the figures.
  std::function<std::string(const Choices&)> methods;
  /// What the scripts read beside tables, under this key; large columns of numbers go to the blocks.
  std::string data_key;
  std::function<nlohmann::ordered_json(const Choices&, CurveData& blocks)> data;
  bool masses = true;       ///< colours tell the mass matrices apart
  AskedAnswers asked = {};  ///< of a study that asks: its first screen; `answer` goes beneath it
};

/// The scripts of these names: files NAME.js of the kinds' folders. Throws std::logic_error for one that is not there.
std::vector<std::string_view> scripts(std::initializer_list<const char*> names);

/// Those of the page's derived tables that have rows and that the results do not hold already, and what the effects
/// say.
std::vector<Table> page_tables(const Choices& choices, const KindPage& page);

// How much of each measure's variance is owed to each choice, from the table `effects`. Every kind's page has it.

/// What the shares of each measure's variance say, as a sentence, with what they leave out.
Table effects_said(const Choices& choices);

/// One sentence to quote per measure, what the shares leave out, and the table of shares. Empty without the table.
std::string effects_html(const Choices& choices);

}  // namespace ricochet::report
