// Asks that a kind of study cannot answer: refused by pointer, with the nearest name or the remedy.
#include <catch2/catch.hpp>
#include <ricochet/loader/catalogue.hpp>

#include "runners/study/load_study.hpp"
#include "tests/places.hpp"

namespace ricochet::tests_of_refused_asks {

using Catch::Matchers::Contains;

namespace {

Json oscillator(const std::string& kind) {
  Json study = Json::parse(R"({
    "name": "asks",
    "scene": {
      "structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.04,
                    "force": {"amplitude": 0.25, "pulsation": 1.3}},
      "stops": {"upper": 0.5, "at": "tip"}
    },
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 100},
                "time": ["newmark", "bathe"]}
  })");
  study["kind"] = kind;
  if (kind == "convergence" || kind == "work-precision") {
    study["step"] = {0.01, 0.005, 0.0025};
    study["duration"] = 1;
    study["reference"] = "self";
    study["errors"] = {"impulse", "tip-l2"};
  } else if (kind == "bifurcation") {
    study["parameter"] = {{"pointer", "/scene/structure/force/pulsation"}, {"from", 1}, {"to", 2}, {"count", 3}};
    study["steps_per_period"] = 100;
  } else if (kind == "basins") {
    study["scene"]["initial"] = {{"displacement", "0"}, {"velocity", "0"}};
    study["axes"] = {{{"pointer", "/scene/initial/displacement"}, {"from", -1}, {"to", 0}, {"count", 3}},
                     {{"pointer", "/scene/initial/velocity"}, {"from", -1}, {"to", 1}, {"count", 3}}};
    study["steps_per_period"] = 100;
  } else if (kind == "stability") {
    study["steps"] = {{"from", 1e-3}, {"to", 1}};
  } else {
    study["step"] = {0.01, 0.005};
    study["duration"] = 1;
  }
  return study;
}

/// What is refused, "POINTER: message"; "" where nothing is.
std::string refused(Json study, const Json& ask) {
  study["ask"] = Json::array({ask});
  static Catalogue catalogue(tests::places().plugins, {}, {});
  static Registry registry;
  try {
    parse_study(study.dump(), catalogue, registry);
  } catch (const InputError& error) {
    return error.pointer() + ": " + error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("errors that a study does not compute are refused with the nearest name", "[asks]") {
  const Json study = oscillator("convergence");
  for (const char* name : {"impulse", "error.impulse", "tip_l2", "tip-l2"})
    CHECK(refused(study, {{"order", name}}) == "");
  CHECK_THAT(refused(study, {{"order", "impulsee"}}),
             Contains("/ask/0/order: ") && Contains("did you mean \"impulse\"?"));
  CHECK_THAT(refused(study, {{"order", "impact_times"}}), Contains("add it to \"errors\""));
  Json two = study;
  two["step"] = {0.01, 0.005};
  CHECK_THAT(refused(two, {{"order", "impulse"}}), Contains("three steps or three meshes") && Contains("has 2 and 1"));
  const Json cheapest = {{"cheapest", "impulse"}, {"within", "5 %"}};
  CHECK(refused(oscillator("work-precision"), cheapest) == "");
  CHECK_THAT(refused(study, cheapest), Contains("/ask/0/cheapest: ") && Contains("kind work-precision"));
  CHECK_THAT(refused(oscillator("trajectory"), {{"order", "impulse"}}), Contains("kind convergence"));
}

TEST_CASE("a number above 1 is no share, and more than the whole is written in per cent", "[asks]") {
  const Json study = oscillator("trajectory");
  const auto effect = [&](const char* key, const Json& share) {
    return refused(study, {{"effect", "time"}, {"on", "impulse"}, {key, share}});
  };
  for (const char* key : {"from", "within"}) {
    for (const Json& share : {Json(0.05), Json(1), Json("5 %"), Json("500 %")}) CHECK(effect(key, share) == "");
    CHECK_THAT(effect(key, 5),
               Contains(std::string("/ask/0/") + key) &&
                   Contains("5 is above 1, the whole; expected \"5 %\", or \"500 %\" where that is meant"));
    CHECK_THAT(effect(key, "200000 %"), Contains("at most \"100000 %\""));
  }
  CHECK_THAT(refused(study, {{"enough", "impulse"}, {"within", 2}}),
             Contains("/ask/0/within: ") && Contains("\"2 %\""));
}

TEST_CASE("a mean over parts of a window is refused where the window has none, with the key to give", "[asks]") {
  Json study = oscillator("trajectory");
  for (const char* name : {"window_tip_rms", "window_power", "window_force", "window_impact_rate"}) {
    INFO(name);
    study["window"] = {{"from", 0.2}, {"to", 1}};
    CHECK_THAT(refused(study, {{"value", name}}), Contains("/ask/0/value: ") && Contains("\"parts\""));
    study["observe"] = name;
    CHECK_THAT(refused(study, {{"runs", true}}), Contains("/observe") && Contains("\"parts\""));
    study["window"]["parts"] = 16;
    CHECK(refused(study, {{"value", name}}) == "");
    study.erase("observe");
  }
  CHECK(refused(study, {{"value", "contact_force_mean"}}) == "");
  study.erase("window");
  CHECK_THAT(refused(study, {{"value", "contact_force_mean"}}), Contains("give window with \"from\" and \"to\""));
}

TEST_CASE("a measure of stops with names is refused where the stops have none, with the list to write", "[asks]") {
  Json study = oscillator("trajectory");
  CHECK(refused(study, {{"value", "impulse"}}) == "");
  CHECK_THAT(refused(study, {{"value", "peak_force"}}),
             Contains("\"peak_force\" is of stops with names; write the stops of the scene as a list") &&
                 !Contains("did you mean"));
  study["scene"]["stops"] = {{{"name", "gap"}, {"upper", 0.5}, {"at", {{"x", 0}}}}};
  CHECK(refused(study, {{"value", "peak_force"}}) == "");
}

TEST_CASE("a sweep is asked for its own parameter, basins for shares", "[asks]") {
  const Json sweep = oscillator("bifurcation");
  for (const char* name : {"/scene/structure/force/pulsation", "scene.structure.force.pulsation",
                           "structure.force.pulsation", "force.pulsation"})
    CHECK(refused(sweep, {{"motions", name}}) == "");
  CHECK_THAT(refused(sweep, {{"motions", "structure.force.amplitude"}}),
             Contains("/ask/0/motions: ") && Contains("scene.structure.force.pulsation"));
  const Json basins = oscillator("basins");
  CHECK(refused(basins, {{"motions", "share"}}) == "");
  CHECK_THAT(refused(basins, {{"motions", "shares"}}), Contains("expected \"share\""));
  for (const Json& study : {sweep, basins}) {
    CHECK(refused(study, {{"effect", "time"}, {"on", "motions"}}) == "");
    CHECK_THAT(refused(study, {{"effect", "mass"}, {"on", "motions"}}), Contains("has one level"));
    CHECK_THAT(refused(study, {{"effect", "time"}, {"on", "motions"}, {"from", 0.1}, {"within", 0.1}}),
               Contains("/ask/0/within"));
  }
  CHECK_THAT(refused(oscillator("trajectory"), {{"effect", "time"}, {"on", "motions"}}), Contains("finds no motions"));
  CHECK_THAT(refused(oscillator("trajectory"), {{"motions", "share"}}), Contains("kinds bifurcation and basins"));
}

TEST_CASE("starts of a sweep are no choice, and the motions tell what they end in", "[asks]") {
  Json sweep = oscillator("bifurcation");
  sweep["start"] = {"rest", "up", "down"};
  CHECK_THAT(refused(sweep, {{"effect", "start"}, {"on", "motions"}}),
             Contains("/ask/0/effect: ") && Contains("{\"motions\": \"scene.structure.force.pulsation\"}"));
}

TEST_CASE("cases without a motion of their own have no measures of motions", "[asks]") {
  for (const char* kind : {"bifurcation", "basins", "stability"}) {
    INFO(kind);
    const Json study = oscillator(kind);
    for (const Json& ask :
         {Json({{"value", "impulse"}}), Json({{"limit", "impulse"}, {"below", 1}}),
          Json({{"enough", "impulse"}, {"within", 0.1}}), Json({{"effect", "time"}, {"on", "impulse"}})})
      CHECK_THAT(
          refused(study, ask),
          Contains("cases of this kind have no measure \"impulse\", which other kinds have; expected one of \""));
  }
  CHECK(refused(oscillator("bifurcation"), {{"value", "share_periodic"}}) == "");
  CHECK_THAT(refused(oscillator("stability"), {{"value", "limit_observd"}}),
             Contains("did you mean \"limit_observed\"?"));
}

TEST_CASE("a choice that where leaves one level of is refused", "[asks]") {
  const Json study = oscillator("trajectory"), newmark = {{"time", "newmark"}};
  CHECK(refused(study, {{"effect", "time"}, {"on", "impulse"}}) == "");
  CHECK(refused(study, {{"effect", "step"}, {"on", "impulse"}, {"where", newmark}}) == "");
  CHECK_THAT(refused(study, {{"effect", "time"}, {"on", "impulse"}, {"where", newmark}}),
             Contains("/ask/0/effect: \"time\" has one level in the cases of \"where\"; expected one of \"step\""));
  CHECK_THAT(refused(study, {{"rank", "impulse"}, {"over", "time"}, {"where", newmark}}), Contains("/ask/0/over: "));
  CHECK_THAT(refused(study, {{"threshold", "impulse"}, {"is", 0}, {"along", "step"}, {"where", {{"step", 0.01}}}}),
             Contains("/ask/0/along: "));
}

TEST_CASE("points and steps are asked of their kinds alone", "[asks]") {
  CHECK(refused(oscillator("stability"), {{"steps", "limit"}}) == "");
  CHECK(refused(oscillator("bifurcation"), {{"effect", "time"}, {"on", "motions"}, {"from", "10 %"}}) == "");
  CHECK_THAT(refused(oscillator("stability"), {{"points", "all"}}), Contains("kind continuation"));
  CHECK_THAT(refused(oscillator("convergence"), {{"steps", "limit"}}), Contains("kind stability"));
}

TEST_CASE("asks of stops, seeds and nothing are refused with what is meant", "[asks]") {
  Json study = oscillator("trajectory");
  study["scene"]["stops"] = {{{"name", "left"}, {"at", {{"x", 0}}}, {"upper", 0.5}},
                             {{"name", "right"}, {"at", {{"x", 0}}}, {"lower", -0.5}}};
  CHECK(refused(study, {{"value", "peak_force"}, {"stops", {"left"}}}) == "");
  CHECK_THAT(refused(study, {{"value", "energy_left"}, {"stops", {"left"}}}),
             Contains("/ask/0/stops: ") && Contains("no measure of single stops"));
  CHECK_THAT(refused(study, {{"value", "peak_forse"}}), Contains("did you mean \"peak_force\""));
  CHECK_THAT(refused(study, {{"rank", "peak_force"}, {"over", "stop"}}), Contains("did you mean \"stops\""));
  CHECK_THAT(refused(study, {{"runs", false}}), Contains("expected true"));
  CHECK_THAT(refused(study, {{"threshold", "impulse"}, {"along", "step"}, {"is", 1}, {"below", 2}}),
             Contains("not several"));
  CHECK_THAT(refused(oscillator("convergence"), {{"cheapest", "impulse"}, {"within", 0.1}}),
             Contains("times methods against a reference"));
}

}  // namespace ricochet::tests_of_refused_asks
