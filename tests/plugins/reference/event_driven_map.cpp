// The phases of the beam as a map of states: laws of any such map, and what it shares with the motion.
#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/plugins/reference/continuous_beam.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

const double period = 2 * std::numbers::pi / beam_pulsation;

// A state after some periods of impacts.
Eigen::VectorXd settled(ReferenceMap& map, int periods) {
  const ReferenceMap::Image image = map.march(map.start(), periods * period, false);
  REQUIRE(image.stopped.empty());
  REQUIRE(image.impacts > periods);
  return image.state;
}

double size(const ReferenceMap& map, const Eigen::VectorXd& x) {
  return x.cwiseProduct(map.weights()).norm();
}

}  // namespace

TEST_CASE("the derivative of the beam's map is that of central differences, impacts and releases included") {
  const auto map = beam_map(continuous_beam(0.09), 12);
  const Eigen::VectorXd x = settled(*map, 20), weights = map->weights();
  for (const double span : {0.5 * period, period}) {
    const ReferenceMap::Image image = map->march(x, span, true);
    REQUIRE(image.impacts >= 2);
    double worst = 0, largest = 0;
    for (int k = 0; k < map->size(); ++k) {
      // 1e-9 m in the metric: P curves by h², 5e-8 of its derivative, and round-off of P over the step is 1e-7 of it.
      const double step = 1e-9 / weights[k];
      const Eigen::VectorXd by = step * Eigen::VectorXd::Unit(map->size(), k);
      const Eigen::VectorXd difference =
          (map->march(x + by, span, false).state - map->march(x - by, span, false).state) / (2 * step);
      worst = std::max(worst, size(*map, difference - image.derivative.col(k)) / weights[k]);
      largest = std::max(largest, size(*map, difference) / weights[k]);
    }
    CHECK(worst < 1e-6 * largest);
  }
}

TEST_CASE("two half periods of the beam's map with the sign changed are one period of a symmetric scene") {
  const auto map = beam_map(continuous_beam(0.085), 12);
  const Eigen::VectorXd x = settled(*map, 10);
  const Eigen::VectorXd half = -map->march(x, 0.5 * period, false).state;
  const Eigen::VectorXd twice = -map->march(half, 0.5 * period, false).state;
  // Round-off, grown over the impacts of a period.
  CHECK(size(*map, twice - map->march(x, period, false).state) < 1e-10);
}

TEST_CASE("the beam's map leads along the motion that the reference samples") {
  const ReferenceProblem problem = continuous_beam(0.085);
  const auto map = beam_map(problem, 16);
  const SampleGrid grid{{0, period, 2 * period, 3 * period}, {}, {}};
  const auto solved = beam_solver(16)->solve(problem, grid);
  REQUIRE(std::holds_alternative<ReferenceMotion>(solved));
  const SampledMotion& motion = std::get<ReferenceMotion>(solved).motion;
  Eigen::VectorXd x = map->start();
  for (std::size_t k = 1; k < grid.times.size(); ++k) {
    x = map->march(x, period, false).state;
    const auto [place, rate] = map->tip(x);
    // The motion waits after an impact whose first force pulls; a map leaves at once.
    CHECK(place == Approx(motion.tip[k]).margin(1e-6));
    CHECK(rate == Approx(motion.tip_velocity[k]).margin(1e-4));
  }
}

TEST_CASE("the beam's map has no state beyond a stop") {
  const auto map = beam_map(continuous_beam(0.085), 8);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(map->size());
  x[0] = 1;
  CHECK(map->march(x, period, false).stopped.find("shift the phase") != std::string::npos);
  x[0] = NAN;
  CHECK(map->march(x, period, false).stopped == "the state is not finite");
}

TEST_CASE("a reference without a map says so") {
  const ReferenceProblem problem = continuous_beam(0.085);
  auto refused = problem;
  refused.load_zero = refused.load_constant = false;
  const auto answer = beam_solver(8)->map(refused);
  REQUIRE(std::holds_alternative<Refusal>(answer));
  CHECK(std::get<Refusal>(answer).sentence.text.find("load depends on time") != std::string::npos);
}
