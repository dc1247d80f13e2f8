// `ricochet case`: a case of a stored study, marched again from a shell.
#include <SQLiteCpp/Database.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "runners/store/checksums.hpp"
#include "tests/runners/command/said.hpp"

using Catch::Matchers::Contains;

namespace {

nlohmann::json study(const std::string& kind) {
  nlohmann::json out = nlohmann::json::parse(R"({
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.1,
                            "force": {"amplitude": 1, "pulsation": 2.6}},
              "stops": {"lower": -2, "upper": [0.05, 0.1], "at": "tip"}},
    "methods": {"mass": "consistent", "contact": "signorini",
                "time": {"name": "newmark-dumont-paoli", "beta": [0.25, 0.5]}}})");
  out["name"] = out["kind"] = kind;
  return out;
}

nlohmann::json trajectory() {
  nlohmann::json out = study("trajectory");
  // A choice that one case alone does not have.
  out["ask"] = nlohmann::json::array({{{"effect", "time"}, {"on", "impulse"}}});
  out.update(nlohmann::json{{"step", {0.01, 0.005}}, {"duration", 10}, {"samples", 50}});
  return out;
}

nlohmann::json convergence() {
  nlohmann::json out = study("convergence");
  out.update(nlohmann::json{{"step", {0.02, 0.01}}, {"duration", 4}, {"samples", 50}, {"reference", "exact"}});
  return out;
}

/// The study is run into the folder `there`; the id of its `row`th case.
std::string run(const ScratchFolder& here, const nlohmann::json& text, std::size_t row = 0) {
  write_text(here / "study.json", text.dump(1));
  const CommandOutput said = say(here, "run study.json --out there --jobs 1");
  INFO(said.err);
  REQUIRE(said.code == 0);
  const std::string cases = read_text(here / "there" / "cases.csv");
  std::size_t at = 0;
  for (std::size_t k = 0; k <= row; ++k) at = cases.find('\n', at) + 1;
  return cases.substr(at, cases.find(',', at) - at);
}

/// The study of the case alone has the case, bit for bit.
void check_alone(const ScratchFolder& here, const std::string& id) {
  REQUIRE(say(here, "case there " + id + " --study > one.json").code == 0);
  const CommandOutput alone = say(here, "run one.json --out alone --jobs 1");
  INFO(alone.err << read_text(here / "one.json"));
  REQUIRE(alone.code == 0);
  const CommandOutput again = say(here, "case alone " + id);
  INFO(again.err);
  CHECK_THAT(again.out, Contains("as stored to the last bit"));
}

}  // namespace

TEST_CASE("A case is marched again to the last bit, and its study alone has the same case") {
  const ScratchFolder here;
  const std::string id = run(here, trajectory(), 5);
  const CommandOutput again = say(here, "case there " + id.substr(0, 5));
  INFO(again.out << again.err);
  CHECK(again.code == 0);
  for (const char* part :
       {"case ", "stops.upper", "dissipated_at_contact", "energy ledger:", "stops:", "as stored to the last bit"})
    CHECK_THAT(again.out, Contains(part));

  const CommandOutput curve = say(here, "case there " + id + " --samples 50");
  CHECK(curve.code == 0);
  const std::string stored = read_text(here / "there" / "curves" / (id + ".csv"));
  REQUIRE_FALSE(stored.empty());
  CHECK(curve.out == stored);
  check_alone(here, id);
  CHECK(read_text(here / "alone" / "curves" / (id + ".csv")) == stored);
}

TEST_CASE("What differs from the stored case is told by its name and both numbers") {
  const ScratchFolder here;
  const std::string id = run(here, trajectory());
  {
    SQLite::Database store(here / "there" / "results.sqlite", SQLite::OPEN_READWRITE);
    store.exec("UPDATE measures SET value = 7 WHERE name = 'impulse' AND case_id = '" + id + "'");
    CHECK(say(here, "case there " + id).code == 5);
    ricochet::seal_cases(store, "");
  }
  const CommandOutput again = say(here, "case there " + id);
  CHECK(again.code == 0);
  CHECK_THAT(again.out, Contains("not as stored") && Contains("impulse is ") && Contains(", stored is 7"));
}

TEST_CASE("A case of a comparison is compared with its reference again") {
  const ScratchFolder here;
  const std::string id = run(here, convergence(), 2);
  const CommandOutput again = say(here, "case there " + id);
  INFO(again.out << again.err);
  CHECK_THAT(again.out, Contains("error.tip-l2") && Contains("as stored to the last bit"));
  CHECK_THAT(say(here, "case there " + id + " --samples 10").out, Contains("t,tip_displacement,tip_velocity"));
  check_alone(here, id);
}

TEST_CASE("A case of stability prints its rows, and orbits are sent to point") {
  const ScratchFolder here;
  nlohmann::json stability = study("stability");
  stability.update(nlohmann::json{{"steps", {{"from", 0.01}, {"to", 1}, {"count", 4}}}});
  const std::string id = run(here, stability);
  const CommandOutput again = say(here, "case there " + id);
  CHECK_THAT(again.out, Contains("stability:") && Contains("as stored to the last bit"));
  const CommandOutput curve = say(here, "case there " + id + " --samples 10");
  CHECK(curve.code == 2);
  CHECK_THAT(curve.err, Contains("more than one integration"));

  const ScratchFolder other;
  nlohmann::json sweep = study("bifurcation");
  sweep["scene"]["stops"]["upper"] = 0.25;
  sweep.update(
      nlohmann::json::parse(R"({"parameter": {"pointer": "/scene/stops/upper", "from": 0.1, "to": 0.3, "count": 2},
                               "steps_per_period": 64, "start": ["rest"],
                               "transient": {"periods": 4, "at_most": 4}, "keep": 16})"));
  const std::string orbits = run(other, sweep);
  const CommandOutput refused = say(other, "case there " + orbits);
  CHECK(refused.code == 2);
  CHECK_THAT(refused.err, Contains("ricochet point there " + orbits));
  CHECK(say(other, "case there " + orbits + " --study > one.json").code == 0);
  CHECK(nlohmann::json::parse(read_text(other / "one.json")).at("kind") == "bifurcation");
}

TEST_CASE("Snapshots of a case are kept beside it, and the next report has its film") {
  const ScratchFolder here;
  const std::string id = run(here, trajectory());
  CHECK_THAT(read_text(here / "there" / "report.html"), Contains("\"snapshots\":null"));
  const CommandOutput kept = say(here, "case there " + id + " --snapshots 40");
  INFO(kept.out << kept.err);
  CHECK(kept.code == 0);
  CHECK_THAT(kept.out, Contains("41 instants at 1 places"));
  REQUIRE(say(here, "report there").code == 0);
  CHECK_THAT(read_text(here / "there" / "report.html"), Contains(id + "/snapshots/u:i16"));
  // They are not the results: these stay as they are, and a run takes them for finished.
  CHECK_THAT(say(here, "case there " + id).out, Contains("as stored to the last bit"));
  const CommandOutput resumed = say(here, "run study.json --out there --jobs 1");
  CHECK_THAT(resumed.err + resumed.out, Contains("0 run now"));
  CHECK_THAT(read_text(here / "there" / "report.html"), Contains(id + "/snapshots/u:i16"));
}

TEST_CASE("A case that is not there is told with the nearest, and what is no case with the kinds") {
  const ScratchFolder here;
  const std::string id = run(here, trajectory());
  const CommandOutput unknown = say(here, "case there " + id + "0");
  CHECK(unknown.code == 2);
  CHECK_THAT(unknown.err, Contains("did you mean \"" + id + "\"?"));
  CHECK(say(here, "case nowhere " + id).code == 5);
  CHECK_THAT(say(here, "case there " + id + " --snapshots 0").err, Contains("outside [1, 2000]"));
  CHECK_THAT(say(here, "case there " + id + " --samples 9 --study").err, Contains("expected one of --samples"));
  CHECK_THAT(say(here, "help case").out, Contains("DIR ID [--samples N | --snapshots N | --study]"));
}
