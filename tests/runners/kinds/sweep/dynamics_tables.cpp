#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/kinds/sweep/section_cases.hpp"

namespace dynamics_tables_tests {

TEST_CASE("methods that agree have one attractor, common to all, and a robust verdict") {
  std::vector<Method> methods;
  for (const double beta : {0.25, 0.5})
    for (const int steps : {2000, 8000}) methods.push_back(method(beta, steps, 20, moving));
  const StudyResults results = with_tables(study(methods, range(0.07, 0.09, 11)));
  const Derived values(results, "values"), attractors(results, "attractors"), verdicts(results, "intervals"),
      agreement(results, "agreement"), distances(results, "distances");
  CHECK(values.size() == 4 * 2 * 11);
  CHECK(values.text(0, "case") == id_of(methods[0]));
  CHECK(values.number(0, "time.beta") == 0.25);
  CHECK(identities(values) == std::set<std::string>{"1"});
  REQUIRE(attractors.size() == 1);
  CHECK(attractors.text(0, "label") == "common to all");
  CHECK(attractors.at(0, "cases") == 4);
  CHECK(attractors.number(0, "from") == 0.07);
  CHECK(attractors.number(0, "to") == 0.09);
  CHECK(attractors.at(0, "period") == 1);
  CHECK(attractors.number(0, "fraction") == 1);
  CHECK(attractors.number(0, "fraction_low") > 0.3);  // Wilson with two starts: 2/(2 + 1.96²) = 0.342
  CHECK(attractors.number(0, "fraction_low") < 0.35);
  REQUIRE(verdicts.size() == 1);
  CHECK(verdicts.text(0, "verdict") == "robust");
  CHECK(verdicts.text(0, "choice").empty());
  CHECK(verdicts.number(0, "from") == 0.07);
  CHECK(verdicts.number(0, "to") == 0.09);
  CHECK(verdicts.text(0, "sentence").find("11 values") != std::string::npos);
  REQUIRE(agreement.size() == 16);
  for (std::size_t k = 0; k < agreement.size(); ++k) CHECK(agreement.number(k, "share") == 1);
  // Against the most steps; of equals the first.
  REQUIRE(distances.size() == 3 * 2 * 11);
  CHECK(distances.text(0, "reference_case") == id_of(methods[1]));
  for (std::size_t k = 0; k < distances.size(); ++k) {
    CHECK(distances.number(k, "wasserstein") == 0);
    CHECK(distances.at(k, "ratio").is_nothing());  // an orbit that repeats exactly has no distance from itself
    CHECK(distances.text(k, "formula") == "exact");
  }
}

TEST_CASE("an attractor that some methods lack depends on the choice that they share") {
  std::vector<Method> methods;
  for (const double beta : {0.25, 0.3, 0.5})
    for (const int steps : {2000, 8000, 32000})
      methods.push_back(method(beta, steps, 20, [=](double a, const std::string& start) {
        Found found = moving(a, start);
        // A second orbit, seen from above between 0.074 and 0.082 where beta is large.
        if (beta == 0.5 && start == "up" && a > 0.0735 && a < 0.0825) found = orbit(-0.05 + a - 0.07, -0.6);
        // What shows as numerical viscosity.
        found.viscosity = beta == 0.5 ? 5e-6 : 1e-8;
        return found;
      }));
  const StudyResults results = with_tables(study(methods, range(0.07, 0.09, 21)));
  const Derived attractors(results, "attractors"), verdicts(results, "intervals");
  REQUIRE(attractors.size() == 2);
  CHECK(attractors.text(0, "label") == "common to all");
  CHECK(attractors.text(1, "label") == "depends on time.beta");
  CHECK(attractors.at(1, "cases") == 3);
  CHECK(attractors.number(1, "from") == Approx(0.074));
  CHECK(attractors.number(1, "to") == Approx(0.082));
  CHECK(attractors.number(1, "fraction") == 0.5);
  CHECK(attractors.text(1, "presence") == "time.beta 0.25: 0 of 3, 0.3: 0 of 3, 0.5: 3 of 3");
  REQUIRE(verdicts.size() == 3);
  CHECK(verdicts.column("verdict") == std::vector<Cell>{"robust", "depends", "robust"});
  CHECK(verdicts.text(1, "choice") == "time.beta");
  // Half way between two values.
  CHECK(verdicts.number(1, "from") == Approx(0.0735));
  CHECK(verdicts.number(1, "to") == Approx(0.0825));
  CHECK(verdicts.number(0, "to") == verdicts.number(1, "from"));
  const std::string sentence = verdicts.text(1, "sentence");
  INFO(sentence);
  CHECK(sentence.find("100 % of the differences between 9 cases") != std::string::npos);
  CHECK(sentence.find("0.25 gives periodic 1 (attractor 1)") != std::string::npos);
  CHECK(sentence.find("0.5 gives periodic 1 (attractor 1) and periodic 1 (attractor 2)") != std::string::npos);
  CHECK(sentence.find("3 of 9 cases, time.beta 0.5: up to 5e-06 s, 5 % of alpha") != std::string::npos);
}

TEST_CASE("an orbit and its mirror image are one attractor") {
  std::vector<Method> methods;
  for (const double beta : {0.25, 0.5})
    methods.push_back(method(beta, 2000, 20, [=](double a, const std::string& start) {
      Found found = moving(a, start);
      found.mirrored = (start == "up") != (beta == 0.5);
      return found;
    }));
  const StudyResults results = with_tables(study(methods, range(0.07, 0.09, 5)));
  CHECK(Derived(results, "attractors").size() == 1);
  const Derived distances(results, "distances");
  for (std::size_t k = 0; k < distances.size(); ++k) CHECK(distances.number(k, "wasserstein") == 0);
}

TEST_CASE("chaos of one method where the others repeat is told by that method") {
  std::vector<Method> methods;
  int seed = 0;
  for (const std::string contact : {"rigid", "soft"})
    for (const int elements : {10, 20})
      for (const int steps : {2000, 8000}) {
        ++seed;
        methods.push_back({{{"contact", contact}, {"elements", elements}, {"steps_per_period", steps}},
                           [=](double a, const std::string& start) {
                             if (contact == "soft" && a > 0.0809) return chaos(seed + a * 100 + start.size());
                             return moving(a, start);
                           }});
      }
  const StudyResults results = with_tables(study(methods, range(0.07, 0.09, 11)));
  const Derived attractors(results, "attractors"), verdicts(results, "intervals"), distances(results, "distances"),
      agreement(results, "agreement");
  REQUIRE(attractors.size() == 2);
  CHECK(attractors.text(1, "class") == "chaotic");
  CHECK(attractors.at(1, "period").is_nothing());
  CHECK(attractors.text(1, "label") == "depends on contact");
  REQUIRE(verdicts.size() == 2);
  CHECK(verdicts.text(1, "verdict") == "depends");
  CHECK(verdicts.text(1, "choice") == "contact");
  CHECK(verdicts.text(1, "sentence").find("soft gives chaotic (attractor 2)") != std::string::npos);
  for (std::size_t k = 0; k < distances.size(); ++k)
    CHECK(distances.at(k, "same_class").truth().value() ==
          (distances.text(k, "contact") == "rigid" || distances.number(k, "parameter") < 0.081));
  // Rigid against soft: the classes agree at 6 of 11 values.
  const auto rows = agreement.where("case", id_of(methods[0]));
  REQUIRE(rows.size() == 8);
  for (const std::size_t row : rows) {
    const bool soft = agreement.text(row, "other_case").starts_with("soft");
    CHECK(agreement.number(row, "share") == Approx(soft ? 6.0 / 11 : 1));
  }
}

TEST_CASE("runs of one chaotic attractor are no further apart than their null says") {
  std::vector<Method> methods;
  int seed = 0;
  for (const double beta : {0.25, 0.3, 0.5}) {
    ++seed;
    methods.push_back(method(beta, 2000, 20, [=](double a, const std::string& start) {
      return chaos(seed + a * 130 + static_cast<double>(start.size()), 0);
    }));
  }
  const StudyResults results = with_tables(study(methods, range(0.07, 0.09, 21), {"rest", "up", "state"}, 300));
  CHECK(Derived(results, "attractors").size() == 1);
  const Derived distances(results, "distances"), verdicts(results, "intervals");
  CHECK(verdicts.size() == 1);
  int beyond = 0;
  for (std::size_t k = 0; k < distances.size(); ++k) {
    CHECK(distances.text(k, "formula") == "sliced");
    beyond += distances.number(k, "ratio") > 1;
  }
  // One in 20 by construction, twice that for the null's own scatter; 126 comparisons.
  CHECK(beyond <= 0.1 * static_cast<double>(distances.size()));
  // Moved by a tenth of the gap, it is seen.
  methods[2].finds = [](double a, const std::string& start) { return chaos(3 + a * 130 + start.size(), 0.05); };
  const StudyResults moved = with_tables(study(methods, range(0.07, 0.09, 21), {"rest", "up", "state"}, 300));
  const Derived further(moved, "distances");
  for (const std::size_t row : further.where("time.beta", 0.5)) CHECK(further.number(row, "ratio") > 1);
}

TEST_CASE("what only coarse steps or meshes show vanishes under refinement") {
  std::vector<Method> methods;
  for (const double beta : {0.25, 0.5})
    for (const int elements : {10, 20})
      for (const int steps : {500, 2000, 8000})
        methods.push_back(method(beta, steps, elements, [=](double a, const std::string& start) {
          if (steps == 500 && start == "up") return orbit(-0.06 + a - 0.07, 0.9, 3);
          return moving(a, start);
        }));
  const StudyResults results = with_tables(study(methods, range(0.07, 0.09, 6)));
  const Derived attractors(results, "attractors"), verdicts(results, "intervals");
  REQUIRE(attractors.size() == 2);
  const auto coarse = attractors.where("class", "periodic");
  const auto third = attractors.where("period", 3);
  REQUIRE(third.size() == 1);
  CHECK(attractors.text(third[0], "label") == "vanishes under refinement");
  CHECK(attractors.text(attractors.where("period", 1)[0], "label") == "common to all");
  REQUIRE(verdicts.size() == 1);
  CHECK(verdicts.text(0, "choice") == "steps_per_period");
}

TEST_CASE("sections that converge with the step are at distances that converge") {
  std::vector<Method> methods;
  for (const int steps : {500, 1000, 2000, 64000})
    methods.push_back(method(0.5, steps, 20, [=](double a, const std::string&) {
      return orbit(0.02 + 0.5 * (a - 0.07) + (steps < 64000 ? 1.0 / steps : 0), 0.3);
    }));
  const StudyResults results = with_tables(study(methods, range(0.07, 0.09, 5), {"rest"}));
  const Derived distances(results, "distances");
  const auto at = [&](int steps) {
    return distances.number(distances.where("steps_per_period", steps)[0], "wasserstein");
  };
  // The same scale divides all; the displacement is proportional to the step.
  CHECK(at(500) / at(1000) == Approx(2).epsilon(1e-9));
  CHECK(at(1000) / at(2000) == Approx(2).epsilon(1e-9));
  CHECK(distances.text(0, "reference_case") == id_of(methods[3]));
}

TEST_CASE("shifts of located changes carry the intervals of both") {
  std::vector<Method> methods = {method(0.25, 2000, 20, moving), method(0.5, 8000, 20, moving)};
  StudyResults results = study(methods, range(0.07, 0.09, 5));
  const std::vector<Column> columns = bifurcations_head().columns;
  results.cases[0].tables.push_back({"bifurcations",
                                     "",
                                     columns,
                                     {{"up", "periodic 1", "chaotic", "change", 0.0853, 0.0852, 0.0854, 8},
                                      {"up", "periodic 1", "chaotic", "change", 0.0741, 0.0740, 0.0742, 8},
                                      {"up", "chaotic", "periodic 3", "change", 0.088, 0.0879, 0.0881, 8}}});
  results.cases[1].tables.push_back({"bifurcations",
                                     "",
                                     columns,
                                     {{"up", "periodic 1", "chaotic", "change", 0.085, 0.0849, 0.0851, 8},
                                      {"up", "no contact", "periodic 1", "grazing", 0.0792, 0.0791, 0.0793, 8},
                                      {"down", "chaotic", "periodic 3", "change", 0.088, 0.0879, 0.0881, 8}}});
  results = with_tables(std::move(results));
  const Derived shifts(results, "shifts"), changes(results, "bifurcations");
  CHECK(changes.size() == 6);
  CHECK(changes.text(3, "case") == id_of(methods[1]));
  REQUIRE(shifts.size() == 5);
  CHECK(shifts.number(0, "reference_value") == 0.085);
  CHECK(shifts.number(0, "shift") == Approx(0.0003));
  CHECK(shifts.number(0, "low") == Approx(0.0001));
  CHECK(shifts.number(0, "high") == Approx(0.0005));
  CHECK(shifts.at(0, "found") == true);
  // The grazing and the downward change have none here; two of this method's own are left over.
  for (const std::size_t row : {1, 2}) {
    CHECK(shifts.at(row, "value").is_nothing());
    CHECK(shifts.at(row, "shift").is_nothing());
    CHECK(shifts.at(row, "found") == false);
  }
  for (const std::size_t row : {3, 4}) CHECK(shifts.at(row, "reference_value").is_nothing());
}

TEST_CASE("what failed makes no attractor, and leaves its values open") {
  std::vector<Method> methods;
  for (const double beta : {0.1, 0.25, 0.5})
    methods.push_back(method(beta, 2000, 20, [=](double a, const std::string& start) {
      Found found = moving(a, start);
      if (beta == 0.1) found.status = "diverged";
      if (beta == 0.25 && a > 0.0849) found.regime = "undecided";
      return found;
    }));
  StudyResults results = study(methods, range(0.07, 0.09, 5));
  results.cases[0].numbers.clear();
  results = with_tables(std::move(results));
  const Derived values(results, "values"), verdicts(results, "intervals"), attractors(results, "attractors");
  for (const std::size_t row : values.where("class", "failed")) CHECK(values.at(row, "attractor").is_nothing());
  for (const std::size_t row : values.where("class", "undecided")) CHECK(values.at(row, "attractor").is_nothing());
  REQUIRE(attractors.size() == 1);
  CHECK(attractors.at(0, "cases") == 2);
  CHECK(attractors.text(0, "label") == "common to all");
  REQUIRE(verdicts.size() == 2);
  CHECK(verdicts.column("verdict") == std::vector<Cell>{"robust", "undecided"});
  CHECK(verdicts.text(0, "sentence").find("1 case without any decided value") != std::string::npos);
  CHECK(verdicts.text(1, "sentence").find("1 case left open (") != std::string::npos);
}

TEST_CASE("without points, or with one case, tables are smaller and nothing is invented") {
  std::vector<Method> methods = {method(0.25, 2000, 20, moving), method(0.5, 2000, 20, moving)};
  StudyResults bare = study(methods, range(0.07, 0.09, 5));
  for (CaseRecord& record : bare.cases) record.numbers.clear();
  bare = with_tables(std::move(bare));
  CHECK(Derived(bare, "attractors").size() == 1);
  const Derived distances(bare, "distances");
  for (std::size_t k = 0; k < distances.size(); ++k) {
    CHECK(distances.at(k, "wasserstein").is_nothing());
    CHECK(distances.at(k, "same_class") == true);
  }
  const StudyResults one = with_tables(study({methods[0]}, range(0.07, 0.09, 5)));
  CHECK(Derived(one, "attractors").text(0, "label") == "not compared");
  CHECK(Derived(one, "intervals").size() == 0);
  CHECK(Derived(one, "distances").size() == 0);
  StudyResults none;
  none.kind = "bifurcation";
  CHECK_NOTHROW(with_tables(none));
}

TEST_CASE("every row is as long as its columns, and no cell is NaN") {
  std::vector<Method> methods;
  for (const double beta : {0.25, 0.5})
    methods.push_back(method(beta, 2000, 20, [=](double a, const std::string& start) {
      return a > 0.08 && beta == 0.5 ? chaos(a) : moving(a, start);
    }));
  const StudyResults results = with_tables(study(methods, range(0.07, 0.09, 5)));
  std::set<std::string> names;
  for (const Table& table : results.derived) {
    CHECK(names.insert(table.name).second);
    for (const auto& row : table.rows) {
      CHECK(row.size() == table.columns.size());
      for (const Cell& cell : row) CHECK(std::isfinite(cell.number().value_or(0)));
    }
  }
  for (const char* name : {"values", "bifurcations", "attractors", "distances", "intervals", "agreement", "shifts"})
    CHECK(names.count(name) == 1);
}

TEST_CASE("the reference case has the stiffest contact, whatever its parameters are called") {
  struct Law {
    const char* name;
    double compliance;  ///< NaN: the law does not say
    int steps;
  };
  const std::vector<Law> laws = {
      {"foam", 1e-4, 32000}, {"rubber", 1e-6, 8000}, {"unknown", NAN, 64000}, {"plates", 0, 2000}, {"anvils", 0, 4000}};
  for (std::size_t known = 1; known <= laws.size(); ++known) {
    std::vector<Method> methods;
    for (std::size_t k = 0; k < known; ++k) {
      methods.push_back(method(0.5, laws[k].steps, 20, moving));
      methods.back().axes[0].second = laws[k].name;
      methods.back().axes[1] = {"contact.hardness", 1e3 * static_cast<double>(known - k)};
    }
    StudyResults results = study(methods, range(0.07, 0.08, 3));
    for (std::size_t k = 0; k < known; ++k) {
      NumberTable law = contact_law_type().head();
      law.add({laws[k].compliance});
      results.cases[k].numbers.push_back(std::move(law));
    }
    results = with_tables(std::move(results));
    if (known == 1) continue;
    const Derived distances(results, "distances");
    REQUIRE(distances.size() > 0);
    const std::size_t expected = known <= 3 ? 1 : known == 4 ? 3 : 4;
    CHECK(distances.text(0, "reference_case") == results.cases[expected].id);
  }
}

}  // namespace dynamics_tables_tests
