// Shares of variance of measures whose decomposition is known.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <ricochet/measure/statistics/effects.hpp>

using namespace ricochet;

namespace {

/// A full factorial with levels 0 … n−1 of each factor, and a value per cell.
struct Study {
  std::vector<Factor> factors;
  std::vector<std::optional<double>> values;
};

using Levels = std::vector<std::size_t>;

Study study(const std::vector<std::string>& names, const Levels& sizes,
            const std::function<double(const Levels&)>& value) {
  Study out;
  for (std::size_t k = 0; k < names.size(); ++k) {
    out.factors.push_back({names[k], {}, {}});
    for (std::size_t l = 0; l < sizes[k]; ++l) out.factors[k].levels.push_back(std::to_string(l));
  }
  Levels at(sizes.size(), 0);
  while (true) {
    for (std::size_t k = 0; k < sizes.size(); ++k) out.factors[k].level.push_back(at[k]);
    out.values.emplace_back(value(at));
    std::size_t k = sizes.size();
    while (k > 0 && ++at[k - 1] == sizes[k - 1]) at[--k] = 0;
    if (k == 0) return out;
  }
}

Effects effects(const Study& s) {
  return effects_of(s.factors, s.values);
}

const EffectShare& share(const Effects& e, const std::string& factor) {
  const auto found = std::find_if(e.shares.begin(), e.shares.end(), [&](const auto& s) { return s.factor == factor; });
  REQUIRE(found != e.shares.end());
  return *found;
}

double total(const Effects& e) {
  return std::accumulate(e.shares.begin(), e.shares.end(), 0.0,
                         [](double sum, const auto& s) { return sum + s.share; });
}

double number(std::size_t level) {
  return static_cast<double>(level);
}

bool notes_say(const Effects& e, const std::string& words) {
  return std::any_of(e.notes.begin(), e.notes.end(),
                     [&](const std::string& n) { return n.find(words) != std::string::npos; });
}

// Sums of some hundred products of numbers of order one.
constexpr double round_off = 1e-12;

}  // namespace

TEST_CASE("an additive measure has no interactions, and the shares of its terms' variances") {
  // Levels 0 … n−1 have variance (n² − 1)/12.
  const Study s = study({"mass", "time", "step"}, {3, 4, 5},
                        [](const Levels& l) { return 7 + 4 * number(l[0]) - 2 * number(l[1]) + number(l[2]); });
  const Effects e = effects(s);
  const double a = 16 * 8 / 12.0, b = 4 * 15 / 12.0, c = 24 / 12.0, sum = a + b + c;
  CHECK(share(e, "mass").share == Approx(a / sum).margin(round_off));
  CHECK(share(e, "time").share == Approx(b / sum).margin(round_off));
  CHECK(share(e, "step").share == Approx(c / sum).margin(round_off));
  for (const char* pair : {"mass × time", "mass × step", "time × step", "mass × time × step"})
    CHECK(share(e, pair).share == 0);  // not a trace of round-off reaches a table
  CHECK(total(e) == Approx(1).margin(round_off));
  CHECK_FALSE(e.log);
  CHECK(e.combinations == 60);
  CHECK(e.missing == 0);
}

TEST_CASE("two by two by hand") {
  // 1 2 / 3 8: mean 3.5; rows ∓2, columns ∓1.5, rest ±1. V = 4 + 2.25 + 1 = 7.25.
  const double values[2][2] = {{1, 2}, {3, 8}};
  const Effects e = effects(study({"a", "b"}, {2, 2}, [&](const Levels& l) { return values[l[0]][l[1]]; }));
  CHECK(share(e, "a").share == Approx(4 / 7.25).margin(round_off));
  CHECK(share(e, "b").share == Approx(2.25 / 7.25).margin(round_off));
  CHECK(share(e, "a × b").share == Approx(1 / 7.25).margin(round_off));
}

TEST_CASE("a product over decades is additive on the logarithmic scale that it is given") {
  const Effects e = effects(study({"mass", "step"}, {3, 4}, [](const Levels& l) {
    return std::pow(10, number(l[0])) * std::pow(2, number(l[1]));
  }));
  CHECK(e.log);
  CHECK(notes_say(e, "logarithm"));
  CHECK(share(e, "mass × step").share == Approx(0).margin(round_off));
  const double a = 8 / 12.0, b = std::pow(std::log10(2), 2) * 15 / 12.0;
  CHECK(share(e, "mass").share == Approx(a / (a + b)).margin(round_off));
  // The same with a sign cannot be.
  const Effects signs = effects(study(
      {"mass", "step"}, {3, 4}, [](const Levels& l) { return std::pow(10, number(l[0])) * (l[1] % 2 ? -1 : 1); }));
  CHECK_FALSE(signs.log);
}

TEST_CASE("shares of anything add up to one, and each is that of the definition") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const Levels sizes = {2, 3, 4, 2, 3};
  const Study s = study({"a", "b", "c", "d", "e"}, sizes, [&](const Levels&) { return normal(random); });
  const Effects e = effects(s);
  CHECK(e.shares.size() == 5 + 10 + 10 + 1);
  CHECK(total(e) == Approx(1).margin(round_off));
  for (const EffectShare& one : e.shares) {
    CHECK(one.low <= one.share);
    CHECK(one.share <= one.high);
    CHECK(one.low >= 0);
    CHECK(one.high <= 1);
  }
  // V_{b,d} straight from means of means.
  const auto mean = [&](int b, int d) {
    double sum = 0, count = 0;
    for (std::size_t c = 0; c < s.values.size(); ++c) {
      if ((b >= 0 && s.factors[1].level[c] != std::size_t(b)) || (d >= 0 && s.factors[3].level[c] != std::size_t(d)))
        continue;
      sum += *s.values[c];
      ++count;
    }
    return sum / count;
  };
  double pair = 0, variance = 0;
  for (int b = 0; b < 3; ++b)
    for (int d = 0; d < 2; ++d) pair += std::pow(mean(b, d) - mean(b, -1) - mean(-1, d) + mean(-1, -1), 2) / 6;
  for (const auto& v : s.values) variance += std::pow(*v - mean(-1, -1), 2) / double(s.values.size());
  CHECK(share(e, "b × d").share == Approx(pair / variance).margin(round_off));
}

TEST_CASE("a product of signs is interaction alone: of all three choices, or beyond triples") {
  const auto three = [](double sign) {
    return effects(study({"mass", "time", "step"}, {2, 2, 2}, [&](const Levels& l) {
      return (l[0] ? 1.0 : sign) * (l[1] ? 1.0 : -1.0) * (l[2] ? 1.0 : -1.0);
    }));
  };
  CHECK(share(three(-1), "mass × time × step").share == Approx(1));
  const Effects four = effects(study({"a", "b", "c", "d"}, {2, 2, 2, 2},
                                     [](const Levels& l) { return (l[0] + l[1] + l[2] + l[3]) % 2 ? 1.0 : -1.0; }));
  CHECK(share(four, "higher").share == Approx(1));
}

TEST_CASE("the order of cells, levels and factors, shifts and scales do not matter") {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  Study s = study({"a", "b", "c"}, {3, 3, 2}, [&](const Levels&) { return normal(random); });
  const Effects e = effects(s);
  Study shuffled = s;
  std::vector<std::size_t> order(s.values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::shuffle(order.begin(), order.end(), random);
  for (std::size_t c = 0; c < order.size(); ++c) {
    shuffled.values[c] = 3 - 5 * *s.values[order[c]];
    for (std::size_t k = 0; k < 3; ++k)
      shuffled.factors[k].level[c] = (s.factors[k].level[order[c]] + 1) % s.factors[k].levels.size();
  }
  std::swap(shuffled.factors[0], shuffled.factors[2]);
  const Effects same = effects(shuffled);
  for (const char* name : {"a", "b", "c"})
    CHECK(share(same, name).share == Approx(share(e, name).share).margin(round_off));
  CHECK(share(same, "b × a").share == Approx(share(e, "a × b").share).margin(round_off));
  // The same numbers again, to the last digit: nothing is drawn from a clock.
  const Effects again = effects(s);
  for (std::size_t k = 0; k < e.shares.size(); ++k) {
    CHECK(again.shares[k].low == e.shares[k].low);
    CHECK(again.shares[k].high == e.shares[k].high);
  }
}

TEST_CASE("missing cells do not bias an additive measure") {
  Study s = study({"mass", "time", "step"}, {3, 4, 5},
                  [](const Levels& l) { return 4 * number(l[0]) - 2 * number(l[1]) + std::sqrt(number(l[2])); });
  const Effects full = effects(s);
  // A method refused with one mass, as refusals are, and some cells here and there.
  std::size_t missing = 0;
  for (std::size_t c = 0; c < s.values.size(); ++c)
    if ((s.factors[0].level[c] == 1 && s.factors[1].level[c] == 2) || c % 11 == 3) {
      s.values[c] = c % 2 ? std::nullopt : std::optional(std::numeric_limits<double>::quiet_NaN());
      ++missing;
    }
  const Effects holed = effects(s);
  CHECK(holed.missing == missing);
  CHECK(notes_say(holed, std::to_string(missing) + " of 60 combinations have no value"));
  for (std::size_t k = 0; k < full.shares.size(); ++k)
    CHECK(holed.shares[k].share == Approx(full.shares[k].share).margin(1e-10));
}

TEST_CASE("missing cells hardly move interactions of two") {
  const auto value = [](const Levels& l) {
    return 3 * number(l[0]) + number(l[1]) * number(l[2]) + 0.3 * std::sin(7.0 * number(l[0] + 3 * l[1] + 5 * l[2]));
  };
  Study s = study({"a", "b", "c"}, {4, 5, 6}, value);
  const Effects full = effects(s);
  for (std::size_t c = 0; c < s.values.size(); c += 9) s.values[c].reset();
  const Effects holed = effects(s);
  for (std::size_t k = 0; k < full.shares.size(); ++k) {
    INFO(full.shares[k].factor);
    // 12 % of the cells carry less than 12 % of any term.
    CHECK(holed.shares[k].share == Approx(full.shares[k].share).margin(0.01));
  }
}

TEST_CASE("one level, no spread, no value: said") {
  const Effects one = effects(study({"mass", "contact"}, {3, 1}, [](const Levels& l) { return number(l[0]); }));
  CHECK(share(one, "contact").share == 0);
  CHECK(share(one, "contact").reason == "one level");
  CHECK(share(one, "mass").share == Approx(1));
  CHECK(share(one, "mass").reason.empty());

  const Effects equal = effects(study({"mass", "step"}, {3, 2}, [](const Levels&) { return 1e6; }));
  CHECK(share(equal, "mass").share == 0);
  CHECK(share(equal, "mass").reason == "all values are the same to twelve digits");
  CHECK(notes_say(equal, "all values are the same to twelve digits"));

  Study none = study({"mass", "step"}, {3, 2}, [](const Levels&) { return 1.0; });
  for (auto& v : none.values) v.reset();
  CHECK(notes_say(effects(none), "no cell has a value"));

  // A level that never finished is left out, and named.
  Study level = study({"mass", "step"}, {3, 4}, [](const Levels& l) { return number(l[0]) + number(l[1]); });
  for (std::size_t c = 0; c < level.values.size(); ++c)
    if (level.factors[0].level[c] == 2) level.values[c].reset();
  const Effects two = effects(level);
  CHECK(notes_say(two, "no value with mass 2"));
  CHECK(two.combinations == 8);
  CHECK(two.missing == 0);
  CHECK(share(two, "mass").share == Approx(0.25 / (0.25 + 15 / 12.0)));
}

TEST_CASE("factors that do not vary apart have no shares") {
  Study s = study({"mass", "time"}, {4, 4}, [](const Levels& l) { return number(l[0] + l[1]); });
  for (std::size_t c = 0; c < s.values.size(); ++c)  // two blocks that share no level
    if ((s.factors[0].level[c] < 2) != (s.factors[1].level[c] < 2)) s.values[c].reset();
  const Effects e = effects(s);
  CHECK(total(e) == 0);
  CHECK(notes_say(e, "do not tell the factors apart"));
  Study sparse = study({"mass", "time"}, {4, 4}, [](const Levels& l) { return number(l[0] + l[1]); });
  for (std::size_t c = 0; c < sparse.values.size(); ++c)
    if (c % 3) sparse.values[c].reset();
  CHECK(notes_say(effects(sparse), "only 6 of 16 combinations have a value"));
}

TEST_CASE("intervals: of no width where levels cannot matter, wide where one level carries the effect") {
  // Two additive factors of two levels: any weighting of levels gives the same corrected variances.
  const Effects two =
      effects(study({"a", "b"}, {2, 2}, [](const Levels& l) { return 2 * number(l[0]) + number(l[1]); }));
  CHECK(share(two, "a").share == Approx(0.8));
  CHECK(share(two, "a").low == Approx(0.8).margin(1e-9));
  CHECK(share(two, "a").high == Approx(0.8).margin(1e-9));
  // One of six levels differs: whether it counts decides.
  const Effects six =
      effects(study({"a", "b"}, {6, 4}, [](const Levels& l) { return (l[0] == 5 ? 3.0 : 0.0) + number(l[1]); }));
  const EffectShare& a = share(six, "a");
  CHECK(a.low < a.share - 0.15);
  CHECK(a.high > a.share + 0.1);
}

TEST_CASE("cells that no factor tells apart are repeats") {
  Study s = study({"mass", "hidden"}, {3, 2}, [](const Levels& l) { return number(l[0]) + 2 * number(l[1]); });
  s.factors.pop_back();
  const Effects e = effects(s);
  // mass: 8/12; hidden: 1.
  CHECK(share(e, "mass").share == Approx(8 / 12.0 / (8 / 12.0 + 1)));
  CHECK(share(e, "repeats").share == Approx(1 / (8 / 12.0 + 1)));
  CHECK(notes_say(e, "repeats"));
}

TEST_CASE("a parameter of some methods joins its method, one of all stays apart") {
  const std::vector<std::string> columns = {"mass", "mass.velocity", "time", "time.beta", "time.start", "step"};
  std::vector<std::vector<std::string>> cells;
  for (const auto& [mass, velocity] :
       std::vector<std::pair<std::string, std::string>>{{"consistent", ""}, {"singular", "P1"}, {"singular", "P0"}})
    for (const auto& [time, beta] : std::vector<std::pair<std::string, std::string>>{
             {"one", "0.25"}, {"one", "0.5"}, {"two", "0.25"}, {"two", "0.3"}})
      for (const char* start : {"a", "b"})
        for (const char* step : {"1e-4", "1e-5"}) cells.push_back({mass, velocity, time, beta, start, step});
  const FactorSet set = factors_of(columns, cells);
  std::vector<std::string> names;
  for (const Factor& f : set.factors) names.push_back(f.name);
  CHECK(names == std::vector<std::string>{"mass", "time", "time.start", "step"});
  CHECK(set.factors[0].levels ==
        std::vector<std::string>{"consistent", "singular, velocity P1", "singular, velocity P0"});
  CHECK(set.factors[1].levels.size() == 4);
  CHECK(set.factors[2].levels.size() == 2);
  REQUIRE(set.notes.size() == 2);
  CHECK(set.notes[0].find("mass stands for mass with mass.velocity") == 0);
  // So the table is full.
  std::vector<std::optional<double>> values(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) values[c] = number(c % 7);
  const Effects e = effects_of(set.factors, values);
  CHECK(e.combinations == cells.size());
  CHECK(e.missing == 0);
}

TEST_CASE("structure.length is a factor of its own where there is no column structure") {
  const FactorSet set = factors_of({"structure.length", "structure.young"}, {{"1", "2"}, {"2", "2"}, {"1", "3"}});
  CHECK(set.factors.size() == 2);
  CHECK(set.notes.empty());
}

TEST_CASE("sizes that do not agree are refused") {
  Factor short_one{"a", {"0"}, {0}}, wrong{"a", {"0"}, {0, 1}};
  CHECK_THROWS_AS(effects_of({short_one}, {1.0, 2.0}), std::invalid_argument);
  CHECK_THROWS_AS(effects_of({wrong}, {1.0, 2.0}), std::invalid_argument);
}

TEST_CASE("a model of two-factor interactions is found again in a table with holes") {
  const FactorialTable table({4, 3, 5});
  CHECK(table.freedom(1) == 1 + 3 + 2 + 4);
  CHECK(table.freedom(2) == 10 + 6 + 12 + 8);
  CHECK(table.freedom(3) == 60);
  std::vector<double> values, truth, fitted;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      for (std::size_t c = 0; c < 5; ++c) truth.push_back(number(a * b) - number(b * c * c) + 0.5 * number(a * c));
  values = truth;
  std::vector<char> known(60, 1);
  for (const std::size_t cell : {0u, 7u, 13u, 29u, 44u, 58u}) known[cell] = 0, values[cell] = 1e3;
  REQUIRE(table.fit_additive(values, known, fitted));
  for (std::size_t cell = 0; cell < 60; ++cell)
    if (!known[cell]) values[cell] = fitted[cell];
  table.fill_pairs(values, known, fitted);
  for (std::size_t cell = 0; cell < 60; ++cell) CHECK(values[cell] == Approx(truth[cell]).margin(1e-8));
}
