#include "runners/report/curve_data.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;
using namespace ricochet::report;

TEST_CASE("thinning keeps every extreme, the ends, and the order", "[report]") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const size_t n : {10u, 1000u, 12345u})
    for (const size_t limit : {4u, 100u, 999u}) {
      std::vector<double> values(n);
      for (double& v : values) v = normal(random);
      values[n / 3] = 1e6;
      values[n / 2] = -1e6;
      const std::vector<size_t> kept = keep_extremes(values, limit);
      CHECK(kept.size() <= std::max(limit, std::min(n, limit)));
      CHECK(std::is_sorted(kept.begin(), kept.end()));
      CHECK(std::adjacent_find(kept.begin(), kept.end()) == kept.end());
      CHECK(kept.front() == 0);
      CHECK(kept.back() == n - 1);
      CHECK(std::count(kept.begin(), kept.end(), n / 3) == 1);
      CHECK(std::count(kept.begin(), kept.end(), n / 2) == 1);
    }
}

TEST_CASE("blocks that shrink are packed, the same each time, and others stay", "[report]") {
  std::vector<double> times(500), noise{0.1, 0.7, 0.3};
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = 1e-3 * static_cast<double>(i);
  const Blocks blocks = {{"a/t:f64", base64_doubles(times)}, {"a/u:f64", base64_doubles(noise)}};
  const Blocks small = packed_blocks(blocks);
  CHECK(small == packed_blocks(blocks));
  CHECK(small.at("a/u:f64") == blocks.at("a/u:f64"));
  REQUIRE(small.contains("a/t:f64z"));
  const std::string& text = small.at("a/t:f64z");
  CHECK(text.rfind("H4sIAAAAAAA", 0) == 0);  // gzip without a name and a time
  CHECK(static_cast<double>(text.size()) < 0.8 * static_cast<double>(blocks.at("a/t:f64").size()));
}

TEST_CASE("base64 is that of RFC 4648 over little-endian doubles", "[report]") {
  CHECK(base64_doubles(std::vector<double>{}).empty());
  CHECK(base64_doubles(std::vector<double>{1.0}) == "AAAAAAAA8D8=");
  CHECK(base64_doubles(std::vector<double>{1.0, -2.0}) == "AAAAAAAA8D8AAAAAAAAAwA==");
  CHECK(base64_doubles(std::vector<double>{0, 0, 0}) == std::string(32, 'A'));
}

TEST_CASE("a long series is thinned with its own times, and that is said", "[report]") {
  synthetic::Shape shape;
  shape.samples = 5000;
  const CaseRecord record = synthetic::make_case("lumped", "", "newmark-dumont-paoli", 0.5, 1e-5, 0, shape);
  CurveData whole(6000), thin(1000);
  CHECK(whole.series(record, "t", "energy")->at(0) == record.id + "/t");
  CHECK(whole.thinning().empty());
  const auto names = thin.series(record, "t", "energy");
  REQUIRE(names);
  CHECK(names->at(0) == record.id + "/t@energy");
  CHECK(thin.thinning().find("1 series of up to 5001 samples are thinned to 1000") == 0);
  CHECK_FALSE(thin.series(record, "t", "no such column"));
}
