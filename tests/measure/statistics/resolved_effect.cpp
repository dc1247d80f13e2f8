// A difference is told from what step and mesh leave open, or it is not told.
#include <catch2/catch.hpp>
#include <ricochet/measure/statistics/effects.hpp>

using namespace ricochet;

namespace {

EffectVerdict verdict(double a, double b, std::optional<double> step, std::optional<double> mesh = {}) {
  return resolved_effect({{a, step, mesh}, {b, step, mesh}}, 0.01, 1e-12).verdict;
}

}  // namespace

TEST_CASE("a choice decides where its difference exceeds the threshold and twice what is open") {
  CHECK(verdict(0.4, 0.5, 0.04) == EffectVerdict::decides);
  CHECK(verdict(0.4, 0.5, 0.051) == EffectVerdict::unresolved);
  // Both refinements leave something open.
  CHECK(verdict(0.4, 0.5, 0.03, 0.03) == EffectVerdict::unresolved);
  // Told apart, and too small to matter.
  CHECK(verdict(0.4, 0.405, 0.0001) == EffectVerdict::no_matter);
  // Within the threshold, which a step that moves by more does not show.
  CHECK(verdict(0.4, 0.405, 0.02) == EffectVerdict::unresolved);
  CHECK(verdict(0.4, 0.5, std::nullopt) == EffectVerdict::untold);
  CHECK(verdict(0.4, 0.4, std::nullopt) == EffectVerdict::untold);
  CHECK(verdict(1e-13, -1e-12, 0.0) == EffectVerdict::not_observed);
}

TEST_CASE("the extreme levels are named, and the largest move counts") {
  const ResolvedEffect found = resolved_effect({{0.3, 0.01, {}}, {0.1, 0.02, 0.001}, {0.2, 0.005, {}}}, 0.01, 0);
  CHECK(found.least == 1);
  CHECK(found.most == 0);
  CHECK(found.effect == Approx(0.2));
  CHECK(found.step == 0.02);
  CHECK(found.mesh == 0.001);
}

TEST_CASE("resolved effect: the interval of a mean is open too, and alone it tells nothing of the numerics") {
  const std::vector<LevelValue> exact = {{0.40, 0.001, {}, 0.002}, {0.46, 0.001, {}, 0.001}};
  CHECK(resolved_effect(exact, 0.01, 0).verdict == EffectVerdict::decides);
  const std::vector<LevelValue> short_window = {{0.40, 0.001, {}, 0.002}, {0.46, 0.001, {}, 0.04}};
  const ResolvedEffect open = resolved_effect(short_window, 0.01, 0);
  CHECK(open.verdict == EffectVerdict::unresolved);
  CHECK(open.sampling.value() == 0.04);
  CHECK(open.open() == Approx(0.041));
  CHECK(resolved_effect({{0.40, {}, {}, 0.002}, {0.46, {}, {}, 0.002}}, 0.01, 0).verdict == EffectVerdict::untold);
}
