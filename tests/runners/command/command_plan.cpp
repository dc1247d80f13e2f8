#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/places.hpp"
#include "tests/runners/command/spoken_command.hpp"

using ricochet::tests::places;

namespace command_tests {

TEST_CASE("A plan shows cases, refusals with reasons and cost, and runs nothing") {
  const Folder here;
  nlohmann::ordered_json study = tiny();
  study["exclude"] = {{{"mass", "consistent"}, {"time.beta", 0.1}, {"why", "known already"}}};
  here.write("tiny.json", study.dump(1));
  const Outcome outcome = here.run("plan tiny.json");
  INFO(outcome.err);
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.out, Contains("4 cases") && Contains("excluded: known already") && Contains("refused: ") &&
                              Contains("predicted: "));
  CHECK_THAT(outcome.out, Contains("2 to run, 1 refused, 1 excluded") && Contains("contact signorini"));
  // Every case with its line only where they are asked for, and last.
  CHECK_THAT(outcome.out, !Contains("operator"));
  const Outcome all = here.run("plan tiny.json --cases");
  CHECK(all.code == 0);
  // What is predicted is measured, and measured anew.
  const auto timeless = [](const std::string& text) {
    const std::size_t from = text.find("predicted: ");
    return text.substr(0, from) + text.substr(text.find('\n', from));
  };
  CHECK_THAT(timeless(all.out), StartsWith(timeless(outcome.out)) && Contains("operator") && Contains("refused: "));
  CHECK_FALSE(fs::exists(here / "results"));
  // A run counts them alike.
  const Outcome run = here.run("run tiny.json");
  CHECK_THAT(run.err, Contains("4 cases, 0 finished before, 3 to plan and run"));
  CHECK_THAT(run.out, Contains("4 cases: 2 done, 2 refused (2 run now"));
}

TEST_CASE("A plan and the doctor say how many processors may be used, and what allows no more") {
  const Folder here;
  here.write("tiny.json", tiny().dump(1));
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0 || CPU_COUNT(&allowed) < 2) return;
  int one = 0;
  while (!CPU_ISSET(one, &allowed)) ++one;
  CHECK_THAT(here.run("plan tiny.json", "SLURM_CPUS_PER_TASK=1").out,
             Contains("\ncores that this process may use: 1 of ") && Contains("(SLURM_CPUS_PER_TASK)"));
  CHECK_THAT(here.run("doctor", "SLURM_CPUS_ON_NODE=1").out, Contains("(SLURM_CPUS_ON_NODE)"));
  CHECK_THAT(here.run("run tiny.json --isolate --out there", "taskset -c " + std::to_string(one)).err,
             Contains("on 1 worker\n"));
  CHECK_THAT(read(here / "there/report.html"), Contains("(the affinity of this process)"));
  for (const char* words : {"plan tiny.json", "run tiny.json --out other", "run tiny.json --out other --jobs 1"}) {
    const Outcome wrong = here.run(words, "SLURM_CPUS_PER_TASK=all");
    CHECK(wrong.code == 2);
    CHECK(wrong.err == "ricochet: SLURM_CPUS_PER_TASK is \"all\"; expected a number of processors\n");
    CHECK_FALSE(fs::exists(here / "other"));
  }
}

TEST_CASE("The doctor tells processors apart by what they compute") {
  const Folder here;
  const auto digest = [&](const std::string& environment) {
    const std::string text = here.run("doctor", environment).out;
    const std::size_t from = text.find("\narithmetic "), to = text.find('\n', from + 1);
    REQUIRE(from != std::string::npos);
    return text.substr(from, to - from);
  };
  const std::string own = digest("");
  CHECK(digest("OPENBLAS_NUM_THREADS=1") == own);
#if defined(__x86_64__)
  // The C library of a processor that has no fused multiply-add.
  if (__builtin_cpu_supports("fma"))
    CHECK(digest("GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA") != own);
#endif
}

TEST_CASE("A plan says the physics: a slip of units is seen") {
  const Folder here;
  here.write("tiny.json", tiny().dump(1));
  const Outcome outcome = here.run("plan tiny.json");
  // EI = 2e11 π(D⁴ − d⁴)/64, ω₁ = 1.8751²√(EI/ρSL⁴), ζ₁ = αω₁/2; 2π/ω₁ in steps of 1e-4 s.
  CHECK_THAT(outcome.out, Contains("EI 33.76 N m²") && Contains("ρS 0.1194 kg/m") && Contains("4.18 Hz") &&
                              Contains("26.2") && Contains("0.13 %") && Contains("239") &&
                              Contains("mass consistent on 4 elements"));
  nlohmann::ordered_json study = tiny();
  study["scene"]["structure"]["young"] = 200;
  here.write("soft.json", study.dump(1));
  CHECK_THAT(here.run("plan soft.json").out, Contains("0.000132 Hz"));
  study = tiny();
  study["scene"]["structure"] = {{"type", "oscillator"}, {"mass", 100}, {"stiffness", 1e4}};
  study["scene"]["stops"]["lower"] = nullptr;
  study.erase("mesh");
  study["methods"]["mass"] = "consistent";
  study["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 1e6}};
  study["scene"]["initial"] = {{"velocity", 1}};
  here.write("spring.json", study.dump(1));
  // π√(m/(k + κ)) = 0.03126 s, in steps of 1e-4 s.
  CHECK_THAT(here.run("plan spring.json").out,
             Contains("k 1e4 N/m") && Contains("half a period lasts 31 ms: 313 steps") && Contains("; a bounce "));
  study["methods"]["contact"] = "none";
  study["methods"]["friction"] = {{"name", "spring"}, {"stiffness", 3e4}};
  study["scene"]["stops"] =
      nlohmann::ordered_json::parse(R"([{"name": "damper", "at": {"x": 0}, "normal_force": 20, "friction": 0.1}])");
  here.write("damper.json", study.dump(1));
  // 2π√(m/(k + κ)) = 0.31416 s.
  CHECK_THAT(here.run("plan damper.json").out,
             Contains("held, it swings in 314 ms, undamped: 3142 steps") && Contains("gives way by 3.33e-05 m per N"));
}

TEST_CASE("Where every case is refused nothing runs, which is no success") {
  const Folder here;
  nlohmann::ordered_json study = tiny();
  study["methods"]["mass"] = "singular";
  study["methods"]["time"] = {{{"name", "newmark-dumont-paoli"}, {"beta", 0.1}}};
  here.write("none.json", study.dump(1));
  const Outcome plan = here.run("plan none.json"), run = here.run("run none.json --out there");
  CHECK(plan.code == 3);
  CHECK_THAT(plan.out, Contains("\nnothing would run: every case is refused"));
  CHECK(run.code == 3);
  CHECK_THAT(run.out, Contains("\nnothing ran: every case is refused"));
}

TEST_CASE("A study runs to results that can be reported and exported again") {
  const Folder here;
  here.write("tiny.json", tiny().dump(1));
  const Outcome run = here.run("run tiny.json --out there --jobs 1");
  INFO(run.out << run.err);
  CHECK(run.code == 0);
  for (const char* file : {"results.sqlite", "report.html", "study.json", "cases.csv"})
    CHECK(fs::exists(here / "there" / file));
  fs::remove(here / "there" / "report.html");
  CHECK(here.run("report there").code == 0);
  CHECK(fs::exists(here / "there" / "report.html"));
  CHECK(here.run("export there --to tables").code == 0);
  CHECK(fs::exists(here / "tables" / "cases.csv"));
  CHECK(here.run("plan there/study.json").code == 0);
}

TEST_CASE("Two results folders are compared, and several are listed on one page") {
  const Folder here;
  nlohmann::ordered_json other = tiny();
  other["name"] = "other";
  other["duration"] = 0.02;
  here.write("tiny.json", tiny().dump(1));
  here.write("other.json", other.dump(1));
  for (const char* folder : {"out/first", "out/again"})
    CHECK(here.run("run tiny.json --jobs 1 --out " + std::string(folder)).code == 0);
  CHECK(here.run("run other.json --jobs 1 --out out/deep/other").code == 0);
  const Outcome same = here.run("compare out/first out/again"), differ = here.run("compare out/first out/deep/other");
  CHECK(same.code == 0);
  CHECK_THAT(same.out, Contains("inputs: the same\n") && Contains("The results are equal to the last bit.\n"));
  CHECK(differ.code == 0);
  CHECK_THAT(differ.out, Contains("/duration: 0.01 → 0.02\n") && Contains("by their parameters") &&
                             Contains("The results differ beyond round-off"));
  const Outcome table = here.run("compare out/first out/deep/other --table");
  CHECK_THAT(table.out, StartsWith("part,case,case_b,name,a,b,relative_change,verdict\n"));
  CHECK_THAT(table.out, Contains("input,,,/duration,0.01,0.02,,changed\n"));
  CHECK(here.run("compare out/first").code == 2);
  CHECK(here.run("compare out/first nowhere").code == 5);
  const Outcome list = here.run("report out/first out/deep/other");
  CHECK(list.code == 0);
  CHECK_THAT(list.out, Contains("index: ") && Contains("/out/index.html\n"));
  const std::string page = read(here / "out/index.html");
  CHECK_THAT(page, Contains("href=\"first/report.html\"") && Contains("href=\"deep/other/report.html\"") &&
                       Contains("Does it run?") && Contains("✓ 3 done") && Contains("1 refused"));
  CHECK(here.run("report out/first out/again --out list.html").code == 0);
  CHECK_THAT(read(here / "list.html"), Contains("href=\"out/again/report.html\""));
  CHECK(here.run("report out/first --out list.html").code == 2);
}

TEST_CASE("Results that are not there, or are something else, end with 5") {
  const Folder here;
  const Outcome outcome = here.run("report nowhere");
  CHECK(outcome.code == 5);
  CHECK_THAT(outcome.err, StartsWith("ricochet: ") && Contains("nowhere"));
}

TEST_CASE("A plugin file that cannot serve ends with 4 and is named") {
  const Folder here;
  here.write("tiny.json", tiny().dump(1));
  here.write("text.so", "not a library");
  for (const std::string command : {"run tiny.json", "plan tiny.json", "list", "describe singular", "schema", "doctor"})
    for (const std::string file : {"text.so", "absent.so"}) {
      INFO(command << " " << file);
      const Outcome outcome = here.run(command + " --plugin " + file);
      CHECK(outcome.code == 4);
      CHECK_THAT(outcome.err, Contains(file));
    }
  SECTION("in a folder it matters only to who asks for what it may hold") {
    const std::string environment = "RICOCHET_PLUGIN_PATH='" + (here / "").string() + "'";
    CHECK(here.run("plan tiny.json", environment).code == 0);
    const Outcome doctor = here.run("doctor", environment);
    CHECK(doctor.code == 4);
    CHECK_THAT(doctor.out, Contains("text.so") && Contains("unusable"));
    nlohmann::ordered_json study = tiny();
    study["methods"]["time"] = {"my-own-scheme"};
    here.write("own.json", study.dump(1));
    const Outcome plan = here.run("plan own.json", environment);
    CHECK(plan.code == 4);
    CHECK_THAT(plan.err, Contains("my-own-scheme") && Contains("text.so") && Contains("/methods/time/0"));
  }
}

TEST_CASE("The doctor says with what the program was built and what it finds") {
  const Folder here;
  const Outcome outcome = here.run("doctor");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.code == 0);
  for (const char* part : {"compiler", "flags", "Eigen", "Boost", "CHOLMOD", "nlohmann", "fmt", "SQLite", "muParser",
                           "processor", "instruction sets", "mass.so", "ok"})
    CHECK_THAT(outcome.out, Contains(part));
}

TEST_CASE("The schema is JSON and knows the parameters of the plugins found") {
  const Folder here;
  const Outcome outcome = here.run("schema");
  CHECK(outcome.code == 0);
  const auto schema = nlohmann::json::parse(outcome.out);
  CHECK(schema["additionalProperties"] == false);
  REQUIRE(schema["allOf"].size() >= 4);  // one condition per kind
  CHECK(outcome.out.size() < 130000);    // editors read it at every key
  CHECK_THAT(outcome.out, Contains("\"augmentation\"") && Contains("\"velocity\"") && Contains("\"beta\""));
}

TEST_CASE("Output that cannot be written is told") {
  if (!fs::exists("/dev/full")) return;
  const Folder here;
  const int status = std::system(("'" + places().command + "' schema >/dev/full 2>/dev/null").c_str());
  CHECK((WIFEXITED(status) && WEXITSTATUS(status) != 0));
}

}  // namespace command_tests
