// A study that comes through a pipe, from the command's own outside.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/places.hpp"
#include "tests/runners/command/said.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/workers/quick_studies.hpp"

using Catch::Matchers::Contains;
using ricochet::tests::places;

namespace {

/// A line of bash, "$R" the command.
CommandOutput in_bash(const ScratchFolder& here, const std::string& line) {
  write_text(here / "line.sh", "R='" + places().command + "'\ncd '" + here.path().string() + "'\n" + line + "\n");
  const std::string out = (here / ".out").string(), err = (here / ".err").string();
  const int status =
      std::system(("bash '" + (here / "line.sh").string() + "' >'" + out + "' 2>'" + err + "' </dev/null").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

}  // namespace

TEST_CASE("piped: standard input and pipes of the shell give the study that the file gives") {
  const std::string words = GENERATE("- < study.json", "- < <(cat study.json)", "<(cat study.json)",
                                     "<(sleep 1; cat study.json)", "/dev/stdin < <(cat study.json)");
  CAPTURE(words);
  const ScratchFolder here;
  quick_studies::Json study = quick_studies::study_of("trajectory");
  study["name"] = "piped";
  write_text(here / "study.json", study.dump(2));
  const CommandOutput of_file = in_bash(here, "\"$R\" run study.json --out file --inline");
  const CommandOutput piped = in_bash(here, "\"$R\" run " + words + "; \"$R\" compare file results/piped");
  INFO(piped.err);
  REQUIRE(of_file.code == 0);
  REQUIRE(piped.code == 0);
  CHECK_THAT(piped.out, Contains("equal to the last bit"));
}

TEST_CASE("piped: what is wrong is told with its line, once the pipe has given its text") {
  const ScratchFolder here;
  quick_studies::Json study = quick_studies::study_of("trajectory");
  study["kind"] = "trajectry";
  write_text(here / "study.json", study.dump(2));
  const CommandOutput of_file = in_bash(here, "\"$R\" plan study.json");
  REQUIRE(of_file.code == 2);
  const std::size_t after = of_file.err.find("study.json:") + std::string("study.json").size();
  const std::string told = of_file.err.substr(after);
  for (const std::string words : {"- < study.json", "<(cat study.json)"}) {
    const CommandOutput piped = in_bash(here, "\"$R\" plan " + words);
    CHECK(piped.code == 2);
    CHECK_THAT(piped.err, Contains(told));
  }
  CHECK_THAT(in_bash(here, "\"$R\" plan - < study.json").err, Contains("standard input:"));
}

TEST_CASE("piped: nothing, a folder, a pipe in a folder and one without an end are refused") {
  const ScratchFolder here;
  in_bash(here, "mkfifo fifo");
  const auto refused = [&](const std::string& words) {
    const CommandOutput ran = in_bash(here, "\"$R\" run " + words);
    INFO(words << ": " << ran.err);
    CHECK(ran.code == 2);
    return ran.err;
  };
  CHECK_THAT(refused("- < /dev/null"), Contains("standard input"));
  CHECK_THAT(refused("- < ."), Contains("standard input: cannot be read: Is a directory"));
  CHECK_THAT(refused("- <&-"), Contains("standard input:1:1: the file is empty"));
  CHECK_THAT(refused("<(true)"), Contains("/dev/fd/"));
  CHECK_THAT(refused("fifo"), Contains("is a pipe, a socket or a device"));
  CHECK_THAT(refused("- < /dev/zero"), Contains("has more than 32 MiB"));
  CHECK_THAT(refused("<(yes)"), Contains("has more than 32 MiB"));
}

TEST_CASE("piped: files that the study names are those of the working folder") {
  const ScratchFolder here;
  const std::string studies = places().source + "/studies", study = studies + "/own-sliding.json";
  const CommandOutput beside = in_bash(here, "cd '" + studies + "'; \"$R\" plan - < '" + study + "'");
  INFO(beside.err);
  CHECK(beside.code == 0);
  const CommandOutput elsewhere = in_bash(here, "\"$R\" plan - < '" + study + "'");
  CHECK(elsewhere.code == 2);
  CHECK_THAT(elsewhere.err, Contains("own-sliding/dofs.csv"));
}
