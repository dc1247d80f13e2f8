// What a bifurcation study owes to its methods, on studies whose answer is known.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <set>

#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/table/table_reader.hpp"

using namespace ricochet;

namespace {

using Json = nlohmann::ordered_json;

/// What a case would have found for one value and one start.
struct Found {
  std::string regime = "periodic";
  int period = 1;
  std::function<std::array<double, 2>(int)> point;  ///< of period k
  bool mirrored = false;                            ///< the mirror image of that
  double viscosity = 0;
  std::string status = "done";
};

/// Two orbits that are told apart: one near the stops, one near the middle.
Found orbit(double x, double v, int period = 1) {
  return {"periodic", period, [=](int k) { return std::array{x + 0.03 * (k % period), v - 0.2 * (k % period)}; }};
}

/// Chaos of the logistic map, from a start that depends on `seed`, so that no two runs have the same points.
Found chaos(double seed, double centre = 0) {
  auto x = std::make_shared<std::vector<double>>(1, 0.1 + 0.8 * std::fmod(0.618 * seed, 1));
  return {"chaotic", 0, [=](int k) {
            while (static_cast<int>(x->size()) < k + 60) x->push_back(3.9 * x->back() * (1 - x->back()));
            const auto at = static_cast<std::size_t>(k + 50);
            return std::array{centre + 0.1 * ((*x)[at] - 0.5), (*x)[at + 1] - 0.5};
          }};
}

struct Method {
  std::vector<std::pair<std::string, Json>> axes;
  std::function<Found(double value, const std::string& start)> finds;
};

std::string id_of(const Method& method) {
  std::string id;
  for (const auto& [name, value] : method.axes)
    id += (value.is_string() ? value.get<std::string>() : value.dump()) + ";";
  return id;
}

CaseRecord make_case(const Method& method, const std::vector<double>& values, const std::vector<std::string>& starts,
                     int keep) {
  CaseRecord record;
  record.id = id_of(method);
  record.axes = method.axes;
  record.status = "done";
  Table table{"values",
              "",
              named_columns({"parameter", "start", "class", "period", "impacts_per_period", "symmetric",
                             "exponent_method", "attractor", "alpha_equivalent", "status", "reason"}),
              {}};
  NumberTable points = points_type().head();
  points.words = {{"start", starts}};
  for (std::size_t s = 0; s < starts.size(); ++s)
    for (const double value : values) {
      const Found found = method.finds(value, starts[s]);
      const bool done = found.status == "done";
      table.rows.push_back({value, starts[s], done ? found.regime : "failed",
                            found.period > 0 ? Cell(found.period) : Cell(), 2.0, nullptr, "", nullptr, found.viscosity,
                            found.status, done ? "" : "it diverged"});
      for (int k = 0; done && found.point && k < keep; ++k) {
        // The orbits here are no images of themselves: half a period later they are 0.06 and 0.5 lower.
        std::array<double, 2> here = found.point(k), opposite = {0.06 - here[0], 0.5 - here[1]};
        if (found.mirrored) std::swap(here, opposite);
        points.add({value, static_cast<double>(s), static_cast<double>(k), here[0], here[1], opposite[0], opposite[1]});
      }
    }
  record.tables.push_back(std::move(table));
  record.numbers.push_back(std::move(points));
  return record;
}

StudyResults study(const std::vector<Method>& methods, const std::vector<double>& values,
                   const std::vector<std::string>& starts = {"rest", "up"}, int keep = 120) {
  StudyResults results;
  results.kind = "bifurcation";
  results.study = {{"parameter", {{"pointer", "/scene/support/amplitude"}, {"values", values}}},
                   {"section", "strobe"},
                   {"scene", {{"structure", {{"damping", {{"stiffness", 1e-4}}}}}}}};
  for (const auto& [name, value] : methods.front().axes) results.columns.push_back(name);
  for (const Method& method : methods) results.cases.push_back(make_case(method, values, starts, keep));
  results.expected_cases = static_cast<int>(methods.size());
  return results;
}

/// A derived table, read by column.
class Derived {
 public:
  Derived(const StudyResults& results, const std::string& name) : table_(find_table(results.derived, name)) {
    REQUIRE(table_ != nullptr);
  }
  std::size_t size() const { return table_->rows.size(); }
  const Cell& at(std::size_t row, const std::string& column) const {
    const TableReader rows(*table_);
    return rows.cell(row, rows.column(column));
  }
  std::vector<Cell> column(const std::string& name) const {
    std::vector<Cell> out;
    for (std::size_t k = 0; k < size(); ++k) out.push_back(at(k, name));
    return out;
  }
  std::string text(std::size_t row, const std::string& column) const { return at(row, column).text(); }
  double number(std::size_t row, const std::string& column) const { return at(row, column).number().value(); }
  /// Rows that hold `value` in a column.
  std::vector<std::size_t> where(const std::string& name, const Cell& value) const {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < size(); ++k)
      if (at(k, name) == value) out.push_back(k);
    return out;
  }

 private:
  const Table* table_ = nullptr;
};

std::vector<double> range(double from, double to, int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k) out.push_back(from + (to - from) * k / (count - 1));
  return out;
}

Method method(double beta, int steps, int elements, std::function<Found(double, const std::string&)> finds) {
  return {{{"contact", "rigid"},
           {"time", "scheme"},
           {"time.beta", beta},
           {"elements", elements},
           {"steps_per_period", steps}},
          std::move(finds)};
}

std::set<std::string> identities(const Derived& values) {
  std::set<std::string> out;
  for (const Cell& attractor : values.column("attractor")) out.insert(attractor.text());
  return out;
}

const auto moving = [](double a, const std::string&) { return orbit(0.02 + 0.5 * (a - 0.07), 0.3); };

}  // namespace

TEST_CASE("methods that agree have one attractor, common to all, and a robust verdict") {
  std::vector<Method> methods;
  for (const double beta : {0.25, 0.5})
    for (const int steps : {2000, 8000}) methods.push_back(method(beta, steps, 20, moving));
  const StudyResults results = with_tables(study(methods, range(0.07, 0.09, 11)));
  const Derived values(results, "values"), attractors(results, "attractors"), verdicts(results, "verdicts"),
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
  const Derived attractors(results, "attractors"), verdicts(results, "verdicts");
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
  const Derived attractors(results, "attractors"), verdicts(results, "verdicts"), distances(results, "distances"),
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
  const Derived distances(results, "distances"), verdicts(results, "verdicts");
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
  const Derived attractors(results, "attractors"), verdicts(results, "verdicts");
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
  derive_tables(results);
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
  derive_tables(results);
  const Derived values(results, "values"), verdicts(results, "verdicts"), attractors(results, "attractors");
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
  derive_tables(bare);
  CHECK(Derived(bare, "attractors").size() == 1);
  const Derived distances(bare, "distances");
  for (std::size_t k = 0; k < distances.size(); ++k) {
    CHECK(distances.at(k, "wasserstein").is_nothing());
    CHECK(distances.at(k, "same_class") == true);
  }
  const StudyResults one = with_tables(study({methods[0]}, range(0.07, 0.09, 5)));
  CHECK(Derived(one, "attractors").text(0, "label") == "not compared");
  CHECK(Derived(one, "verdicts").size() == 0);
  CHECK(Derived(one, "distances").size() == 0);
  StudyResults none;
  none.kind = "bifurcation";
  CHECK_NOTHROW(derive_tables(none));
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
  for (const char* name : {"values", "bifurcations", "attractors", "distances", "verdicts", "agreement", "shifts"})
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
    derive_tables(results);
    if (known == 1) continue;
    const Derived distances(results, "distances");
    REQUIRE(distances.size() > 0);
    const std::size_t expected = known <= 3 ? 1 : known == 4 ? 3 : 4;
    CHECK(distances.text(0, "reference_case") == results.cases[expected].id);
  }
}

namespace {

/// Two attractors: below the line y = slope x + 0.5 an orbit, above it another; beyond the unit circle, a failure.
CaseRecord basin_case(const std::string& mass, double slope, int count, bool interior_unmarched) {
  CaseRecord record;
  record.id = mass;
  record.axes = {{"mass", mass}, {"elements", 10}};
  record.status = "done";
  Table cells{"cells", "", named_columns({"x", "y", "class", "period", "attractor", "status", "reason"}), {}};
  NumberTable points = cell_points_type().head();
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i) {
      const double x = -1 + 2.0 * i / (count - 1), y = -1 + 2.0 * j / (count - 1);
      const bool failed = x * x + y * y > 1.9, above = y > slope * x + 0.1;
      const auto row = static_cast<double>(cells.rows.size());
      cells.rows.push_back(
          {x, y, failed ? "failed" : "periodic", failed ? Cell() : Cell(1), nullptr, failed ? "diverged" : "done", ""});
      if (failed || (interior_unmarched && std::abs(y - slope * x - 0.1) > 0.5)) continue;
      for (int k = 0; k < 20; ++k) {
        const double d = above ? 0.05 : -0.03, v = above ? 0.4 : 0.9;
        points.add({row, static_cast<double>(k), d, v, 0.06 - d, 0.5 - v});
      }
    }
  record.tables.push_back(std::move(cells));
  record.numbers.push_back(std::move(points));
  return record;
}

StudyResults basins(const std::vector<CaseRecord>& cases, const std::string& x, const std::string& y) {
  StudyResults results;
  results.kind = "basins";
  results.study = {{"axes", {{{"pointer", x}}, {{"pointer", y}}}}};
  results.columns = {"mass", "elements"};
  results.cases = cases;
  return results;
}

}  // namespace

TEST_CASE("basins of two attractors: shares, differences and a smooth boundary") {
  const int count = 41;
  for (const bool inside : {false, true})
    for (const std::string pointer : {"/scene/initial/displacement", "/scene/support/amplitude"}) {
      INFO(pointer << (inside ? ", interior by its class" : ""));
      if (inside && pointer != "/scene/initial/displacement") continue;
      const StudyResults results =
          with_tables(basins({basin_case("full", 0, count, inside), basin_case("poor", 0.5, count, inside)}, pointer,
                             "/scene/initial/velocity"));
      const Derived cells(results, "cells"), attractors(results, "attractors"), fractions(results, "basin_fractions"),
          differences(results, "basin_differences"), uncertainty(results, "basin_uncertainty");
      REQUIRE(attractors.size() == 2);
      CHECK(attractors.text(0, "label") == "common to all");
      CHECK(attractors.at(0, "from").is_nothing());
      REQUIRE(fractions.size() == 4);
      // Every decided cell has the attractor of its side, in both cases.
      std::array<int, 2> decided{}, above{};
      const Cell upper = cells.at(40 * 41 + 20, "attractor");
      for (std::size_t k = 0; k < cells.size(); ++k) {
        const bool poor = cells.text(k, "case") == "poor";
        if (cells.text(k, "class") == "failed") {
          CHECK(cells.at(k, "attractor").is_nothing());
          continue;
        }
        ++decided[poor];
        const bool high = cells.number(k, "y") > (poor ? 0.5 : 0) * cells.number(k, "x") + 0.1;
        above[poor] += high;
        REQUIRE((cells.at(k, "attractor") == upper) == high);
      }
      const std::size_t row = fractions.where("attractor", upper)[0];
      CHECK(fractions.number(row, "cells") == above[0]);
      CHECK(fractions.number(row, "fraction") == Approx(double(above[0]) / decided[0]));
      CHECK(fractions.number(row, "low") < fractions.number(row, "fraction"));
      CHECK(fractions.number(row, "high") > fractions.number(row, "fraction"));
      // Between the two lines: two triangles of height ½ and base 1 in a square of 4.
      REQUIRE(differences.size() == 1);
      CHECK(differences.number(0, "share") == Approx(0.125).margin(0.02));  // a cell's width on 41
      // A line: s = 1.
      CHECK(uncertainty.number(0, "low") < 1.05);
      CHECK(uncertainty.number(0, "high") > 0.95);
    }
}

TEST_CASE("every one of many chaotic sections belongs to an attractor") {
  // All chaotic is the dearest: 2400 sections take about 0.3 s of a free core.
  std::vector<Method> methods;
  for (int k = 0; k < 8; ++k)
    methods.push_back(method(k, 2000, 20, [=](double a, const std::string& start) {
      return chaos(k + a * 1300 + static_cast<double>(start.size()));
    }));
  StudyResults results = study(methods, range(0.07, 0.09, 100), {"rest", "up", "state"}, 300);
  derive_tables(results);
  const Derived values(results, "values");
  CHECK(values.size() == 2400);
  for (const Cell& attractor : values.column("attractor")) CHECK(attractor.whole());
}
