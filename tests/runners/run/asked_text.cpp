// Rows of answers as people read them: digits by the uncertainty, one unit in the head, no empty column.
#include "runners/run/asked_text.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;
using asks::Answered;
using asks::VerdictRow;
using Texts = std::vector<std::string>;

namespace {

VerdictRow row(const std::string& level, double value, double u, const std::string& unit, const std::string& verdict) {
  VerdictRow out;
  out.measure = "peak_force";
  out.level = level;
  out.value = value;
  out.low = value - u;
  out.high = value + u;
  out.unit = unit;
  out.verdict = verdict;
  return out;
}

Texts values_of(const report::AskedTable& table) {
  Texts out;
  for (const auto& one : table.rows) out.push_back(one.at(table.values));
  return out;
}

}  // namespace

TEST_CASE("values have as many digits as their uncertainty allows", "[asks]") {
  Answered answered;
  answered.rows = {row("a", 90.84665, 0.06023, "N", "known"), row("b", 2308.73, 75.49, "N", "known"),
                   row("c", 1.4434, 0.1346, "N", "known"), row("d", 3, 9.86, "N", "known"),
                   row("e", 0, 0, "N", "known")};
  const report::AskedTable table = asked_rows(answered);
  CHECK(table.heads == Texts{"level", "value (N)", "verdict"});
  CHECK(values_of(table) == Texts{"90.85 ± 0.06", "2310 ± 80", "1.44 ± 0.13", "3 ± 10", "0"});
}

TEST_CASE("units that differ stand in their rows, and a reason follows its verdict", "[asks]") {
  Answered answered;
  answered.rows = {row("", 1.4434, 0.1346, "mW", "open"), row("", 9.326, 0, "%", "half-width"),
                   row("", 28, 0, "1", "seeds")};
  answered.rows[0].reason = "one step";
  answered.rows[1].low = answered.rows[1].high = answered.rows[2].low = answered.rows[2].high = std::nullopt;
  const report::AskedTable table = asked_rows(answered);
  CHECK(table.heads == Texts{"value", "verdict"});
  CHECK(table.rows ==
        std::vector<Texts>{{"1.44 ± 0.13 mW", "open: one step"}, {"9.326 %", "half-width"}, {"28", "seeds"}});
}

TEST_CASE("an interval that is not symmetric is given by its ends, a bracket without a value, too", "[asks]") {
  Answered answered;
  answered.rows = {row("a", 0.56, 0, "m", "known"), row("b", 0, 0, "m", "threshold"), row("c", 0, 0, "m", "no value")};
  answered.rows[0].low = 0.5, answered.rows[0].high = 0.9;
  answered.rows[1].value.reset();
  answered.rows[1].low = 8e-4, answered.rows[1].high = 1e-3;
  answered.rows[2].value = answered.rows[2].low = answered.rows[2].high = std::nullopt;
  answered.rows[2].reason = "no case is done";
  const report::AskedTable table = asked_rows(answered);
  CHECK(values_of(table) == Texts{"0.56 (0.50 to 0.90)", "8e-4 to 0.001", ""});
  CHECK(table.rows[2].back() == "no value: no case is done");
}

TEST_CASE("an interval of no width in its digits is one number", "[asks]") {
  Answered answered;
  answered.rows = {row("a", 2.31e-4, 0, "s", "known"), row("b", 0, 0, "s", "period 1")};
  answered.rows[0].high = 2.31e-4 + 1e-12;
  answered.rows[1].value.reset();
  answered.rows[1].low = answered.rows[1].high = 2.65;
  CHECK(values_of(asked_rows(answered)) == Texts{"2.31e-4", "2.65"});
}

TEST_CASE("a table without any value has no column of numbers", "[asks]") {
  Answered answered;
  VerdictRow one;
  one.level = "a";
  one.verdict = "no value";
  answered.rows = {one};
  const report::AskedTable table = asked_rows(answered);
  CHECK(table.heads == Texts{"level", "verdict"});
  CHECK(table.values >= table.heads.size());
}
