// studies/gallery.sh: what it runs, what it writes, and what it leaves as it is.
#include "tests/runners/command/spoken_command.hpp"

namespace command_tests {
namespace {

/// The script beside studies of its own; `words` as a person types them.
Outcome gallery(const Folder& here, const std::string& words) {
  const std::string line = "cd '" + here.path().string() + "' && RICOCHET_PLUGIN_PATH= RICOCHET='" +
                           ricochet::tests::places().command + "' sh studies/gallery.sh " + words +
                           " >.out 2>.err </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(here / ".out"), read(here / ".err")};
}

void write_studies(const Folder& here) {
  fs::create_directory(here / "studies");
  for (const char* script : {"gallery.sh", "gallery.py"})
    fs::copy(fs::path(ricochet::tests::places().source) / "studies" / script, here / "studies" / script);
  nlohmann::ordered_json study = tiny();
  study["question"] = "Is 1 < 2 & \"so on\"?";
  here.write("studies/tiny.json", study.dump());
  here.write("studies/ball.json", R"({
    "name": "ball", "question": "How hard does it hit?", "kind": "trajectory", "duration": 1, "step": [0.01, 0.005],
    "ask": [{"value": "energy_end"}],
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1}, "stops": {"upper": 0.1, "at": "tip"},
              "initial": {"velocity": "1"}},
    "methods": {"mass": "consistent", "contact": "signorini", "time": ["newmark", "moreau-jean"]}})");
  here.write("studies/wrong.json", R"({"name": "wrong", "kind": "trajectry"})");
}

}  // namespace

TEST_CASE("gallery: a page of studies, each with its question, its answer, a drawing and its report") {
  const Folder here;
  write_studies(here);
  const Outcome first = gallery(here, "site --only ball");
  INFO(first.out << first.err);
  REQUIRE(first.code == 0);
  CHECK_THAT(first.out, Contains("gallery: ball\n") && Contains("1 study: site/index.html"));
  CHECK_THAT(read(here / "site/index.html"), !Contains("tiny"));
  const std::string report = read(here / "site/ball/report.html");

  // What is there stays as it is; one that is no study has no page, and the others have theirs.
  const Outcome all = gallery(here, "site");
  INFO(all.out << all.err);
  CHECK(all.code == 3);
  CHECK_THAT(all.out, !Contains("gallery: ball\n") && Contains("gallery: tiny\n") && Contains("2 studies"));
  CHECK_THAT(all.err, Contains("wrong ended with 2") && Contains("without a page: wrong"));
  CHECK(read(here / "site/ball/report.html") == report);
  const std::string page = read(here / "site/index.html");
  CHECK_THAT(page, Contains("href=\"ball/report.html\"") && Contains("href=\"tiny/report.html\"") &&
                       Contains("Is 1 &lt; 2 &amp; &quot;so on&quot;?") && Contains("How hard does it hit?") &&
                       Contains("data-kind=\"trajectory\" data-structure=\"oscillator\" data-method=\"consistent "
                                "moreau-jean newmark signorini\"") &&
                       Contains("<option>beam</option><option>oscillator</option>") && Contains("class=\"ask-figure"));
  // The first sentence of the answer is that of the program.
  const auto json = nlohmann::json::parse(here.run("report site/ball --json").out);
  const std::string sentence = json.at("verdicts").at(0).at("sentence");
  CHECK_THAT(page, Contains("<strong>" + sentence + "</strong>"));
  for (const char* outside : {"src=", "url(", "@import"}) CHECK_THAT(page, !Contains(outside));

  // A run that was stopped is not taken for one that ended; an edited study is run again.
  fs::remove(here / "site/tiny/.ended");
  CHECK_THAT(gallery(here, "site --only tiny").out, Contains("gallery: tiny\n") && Contains("2 studies"));
  CHECK_THAT(gallery(here, "site --only tiny").out, !Contains("gallery: tiny\n"));
}

TEST_CASE("gallery: a slip of a word is told before anything runs") {
  const Folder here;
  write_studies(here);
  for (const auto& [words, cause] :
       std::vector<std::pair<std::string, std::string>>{{"site --only bal", "there is no study"},
                                                        {"site --only", "expects names"},
                                                        {"--jobs 2", "no option --jobs"}}) {
    const Outcome outcome = gallery(here, words);
    INFO(words << outcome.out << outcome.err);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.err, StartsWith("gallery: ") && Contains(cause));
    CHECK_FALSE(fs::exists(here / "site"));
  }
}

}  // namespace command_tests
