// Exponents of tangent columns: real multipliers each by itself, a complex pair together.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <ricochet/measure/orbits/lyapunov.hpp>

using namespace ricochet;

namespace exponent_intervals_tests {

namespace {

using Rates = std::vector<std::vector<double>>;

/// What the columns of the linear map with these multipliers grow by, re-orthonormalised every period: a pair
/// ρe^{±iφ} in an oblique frame swings, a real multiplier does not.
Rates rates_of_pair(double growth, double angle, int periods) {
  Rates rates(2);
  double u[2] = {1, 0}, w[2] = {0, 1};
  const double shear = 1.5, c = std::cos(angle), s = std::sin(angle), rho = std::exp(growth);
  for (int k = 0; k < periods; ++k) {
    const auto map = [&](const double* x, double* y) {
      y[0] = rho * (c * x[0] - shear * s * x[1]);
      y[1] = rho * (s / shear * x[0] + c * x[1]);
    };
    double a[2], b[2];
    map(u, a);
    map(w, b);
    const double length = std::hypot(a[0], a[1]);
    u[0] = a[0] / length, u[1] = a[1] / length;
    const double along = u[0] * b[0] + u[1] * b[1];
    b[0] -= along * u[0], b[1] -= along * u[1];
    const double across = std::hypot(b[0], b[1]);
    w[0] = b[0] / across, w[1] = b[1] / across;
    rates[0].push_back(std::log(length));
    rates[1].push_back(std::log(across));
  }
  return rates;
}

std::vector<double> steady(double rate, int periods) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 1e-3);
  std::vector<double> out;
  for (int k = 0; k < periods; ++k) out.push_back(rate + noise(random));
  return out;
}

}  // namespace

TEST_CASE("exponents: a complex pair is half the growth of its plane, steadier than either column") {
  const Rates rates = rates_of_pair(-0.3, 0.7, 200);
  const auto found = exponent_intervals(rates, 2);
  REQUIRE(found.size() == 2);
  for (const Interval& one : found) {
    CHECK(one.value == Approx(-0.3).epsilon(1e-9));
    CHECK(one.high - one.low < 1e-6);
  }
  CHECK(exponent_interval(rates[0]).high - exponent_interval(rates[0]).low > 1e-3);
  // One wanted: the first of the pair.
  CHECK(exponent_intervals(rates, 1).size() == 1);
  CHECK(exponent_intervals(rates, 1)[0].value == Approx(-0.3).epsilon(1e-9));
}

TEST_CASE("exponents: real multipliers stay apart, a pair may follow one") {
  Rates rates = {steady(0.4, 200)};
  for (auto& column : rates_of_pair(-0.3, 0.7, 200)) rates.push_back(std::move(column));
  const auto found = exponent_intervals(rates, 3);
  REQUIRE(found.size() == 3);
  CHECK(found[0].value == Approx(0.4).margin(1e-3));
  CHECK(found[1].value == Approx(-0.3).epsilon(1e-9));
  CHECK(found[2].value == found[1].value);
  const auto real = exponent_intervals({steady(0.4, 200), steady(-0.2, 200)}, 2);
  REQUIRE(real.size() == 2);
  CHECK(real[0].value == Approx(0.4).margin(1e-3));
  CHECK(real[1].value == Approx(-0.2).margin(1e-3));
}

TEST_CASE("exponents: of too few periods the mean alone") {
  const Interval one = exponent_interval({1.0, 2.0});
  CHECK(one.value == 1.5);
  CHECK(one.low == 1.5);
  CHECK(one.high == 1.5);
}

}  // namespace exponent_intervals_tests
