// What comparing studies answer: orders by method, the cheapest for an accuracy.
#include "runners/kinds/comparison/comparison_answers.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

StudyResults two_schemes() {
  StudyResults results;
  results.columns = {"mass", "contact", "time", "step"};
  for (const char* scheme : {"one", "other"}) {
    CaseRecord record;
    record.id = scheme;
    record.status = "done";
    record.axes = {{"mass", "full"}, {"contact", "rigid"}, {"time", scheme}, {"step", 1e-3}};
    results.cases.push_back(std::move(record));
  }
  return results;
}

/// Two schemes over six steps, errors hᵖ of each, those of the second not below `level`.
StudyResults two_orders(double p, double q, double level, std::optional<double> declared = {}) {
  StudyResults results;
  results.columns = {"time", "step"};
  results.study = {{"errors", {"tip-l2"}}};
  for (const char* scheme : {"one", "other"})
    for (int k = 0; k < 6; ++k) {
      const double h = std::pow(2, -k);
      CaseRecord record;
      record.id = scheme + std::to_string(k);
      record.status = "done";
      record.axes = {{"time", scheme}, {"step", h}};
      const bool first = std::string(scheme) == "one";
      record.measures = {{"error.tip-l2", std::max(std::pow(h, first ? p : q), first ? 0 : level)}, {"size.tip-l2", 1}};
      if (declared) record.measures.emplace_back("declared_order", *declared);
      results.cases.push_back(std::move(record));
    }
  return results;
}

std::string sentences(const answers::Answer& answer) {
  std::string out;
  for (const answers::Sentence& one : answer.sentences) out += one.text + "\n";
  return out;
}

}  // namespace

TEST_CASE("orders are told by method, the highest first, and confirmed or contradicted where they are declared") {
  StudyResults results = two_orders(2, 1, 0);
  CHECK_THAT(sentences(orders_answer(answers::Compared(results))),
             Contains("falls with order 2 (2.00) with one; order 1 (1.00) with other."));
  results = two_orders(2, 1, 0, 2);
  CHECK_THAT(sentences(orders_answer(answers::Compared(results))),
             Contains("with one, as declared") && Contains("with other, which declares another"));
}

TEST_CASE("who stops is told at the smallest error, never above it") {
  const StudyResults results = two_orders(2, 2, 0.05);
  CHECK_THAT(sentences(orders_answer(answers::Compared(results))),
             Contains("It stops at 0.05 m (5 % of the motion) with other"));
}

TEST_CASE("the cheapest method of an accuracy is named with its step, and those within its timing noise") {
  StudyResults results = two_orders(2, 1, 0);
  results.study = {{"errors", {"tip-l2"}}};
  for (CaseRecord& record : results.cases) {
    const double seconds = 1e-3 / record.axes.back().second.get<double>();
    for (const char* name : {"timed_seconds", "timed_low", "timed_high"}) record.measures.emplace_back(name, seconds);
  }
  const std::string text = sentences(precision_answer(answers::Compared(results)));
  // Of order 2 an error of 0.1 % is reached at h = 1/32, which order 1 never reaches.
  CHECK_THAT(text, Contains("For 0.1 % of the motion: one at h = 0.03125 s, 32 ms."));
  CHECK_THAT(text, Contains("Never to 1 %: 1 of 2 methods, other"));
}

TEST_CASE("beside an order that lasts one met in passing is none, where it is not like it") {
  StudyResults results = two_orders(2, 1, 0);
  // Three errors of the other fall with order 4 and then stay.
  int k = 0;
  for (CaseRecord& record : results.cases)
    if (record.axes.front().second == "other") record.measures.front().second = std::pow(2, -4 * std::min(k, 2)), ++k;
  const std::string text = sentences(orders_answer(answers::Compared(results)));
  CHECK_THAT(text, Contains("order 2 (2.00) with one.") && Contains("It stops at 0.0039 m"));
}

TEST_CASE("the accuracy that the question names is told first, reached or not") {
  StudyResults results = two_orders(2, 1, 0);
  for (CaseRecord& record : results.cases) {
    const double seconds = 1e-3 / record.axes.back().second.get<double>();
    for (const char* name : {"timed_seconds", "timed_low", "timed_high"}) record.measures.emplace_back(name, seconds);
  }
  results.question = "What does an error of 7 % cost?";
  CHECK_THAT(sentences(precision_answer(answers::Compared(results))),
             Catch::Matchers::StartsWith("For 10 and 7 % of the motion: one at h = 0.25 s, 4 ms"));
  results.question = "What does a millionth cost?";
  CHECK_THAT(sentences(precision_answer(answers::Compared(results))),
             Catch::Matchers::StartsWith("For 1e-4 % of the motion: none; the best is one at h = 0.03125 s, 0.098 %."));
}

TEST_CASE("a way of marching is part of the method: both ways of one scene stand against each other") {
  CHECK(is_method("march"));
  CHECK(is_method("mass.velocity"));
  CHECK_FALSE(is_method("structure.damping.stiffness"));
  CHECK(is_scene("structure.damping.stiffness"));
  for (const char* column : {"march", "step", "elements", "time.beta"}) CHECK_FALSE(is_scene(column));
  StudyResults results = two_schemes();
  results.columns = {"mass", "contact", "time", "march", "step"};
  results.study = {{"errors", {"tip-linf"}}};
  const double seconds[] = {3e-3, 2e-4};
  for (std::size_t k = 0; k < 2; ++k) {
    CaseRecord& record = results.cases[k];
    record.axes = {{"mass", "full"},
                   {"contact", "rigid"},
                   {"time", "one"},
                   {"march", k ? "flights" : "every-step"},
                   {"step", 1e-3}};
    record.measures = {
        {"error.tip-linf", 1e-5}, {"size.tip-linf", 1e-2}, {"timed_seconds", seconds[k]}, {"steps_visited", 1}};
  }
  const Table targets = precision_targets_table(results);
  REQUIRE_FALSE(targets.rows.empty());
  const TableReader rows(targets);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    CHECK(rows.text(row, "case") == "other");
    CHECK(rows.text(row, "other_case") == "one");
  }
}
