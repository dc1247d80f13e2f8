// Quantiles and medians of a few numbers.
#include <catch2/catch.hpp>
#include <random>
#include <ricochet/measure/statistics/quantiles.hpp>

using namespace ricochet;

TEST_CASE("quantiles are linear between the numbers, and medians stand in the middle") {
  CHECK(quantile({7}, 0.3) == 7);
  CHECK(quantile({1, 2, 4}, 0) == 1);
  CHECK(quantile({1, 2, 4}, 1) == 4);
  CHECK(quantile({1, 2, 4}, 0.75) == 3);
  CHECK(median({4, 1, 2}) == 2);
  CHECK(median({4, 1, 2, 3}) == 2.5);
  CHECK(lower_median({4, 1, 2}) == 2);
  CHECK(lower_median({4, 1, 2, 3}) == 2);
}

TEST_CASE("half of any numbers lie on either side of their median, whatever their order") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (std::size_t count = 1; count < 30; ++count) {
    std::vector<double> values(count);
    for (double& value : values) value = uniform(random);
    const double middle = median(values), lower = lower_median(values);
    const auto below = [&](double at) {
      return std::count_if(values.begin(), values.end(), [&](double x) { return x < at; });
    };
    const auto above = [&](double at) {
      return std::count_if(values.begin(), values.end(), [&](double x) { return x > at; });
    };
    CHECK(below(middle) == above(middle));
    CHECK(below(lower) == static_cast<long>((count - 1) / 2));
    std::sort(values.begin(), values.end());
    CHECK(quantile(values, 0.5) == Approx(middle).epsilon(1e-14));
  }
}
