// Levels of thirds of octaves: what bands are, and that no power is lost or told twice.
#include <catch2/catch.hpp>
#include <ricochet/measure/statistics/third_octaves.hpp>

using namespace ricochet;

TEST_CASE("thirds of octaves have the names of the standard, and ten of them are a decade") {
  const std::vector<ThirdOctave> bands = third_octaves(std::vector<double>(20001, 1.0), 0.1);
  REQUIRE(bands.size() > 20);
  for (std::size_t i = 1; i < bands.size(); ++i) CHECK(bands[i].from == Approx(bands[i - 1].to).epsilon(1e-14));
  const auto named = [&](const std::string& name) {
    const auto found =
        std::find_if(bands.begin(), bands.end(), [&](const ThirdOctave& one) { return one.nominal() == name; });
    REQUIRE(found != bands.end());
    return *found;
  };
  for (const char* name : {"1", "1.25", "31.5", "63", "100", "125", "1000", "1600"}) named(name);
  CHECK(named("63").centre() == Approx(63.0957344480193).epsilon(1e-14));
  CHECK(named("100").from == Approx(89.1250938133746).epsilon(1e-14));
  // The widths of bands below 0.4 Hz are less than a line's 0.1 Hz, and 2000 Hz ends above the last line.
  CHECK(bands.front().to - bands.front().from >= 0.1);
  CHECK(bands.back().to <= 2000);
}

TEST_CASE("a band of white noise has its width, and bands beside each other lose nothing") {
  // Lines of 1.7 Hz end nowhere near the ends of bands.
  const std::vector<ThirdOctave> bands = third_octaves(std::vector<double>(2000, 4.0), 1.7);
  double sum = 0;
  for (const ThirdOctave& band : bands) {
    CHECK(band.rms * band.rms == Approx(4 * (band.to - band.from)).epsilon(1e-12));
    sum += band.rms * band.rms;
  }
  CHECK(sum == Approx(4 * (bands.back().to - bands.front().from)).epsilon(1e-12));
}

TEST_CASE("a line has its power in the band that it lies in, and in no other") {
  std::vector<double> density(1001, 0.0);
  density[200] = 9.0 / 0.5;  // 100 Hz, rms 3
  for (const ThirdOctave& band : third_octaves(density, 0.5))
    CHECK(band.rms == Approx(band.nominal() == "100" ? 3.0 : 0.0).margin(1e-12));
}

TEST_CASE("a density without lines has no bands") {
  CHECK(third_octaves({}, 1).empty());
  CHECK(third_octaves({1.0}, 1).empty());
}
