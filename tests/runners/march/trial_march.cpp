// What a short march of a case counts, and that it stays short.
#include "runners/march/trial_march.hpp"

#include <catch2/catch.hpp>
#include <ricochet/loader/catalogue.hpp>

#include "runners/study/load_study.hpp"
#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

namespace {

// A beam at stops that are so far away.
Json beam_at(double gap) {
  Json study = Json::parse(R"({
    "name": "trial", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.5, "section": {"type": "given", "EI": 33.8, "rhoS": 0.12},
                            "damping": {"stiffness": 1e-4}},
              "stops": {"at": "nodes"}, "load": "-1e3"},
    "mesh": {"elements": 8},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark-dumont-paoli"},
    "step": 1e-5, "duration": 0.2, "march": "every-step"})");
  study["scene"]["stops"]["lower"] = -gap;
  study["scene"]["stops"]["upper"] = gap;
  return study;
}

std::optional<StepCounts> counted(const Json& json) {
  Catalogue catalogue{tests::places().plugins, {}, {}};
  Registry registry;
  const ScratchFolder folder;
  write_text(folder / "study.json", json.dump());
  const Study study = load_study(folder / "study.json", catalogue, registry);
  REQUIRE(study.cases.size() == 1);
  const Prepared prepared = prepare_case(study.cases.front(), registry);
  REQUIRE(prepared.program);
  return trial_march(study.cases.front(), prepared, registry, 0.1);
}

}  // namespace

TEST_CASE("a trial counts steps in contact, points that push and iterations") {
  const auto pressed = counted(beam_at(1e-6));
  REQUIRE(pressed);
  CHECK(pressed->contact().touched > 0.9);
  CHECK(pressed->contact().points > 4);
  CHECK(pressed->contact().points <= 8);
  CHECK(pressed->contact().iterations >= 1);
  CHECK(pressed->in_contact() == pressed->contact().touched);
  CHECK(pressed->open() < 0.1);
  const auto far = counted(beam_at(1e3));
  REQUIRE(far);
  CHECK(far->in_contact() == 0);
  CHECK(far->open() == 1);
}

TEST_CASE("a trial is short, however many steps a case has, and none is made of few") {
  Json study = beam_at(1e-6);
  study["step"] = 1e-7;
  const auto finer = counted(study);
  REQUIRE(finer);
  CHECK(finer->steps() <= 2000);
  CHECK(!finer->whole());
  study["duration"] = 1e-6;
  CHECK(!counted(study));
}

TEST_CASE("a trial by flights covers the whole duration, and leaves out most of it") {
  Json study = beam_at(0.1);
  study["scene"].erase("load");
  study["scene"]["initial"] = {{"displacement", "0.04*x^2"}, {"velocity", "-2*x"}};
  study["march"] = "flights";
  study["step"] = 1e-7;
  const auto swings = counted(study);
  REQUIRE(swings);
  CHECK(swings->steps() >= 1900);
  CHECK(swings->whole());
  CHECK(swings->open() < 0.5);
}
