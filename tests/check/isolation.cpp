// Whatever the code of a plugin does, a check ends with a sentence.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>

#include "runners/check/checks.hpp"

using namespace ricochet;
using namespace ricochet::checking;
using Catch::Matchers::Contains;

namespace {

CheckResult alone(std::function<Verdict()> trial, double seconds = 600, bool* hangs = nullptr) {
  return run_check("a check", {{"beta 0.5", std::move(trial)}}, {.child = true, .seconds = seconds}, hangs);
}

}  // namespace

TEST_CASE("check: a verdict comes back from the child process whole") {
  const CheckResult good = alone([] { return fine("ρ∞ = 1"); });
  CHECK(good.finding == Finding::ok);
  CHECK(good.sentences == std::vector<std::string>{"ρ∞ = 1"});
  const CheckResult bad = alone([] { return fails("two\nlines"); });
  CHECK(bad.finding == Finding::fails);
  CHECK(bad.sentences == std::vector<std::string>{"with beta 0.5: two\nlines"});
}

TEST_CASE("check: a crash, an exit and a loop without end are failures with a cause") {
  const CheckResult crashed = alone([]() -> Verdict {
    std::raise(SIGSEGV);
    return fine();
  });
  CHECK(crashed.finding == Finding::fails);
  CHECK_THAT(crashed.sentences.at(0), Contains("ended by signal 11"));
  const CheckResult left = alone([]() -> Verdict { std::exit(0); });
  CHECK(left.finding == Finding::fails);
  CHECK_THAT(left.sentences.at(0), Contains("exit code 0"));
  bool hangs = false;
  volatile bool forever = true;
  const CheckResult endless = alone(
      [&]() -> Verdict {
        while (forever) {
        }
        return fine();
      },
      1, &hangs);
  CHECK(endless.finding == Finding::fails);
  CHECK_THAT(endless.sentences.at(0), Contains("did not end within 1 s"));
  CHECK(hangs);
}

TEST_CASE("check: a check that lasts is told of while it runs, one that does not is not") {
  std::vector<std::string> told;
  const auto of = [&](unsigned tenths) {
    const Isolation isolation{.seconds = 600, .lasts = [&](const std::string& check) { told.push_back(check); }};
    return run_check("slow",
                     {{"",
                       [=] {
                         ::usleep(100000 * tenths);
                         return fine();
                       }}},
                     isolation);
  };
  CHECK(of(0).finding == Finding::ok);
  CHECK(told.empty());
  CHECK(of(35).finding == Finding::ok);
  CHECK(told == std::vector<std::string>{"slow"});
}

TEST_CASE("check: one failing value makes a check fail, refused values count only when nothing else was measured") {
  const auto trial = [](std::function<Verdict()> take) { return Trial{"", std::move(take)}; };
  const auto refused = []() -> Verdict { throw Refused{"beta is too small"}; };
  const Isolation here{.child = false};
  CHECK(run_check("", {trial([] { return fine("good"); }), trial(refused)}, here).finding == Finding::ok);
  CHECK(run_check("", {trial(refused), trial([] { return fails("bad"); })}, here).finding == Finding::fails);
  CHECK(run_check("", {trial(refused)}, here).finding == Finding::not_applicable);
  CHECK(run_check("", {trial([] { return not_declared("none"); }), trial(refused)}, here).finding ==
        Finding::not_declared);
}

TEST_CASE("check: defaults, ends and middles of ranges, words and truths are tried, each inside its declaration") {
  ParameterSpec open = real_parameter("kappa", "N/m", std::nullopt, {.low = 0, .low_open = true}, "κ");
  ParameterSpec flag;
  flag.key = "flag";
  flag.type = ParameterSpec::Type::boolean;
  flag.fallback = false;
  const std::vector<ParameterSpec> specs = {real_parameter("beta", "1", 0.25, {.low = 0, .high = 0.5}, "β"), open,
                                            word_parameter("start", {"one", "two"}, "two", "start"), flag};
  const std::vector<ParameterSet> sets = parameter_sets(specs);
  CHECK(sets.front().text == "beta 0.25, kappa 100000, start two, flag false");
  std::vector<double> betas;
  for (const ParameterSet& set : sets) {
    betas.push_back(set.values.real("beta"));
    for (const ParameterSpec& spec : specs) CHECK_FALSE(check_parameter(spec, set.values.values().at(spec.key)));
  }
  CHECK(std::count(betas.begin(), betas.end(), 0.0) == 1);
  CHECK(std::count(betas.begin(), betas.end(), 0.5) == 1);
  CHECK(sets.size() == 7);
}
