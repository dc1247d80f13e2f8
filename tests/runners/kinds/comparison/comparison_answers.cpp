// What comparing studies answer: errors by words, orders that were declared and others.
#include "runners/kinds/comparison/comparison_answers.hpp"

#include <catch2/catch.hpp>

#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/kinds/kind.hpp"
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

std::string sentences(const Table& answers) {
  const TableReader rows(answers);
  std::string out;
  for (std::size_t row = 0; row < rows.size(); ++row) out += rows.text(row, "sentence") + "\n";
  return out;
}

}  // namespace

TEST_CASE("an answer names an error by words, never by its column") {
  for (const std::string error : {"tip-linf", "tip-l2", "displacement-l2", "displacement-h2", "velocity-l2", "energy",
                                  "impact-times", "impulse"}) {
    StudyResults results = two_schemes();
    Table targets{
        "precision_targets",
        "",
        named_columns({"case", "error", "at_most", "seconds", "other_case", "other_seconds", "overlap", "share"}),
        {}};
    targets.rows.push_back({"one", error, 1e-3, 2e-4, "other", 3e-4, false, 0.01});
    results.derived.push_back(std::move(targets));
    Table answers = answers_head();
    say_precision(results, answers);
    const std::string text = sentences(answers);
    CHECK_THAT(text, Contains("error of the ") && Contains("at most 1 % of the motion: one"));
    if (error.find('-') != std::string::npos) CHECK(text.find(error) == std::string::npos);
    CHECK(TableReader(answers).text(0, "measure") == "error." + error);
  }
}

TEST_CASE("an error against a reference of the mesh is said to be that of the scheme alone") {
  StudyResults results = two_schemes();
  Table targets{
      "precision_targets",
      "",
      named_columns({"case", "error", "at_most", "seconds", "other_case", "other_seconds", "overlap", "share"}),
      {}};
  targets.rows.push_back({"one", "tip-linf", 1e-3, 2e-4, "other", 3e-4, false, 0.01});
  results.derived.push_back(std::move(targets));
  for (const bool of_the_mesh : {false, true}) {
    results.cases.front().measures = {{"reference_of_mesh", of_the_mesh}};
    Table answers = answers_head();
    say_precision(results, answers);
    CHECK((sentences(answers).find("the same mesh and mass exact in time") != std::string::npos) == of_the_mesh);
  }
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

TEST_CASE("orders that nobody declares are told by their middle, and their ends") {
  StudyResults results = two_schemes();
  Table orders{"orders", "", named_columns({"case", "refined", "order", "declared", "verdict"}), {}};
  for (const double order : {0.9, 1.0, 4.0}) orders.rows.push_back({"one", "step", order, nullptr, ""});
  for (const double order : {1.9, 2.0}) orders.rows.push_back({"other", "step", order, 1, "refuted"});
  results.derived.push_back(std::move(orders));
  Table answers = answers_head();
  say_orders(results, answers);
  CHECK_THAT(sentences(answers), Contains("one (median 1.00; 0.90 to 4.00)"));
  CHECK_THAT(sentences(answers), Contains("Do not converge as they declare: other (declared 1, found 1.90 to 2.00"));
}
