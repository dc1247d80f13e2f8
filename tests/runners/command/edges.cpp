// Edges of a machine and of a study: limits of the system, a million cells, numbers at the end of what a double says.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/runners/command/said.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/workers/quick_studies.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using quick_studies::Json;

namespace {

double seconds_of(const std::function<void()>& work) {
  const auto begun = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

Json basins_of_a_million() {
  Json study = quick_studies::study_of("basins");
  study["axes"][0]["count"] = 1000;
  study["axes"][1]["count"] = 1000;
  return study;
}

Json thousands_of_cases() {
  Json study = quick_studies::study_of("trajectory");
  study["methods"]["mass"] = "consistent";
  Json& limits = study["scene"]["stops"]["upper"] = Json::array();
  for (int i = 0; i < 3000; ++i) limits.push_back(0.1 + 1e-6 * i);
  return study;
}

/// An oscillator whose energies are below the least normal number.
Json subnormal(const std::string& kind) {
  Json study = Json::parse(R"({
    "name": "least", "question": "What is left of it?",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 100, "damping": 2},
              "stops": {"lower": -1e-156, "upper": 1}, "initial": {"displacement": 4e-156, "velocity": 0}},
    "methods": {"mass": "consistent", "contact": [{"name": "penalty", "stiffness": 1e4}, "signorini"],
                "time": "newmark-dumont-paoli"},
    "step": [1e-2, 5e-3], "duration": 1, "samples": 50})");
  study["kind"] = kind;
  if (kind == "convergence") study["reference"] = "self";
  return study;
}

}  // namespace

TEST_CASE("edges: a study of many cells is refused as soon as it is planned") {
  // Found wrong with the last cell, the first one, all of them.
  const auto [name, pointer, value, told] = GENERATE(table<std::string, std::string, std::string, std::string>({
      {"basins", "/scene/support/amplitude", "0", "at /section: a strobe reads once per forcing period"},
      {"basins", "/methods/contact", R"({"name": "penalty", "stiffness": -1})", "at /methods/contact/stiffness: "},
      {"trajectory", "/scene/stops/upper/2999", R"("0.1*(")", "at /scene/stops/upper/2999: "},
      {"trajectory", "/step/1", "7", "at /step/1: a step of 7 s is longer than the duration"},
  }));
  CAPTURE(name, pointer);
  const ScratchFolder here;
  Json study = name == "basins" ? basins_of_a_million() : thousands_of_cases();
  write_text(here / "right.json", study.dump());
  study[Json::json_pointer(pointer)] = Json::parse(value);
  write_text(here / "wrong.json", study.dump());
  CommandOutput right, wrong;
  const double planned = seconds_of([&] { right = say(here, "plan right.json"); });
  const double refused = seconds_of([&] { wrong = say(here, "plan wrong.json"); });
  INFO(right.err << wrong.err);
  CHECK(right.code == 0);
  CHECK(wrong.code == 2);
  CHECK_THAT(wrong.err, Contains(told));
  // Twice what the valid study takes, and what a busy machine lets a process wait.
  CHECK(refused < 2 * planned + 10);
}

TEST_CASE("edges: what a list of measures cannot hold is told with its place, whichever command reads it") {
  const std::string entry = GENERATE("null", "7", "{}", "[]", "true", "\"\"", "\"impacts\\u0000\"");
  const std::string key = GENERATE("observe", "compare", "ask");
  const std::string command = GENERATE("plan", "run");
  CAPTURE(entry, key, command);
  const ScratchFolder here;
  Json study = quick_studies::study_of("trajectory");
  study[key] = Json::array({Json::parse(entry)});
  write_text(here / "study.json", study.dump());
  const CommandOutput said = say(here, command + " study.json");
  INFO(said.err);
  CHECK(said.code == 2);
  CHECK_THAT(said.err, Contains("study.json:") && Contains("at /" + key));
  CHECK(said.err.find('\0') == std::string::npos);
}

TEST_CASE("edges: a process that may open few files ends with its results, or names the limit") {
#ifndef RICOCHET_SANITIZED  // a sanitizer opens a pipe itself to look at an object
  const int files = GENERATE(4, 5, 6, 7, 8, 9, 10, 12, 14, 17, 20);
  const std::string how = GENERATE("--inline", "--isolate --jobs 2");
  CAPTURE(files, how);
  const ScratchFolder here;
  write_text(here / "study.json", subnormal("trajectory").dump());
  const CommandOutput ran =
      say(here, "list >/dev/null; prlimit --nofile=" + std::to_string(files) + " '" +
                    ricochet::tests::places().command + "' run study.json --out out " + how + " >/dev/null");
  INFO(ran.err);
  CHECK_THAT(ran.err, !Contains("internal error") && !Contains("terminate called"));
  // 4 where the plugins cannot be read, 127 below what the loader of the system needs.
  CHECK((ran.code == 0 || ran.code == 4 || ran.code == 5 || ran.code == 127));
  if (ran.code == 4 || ran.code == 5) CHECK_THAT(ran.err, Contains("Too many open files") || Contains("cannot open"));
#endif
}

TEST_CASE("edges: energies below the least normal number are computed, stored, drawn again and exported") {
  const std::string kind = GENERATE("trajectory", "convergence");
  CAPTURE(kind);
  const ScratchFolder here;
  write_text(here / "study.json", subnormal(kind).dump());
  for (const std::string words : {"run study.json --out out", "run study.json --out out", "report out",
                                  "export out --to csv", "compare out out", "pack out --out out.zip"}) {
    const CommandOutput said = say(here, words);
    INFO(words << ": " << said.out << said.err);
    CHECK(said.code == 0);
    CHECK_THAT(said.err, !Contains("internal error"));
  }
}

TEST_CASE("edges: control characters of a study are shown as such, on a terminal, in each table and on the page") {
  const ScratchFolder here;
  Json study = subnormal("trajectory");
  study["question"] = "Is \x1b[31mred\x1b[0m \x07 or \xc2\x9b\x32J, \xe2\x80\xaertl?";
  study["//"] = "\x1b]0;title\x07";
  study["methods"]["contact"] = Json::parse(R"([{"name": "penalty", "stiffness": [1e4, 2e4]}])");
  study["exclude"] = Json::array({{{"contact.stiffness", 2e4}, {"why", "as \x1b[1m says"}}});
  write_text(here / "study.json", study.dump());
  const auto raw = [](const std::string& text) {
    const auto control = [](unsigned char c) { return (c < 32 && c != '\n' && c != '\t') || c == 127; };
    return std::any_of(text.begin(), text.end(), control) || text.find("\xc2\x9b") != std::string::npos ||
           text.find("\xe2\x80\xae") != std::string::npos;
  };
  for (const std::string words : {"plan study.json", "run study.json --out out", "run study.json --out out --table",
                                  "report out", "status out"}) {
    const CommandOutput said = say(here, words);
    INFO(words << ": " << said.err);
    CHECK(said.code == 0);
    CHECK_FALSE(raw(said.out));
    CHECK_FALSE(raw(said.err));
    if (words.starts_with("plan"))
      CHECK_THAT(said.out, Contains("<U+001B>[31mred") && Contains("<U+009B>2J, <U+202E>rtl"));
  }
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(here / "out")) {
    if (!entry.is_regular_file() || entry.path().extension() == ".sqlite") continue;
    CAPTURE(entry.path());
    CHECK_FALSE(raw(read_text(entry.path())));
    ++files;
  }
  CHECK(files > 10);
  CHECK_THAT(read_text(here / "out/cases.csv"), Contains("as <U+001B>[1m says"));
  CHECK_THAT(read_text(here / "out/report.html"), Contains("U+001B"));
}
