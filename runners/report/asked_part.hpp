#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// \file
/// What a study asks and what is told of it, as pages and terminals show it.
namespace ricochet::report {

/// The rows of one answer as texts, one for each head.
struct AskedTable {
  std::vector<std::string> heads;
  std::vector<std::vector<std::string>> rows;
  std::size_t values = 0;  ///< the column of numbers
};

/// One ask, answered.
struct AskedPart {
  std::size_t number = 1;  ///< its place in the study's list
  std::string sentence;
  std::vector<std::string> aside;  ///< what is left out and what warns, a sentence each
  AskedTable table;
  /// See figure_svg(); null, or {"form": "own"}: the kind's own chart stands there.
  nlohmann::ordered_json figure = nullptr;
};

/// All of them; none of a study that asks nothing.
struct AskedAnswers {
  std::vector<std::string> first;  ///< what comes before all answers
  std::vector<AskedPart> parts;
};

/// The first screen: what warns, then each sentence with its table and its figure.
std::string asked_html(const AskedAnswers& asked);

}  // namespace ricochet::report
