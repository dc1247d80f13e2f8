// Manual pages and completions say what the program takes, all of it and nothing else.
#include "runners/command/manual.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "runners/command/subcommand.hpp"
#include "tests/runners/command/spoken_command.hpp"

using namespace ricochet;

namespace {

using Words = std::set<std::string>;

Words words_of(const std::string& text) {
  std::istringstream stream(text);
  Words words;
  for (std::string word; stream >> word;) words.insert(word);
  return words;
}

Words options_of(const Subcommand& command) {
  Words names = {"--help"};
  for (const Option& option : command.options) names.insert("--" + option.name);
  return names;
}

Words names_of_commands() {
  Words names = {"help", "--help", "--version"};
  for (const Subcommand& command : subcommands()) names.insert(command.name);
  return names;
}

/// A text as roff writes it.
std::string in_roff(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '-' ? std::string("\\-") : std::string(1, c);
  return out;
}

bool is_there(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace

namespace command_tests {

TEST_CASE("manual: the page of the program has every command, option and exit code") {
  const Folder here;
  const std::string page = manual_page("ricochet.1");
  CHECK(here.run("manual ricochet.1").out == page);
  for (const Subcommand& command : subcommands()) {
    INFO(command.name);
    const std::size_t at = page.find(".SS " + in_roff(command.name) + "\n");
    REQUIRE(at != std::string::npos);
    const std::string section = page.substr(at, page.find("\n.S", at + 1) - at);
    CHECK_THAT(section, Contains(in_roff(command.usage)) && Contains(in_roff(command.summary)));
    for (const Option& option : command.options)
      CHECK_THAT(section,
                 Contains("\n.B " + in_roff("--" + option.name + (option.value.empty() ? "" : " ") + option.value) +
                          "\n" + in_roff(option.text)));
  }
  const std::string readme = read(fs::path(ricochet::tests::places().source) / "runners/README.md");
  for (const ExitMeaning& meaning : exit_meanings()) {
    INFO(meaning.code);
    CHECK_THAT(page, Contains("\n.B " + std::to_string(meaning.code) + "\n"));
    CHECK_THAT(readme, Contains("\n| " + std::to_string(meaning.code) + " | "));
  }
}

TEST_CASE("manual: the page of studies has every key that the schema of the program has") {
  const std::string page = manual_page("ricochet-study.5");
  int keys = 0;
  for (const KeySection& section : study_sections()) {
    CHECK_THAT(page, Contains(".SH " + in_roff(section.title) + "\n"));
    for (const KeyRow& row : section.rows) {
      INFO(row.key);
      CHECK_THAT(page, Contains("\n.B " + in_roff(row.key) + "\n") && Contains(in_roff(row.meaning)));
      ++keys;
    }
  }
  const Folder here;
  const auto schema = nlohmann::json::parse(here.run("schema").out);
  for (const auto& item : schema["properties"].items())
    if (item.key() != "$schema" && !item.key().starts_with("//")) {
      INFO(item.key());
      CHECK_THAT(page, Contains("\n.B " + in_roff(item.key()) + "\n"));
    }
  CHECK(keys > 100);
}

TEST_CASE("manual: a page that is none ends with 2 and the nearest name") {
  const Folder here;
  const Outcome outcome = here.run("manual bsh");
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.err, Contains("did you mean \"bash\"?"));
}

TEST_CASE("manual: bash completes every command and option") {
  if (!is_there("bash")) {
    WARN("not tried: there is no bash");
    return;
  }
  const Folder here;
  here.write("bash", manual_page("bash"));
  here.write("own.json", "{}");
  here.write("own.txt", "");
  const auto offered = [&](const std::string& words, const std::string& last) {
    const std::string script = "source ./bash; COMP_WORDS=(ricochet " + words + " '" + last +
                               "'); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _ricochet; echo \"${COMPREPLY[@]}\"";
    here.write("ask", script);
    REQUIRE(std::system(("cd '" + (here / "").string() + "' && bash ask >said 2>/dev/null").c_str()) == 0);
    return words_of(read(here / "said"));
  };
  CHECK(offered("", "") == names_of_commands());
  for (const Subcommand& command : subcommands()) {
    INFO(command.name);
    CHECK(offered(command.name, "--") == options_of(command));
  }
  CHECK(offered("run", "o") == Words{"own.json"});
  CHECK(offered("list", "m") == Words{"mass"});
  CHECK(offered("run own.json --plugin", "own") == Words{"own.json", "own.txt"});
  // A blank belongs to the name of its file.
  here.write("two words.json", "{}");
  here.write("ask",
             "source ./bash; COMP_WORDS=(ricochet run two); COMP_CWORD=2; _ricochet; echo \"${#COMPREPLY[@]} "
             "${COMPREPLY[0]}\"");
  REQUIRE(std::system(("cd '" + (here / "").string() + "' && bash ask >said 2>/dev/null").c_str()) == 0);
  CHECK(read(here / "said") == "1 two words.json\n");
  // Names are those that the program finds.
  here.write("ask",
             "source ./bash; ricochet() { printf 'role name\\ntime newmark\\ntime midpoint\\n'; }; "
             "COMP_WORDS=(ricochet describe new); COMP_CWORD=2; _ricochet; echo \"${COMPREPLY[@]}\"");
  REQUIRE(std::system(("cd '" + (here / "").string() + "' && bash ask >said 2>/dev/null").c_str()) == 0);
  CHECK(read(here / "said") == "newmark\n");
}

TEST_CASE("manual: fish completes every command and option, and zsh reads its own") {
  const Folder here;
  here.write("fish", manual_page("fish"));
  here.write("zsh", manual_page("zsh"));
  if (is_there("zsh")) CHECK(std::system(("zsh -n '" + (here / "zsh").string() + "'").c_str()) == 0);
  const std::string zsh = read(here / "zsh");
  for (const Subcommand& command : subcommands())
    for (const std::string& option : options_of(command)) CHECK_THAT(zsh, Contains(option + "["));
  if (!is_there("fish")) {
    WARN("not tried: there is no fish");
    return;
  }
  const auto offered = [&](const std::string& line) {
    REQUIRE(std::system(("cd '" + (here / "").string() + "' && HOME=. fish -c 'source ./fish; complete -C \"ricochet " +
                         line + "\"' 2>/dev/null | cut -f1 >said")
                            .c_str()) == 0);
    return words_of(read(here / "said"));
  };
  for (const Subcommand& command : subcommands()) {
    INFO(command.name);
    CHECK(offered(command.name + " --") == options_of(command));
    CHECK(offered(command.name.substr(0, 3)).count(command.name) == 1);
  }
}

TEST_CASE("The version says with what the program was built") {
  const Folder here;
  const std::string text = here.run("--version").out;
  CHECK_THAT(text, StartsWith("ricochet ") && Contains(", commit "));
  for (const char* name : {"compiler", "contract", "lanes", "libraries"}) {
    INFO(name);
    CHECK_THAT(text, Contains("\n" + std::string(name) + "  "));
  }
  for (const char* library : {"Eigen ", "CHOLMOD ", "Boost ", "nlohmann-json ", "muParser ", "SQLite ", "SQLiteCpp ",
                              "fmt ", "Spectra ", "cereal "})
    CHECK_THAT(text, Contains(library));
}

}  // namespace command_tests
