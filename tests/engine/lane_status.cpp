// Why an integration ended: a cause with its numbers; status and sentence follow from it, never the other way round.
#include <catch2/catch.hpp>
#include <limits>
#include <ricochet/engine/marcher.hpp>
#include <set>

using namespace ricochet;

TEST_CASE("each cause of an end has a sentence of its own, only a step that cannot be made is a failure") {
  std::set<std::string> sentences;
  for (int k = 0; k <= static_cast<int>(EndCause::process_ended); ++k) {
    const LaneEnd end{static_cast<EndCause>(k), 1, 2, 3, 4};
    INFO(k);
    CHECK(static_cast<bool>(end) == (k != 0));
    CHECK(text(end).empty() == (k == 0));
    CHECK(sentences.insert(text(end)).second);
    CHECK(end.failed() == (end.cause == EndCause::law_not_converged || end.cause == EndCause::friction_not_found ||
                           end.cause == EndCause::process_ended));
  }
  CHECK_FALSE(LaneEnd{});
}

TEST_CASE("the numbers of a cause stand in its sentence") {
  CHECK(text(LaneEnd{.cause = EndCause::law_not_converged, .value = 0.25, .count = 50}) ==
        "the contact law did not converge (residual 0.25 after 50 iterations)");
  CHECK(text(LaneEnd{.cause = EndCause::law_not_converged, .value = 0.25}) ==
        "the contact law found no solution (residual 0.25)");
  CHECK_THAT(text(LaneEnd{.cause = EndCause::law_not_converged, .value = std::numeric_limits<double>::infinity()}),
             Catch::Contains("no finite force"));
  CHECK(text(LaneEnd{.cause = EndCause::elastic_energy_beyond, .value = 3e9, .bound = 2e9, .factor = 1e9}) ==
        "the elastic energy 3e+09 J passed 2e+09 J, 1e+09 times the scene's own scale");
  CHECK(text(LaneEnd{.cause = EndCause::state_not_finite, .count = 16}) ==
        "the state is not finite (lanes are checked every 16 steps)");
  CHECK(text(LaneEnd{.cause = EndCause::energy_beyond, .value = 7, .bound = 5}) ==
        "the energy 7 J passed the bound 5 J");
}
