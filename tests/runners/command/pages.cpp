// What the pages tell a reader to type is typed, and what they say that it prints is compared.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "runners/command/subcommand.hpp"
#include "tests/places.hpp"
#include "tests/runners/command/page_figures.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
namespace fs = std::filesystem;

namespace {

const fs::path root = tests::places().source;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// A piece of a page between fences: what follows the opening one, and the lines.
struct Block {
  std::string info;
  std::vector<std::string> lines;
};

std::vector<Block> blocks_of(const fs::path& page) {
  std::vector<Block> blocks;
  bool inside = false;
  for (const std::string& line : lines_of(read_text(page))) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) blocks.push_back({line.substr(3), {}});
    } else if (inside) {
      blocks.back().lines.push_back(line);
    }
  }
  CHECK_FALSE(inside);
  return blocks;
}

const std::string gap = "…";

/// Whether a line is as the page has it; a gap in it stands for any text.
bool same_line(const std::string& page, const std::string& line) {
  std::size_t at = 0;
  bool first = true;
  std::string rest = page;
  for (;;) {
    const std::size_t end = rest.find(gap);
    const std::string piece = rest.substr(0, end);
    const std::size_t found = line.find(piece, at);
    if (found == std::string::npos || (first && found != 0)) return false;
    if (end == std::string::npos) return line.ends_with(piece) && line.size() - piece.size() >= at;
    at = found + piece.size();
    rest = rest.substr(end + gap.size());
    first = false;
  }
}

/// The first line of the page that the output does not have in its order; "" where it has all. A line that is a gap
/// stands for any lines.
std::string first_missing(const std::vector<std::string>& page, const std::vector<std::string>& output) {
  std::size_t at = 0;
  bool free = false;
  for (const std::string& expected : page) {
    if (expected == gap) {
      free = true;
      continue;
    }
    std::size_t found = at;
    while (free && found < output.size() && !same_line(expected, output[found])) ++found;
    if (found >= output.size() || !same_line(expected, output[found])) return expected;
    at = found + 1;
    free = false;
  }
  return !free && at < output.size() ? "(no further line) " + output[at] : "";
}

}  // namespace

TEST_CASE("pages: a gap stands for what differs, and for nothing else") {
  CHECK(same_line("4 cases: 4 done …", "4 cases: 4 done (4 run now in 1.2 s, 0 kept)"));
  CHECK(same_line("a … c … e", "a b c d e"));
  CHECK_FALSE(same_line("a … c", "a b d"));
  CHECK_FALSE(same_line("a", "ab"));
  CHECK_FALSE(same_line("… b", "b a"));
  CHECK(first_missing({"a", "…", "c"}, {"a", "b", "c"}).empty());
  CHECK(first_missing({"a", "c"}, {"a", "b", "c"}) == "c");
  CHECK(first_missing({"a"}, {"a", "b"}) == "(no further line) b");
  CHECK(first_missing({"a", "…"}, {"a", "b"}).empty());
}

namespace {

/// Types a page: a block with a language and a name is a file, each line of `console` after "$ " a command, and what
/// follows it is what it prints. Returns the number of commands.
int type_page(const fs::path& page) {
  const ScratchFolder folder;
  int commands = 0;
  for (const Block& block : blocks_of(page)) {
    if (const std::size_t space = block.info.find(' '); space != std::string::npos) {
      std::string text;
      for (const std::string& line : block.lines) text += line + "\n";
      write_text(folder.path() / block.info.substr(space + 1), text);
      continue;
    }
    if (block.info != "console") continue;
    for (std::size_t i = 0; i < block.lines.size();) {
      REQUIRE(block.lines[i].starts_with("$ "));
      const std::string command = block.lines[i++].substr(2);
      std::vector<std::string> expected;
      while (i < block.lines.size() && !block.lines[i].starts_with("$ ")) expected.push_back(block.lines[i++]);
      const std::string line = "cd '" + folder.path().string() + "' && PATH=\"" +
                               fs::path(tests::places().command).parent_path().string() +
                               ":$PATH\" RICOCHET_PLUGIN_PATH= && { " + command + "; } >.out 2>.err </dev/null";
      const int status = std::system(line.c_str());
      const std::string output = read_text(folder.path() / ".out");
      CAPTURE(page, command, output, read_text(folder.path() / ".err"));
      CHECK(status == 0);
      CHECK(first_missing(expected, lines_of(output)) == "");
      ++commands;
    }
  }
  return commands;
}

/// All of Markdown but what a build or a run wrote.
std::vector<fs::path> pages_of_tree() {
  std::vector<fs::path> pages = {root / "README.md"};
  for (const char* folder : {".github", "core", "plugins", "runners", "studies", "tests"})
    for (const auto& item : fs::recursive_directory_iterator(root / folder))
      if (item.path().extension() == ".md" && item.path().string().find("node_modules") == std::string::npos)
        pages.push_back(item.path());
  return pages;
}

}  // namespace

TEST_CASE("pages: each page with commands does what it says, line by line") {
  // Pages by task begin with a study that runs, and are short.
  const std::set<std::string> tasks = {"runners/tube.md",         "runners/matrices.md", "runners/earthquake.md",
                                       "runners/which-scheme.md", "runners/compare.md",  "runners/operations.md",
                                       "plugins/own.md"};
  std::set<std::string> typed;
  for (const fs::path& page : pages_of_tree()) {
    const std::string text = read_text(page), name = fs::relative(page, root).string();
    CAPTURE(name);
    if (text.find("```console\n$ ") == std::string::npos) continue;
    typed.insert(name);
    CHECK(type_page(page) >= 1);
  }
  for (const char* name : {"studies/tutorial.md", "runners/modes.md"}) CHECK(typed.contains(name));
  for (const std::string& name : tasks) {
    CAPTURE(name);
    CHECK(typed.contains(name));
    std::istringstream stream(read_text(root / name));
    CHECK(std::distance(std::istream_iterator<std::string>(stream), {}) <= 1200);
    const std::vector<Block> blocks = blocks_of(root / name);
    REQUIRE_FALSE(blocks.empty());
    CHECK((blocks.front().info.find(' ') != std::string::npos || blocks.front().info == "console"));
  }
}

TEST_CASE("pages: every study key is written down as the program has it") {
  std::ostringstream keys;
  REQUIRE(describe_word("study", keys));
  const std::vector<Block> blocks = blocks_of(root / "runners/study-keys.md");
  REQUIRE(blocks.size() == 1);
  std::string written;
  for (const std::string& line : blocks.front().lines) written += line + "\n";
  // `ricochet describe study` says what belongs there.
  CHECK(written == keys.str());
}

TEST_CASE("pages: the reader of verdicts in Python prints every sentence") {
  if (std::system("python3 -c '' >/dev/null 2>&1") != 0) {
    WARN("not tried: there is no python3");
    return;
  }
  const ScratchFolder folder;
  write_text(folder / "rod.json", R"({
    "name": "rod", "kind": "trajectory", "duration": 1, "samples": 10, "step": [0.01, 0.005],
    "ask": [{"runs": true}, {"value": "energy_end"}],
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1}, "stops": {"upper": 0.1, "at": "tip"},
              "initial": {"velocity": "1"}},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e3}, "time": "newmark"}})");
  for (const Block& block : blocks_of(root / "runners/README.md")) {
    if (block.info != "python") continue;
    std::string script;
    for (const std::string& line : block.lines) script += line + "\n";
    write_text(folder / "read.py", script);
  }
  const std::string line = "cd '" + folder.path().string() + "' && RICOCHET_PLUGIN_PATH= '" + tests::places().command +
                           "' run rod.json >run.txt 2>&1 && PYTHONIOENCODING=utf-8 python3 read.py >said.txt 2>&1";
  CHECK(std::system(line.c_str()) == 0);
  const std::vector<std::string> said = lines_of(read_text(folder / "said.txt"));
  CAPTURE(read_text(folder / "run.txt"), read_text(folder / "said.txt"));
  REQUIRE(said.size() == 2);
  CHECK_THAT(said[0], Catch::Contains("1 yes Yes: "));
  CHECK_THAT(said[1], Catch::StartsWith("2 "));
}

TEST_CASE("pages: the README is short, its study is one, and what it points at is there") {
  const std::string readme = read_text(root / "README.md");
  std::istringstream stream(readme);
  int words = 0;
  for (std::string word; stream >> word;) ++words;
  CHECK(words <= 900);
  for (const fs::path& page : pages_of_tree()) {
    const std::string text = read_text(page);
    for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
      const std::string target = text.substr(at + 2, text.find(')', at) - at - 2);
      if (target.starts_with("#") || target.starts_with("http")) continue;
      CAPTURE(page, target);
      CHECK(fs::exists(page.parent_path() / target.substr(0, target.find('#'))));
    }
  }
  const ScratchFolder folder;
  for (const Block& block : blocks_of(root / "README.md")) {
    if (block.info != "json") continue;
    std::string text;
    for (const std::string& line : block.lines) text += line + "\n";
    write_text(folder.path() / "study.json", text);
    const std::string line = "RICOCHET_PLUGIN_PATH= '" + tests::places().command + "' plan '" +
                             (folder.path() / "study.json").string() + "' >/dev/null 2>&1";
    CHECK(std::system(line.c_str()) == 0);
  }
}

TEST_CASE("pages: a figure is that of the rows and columns that it names") {
  const tests::CsvTable table = tests::read_csv(
      "mass,step,status,\"end, J\",class\n"
      "full,1e-3,done,0.5,\"no "
      "contact\"\nfull,0.0001,done,0.25,chaotic\nlumped,1e-4,done,2e-7,\nlumped,1e-3,failed,,\n");
  REQUIRE(table.rows.size() == 4);
  const tests::TablesOf tables = [&](const std::string& study, const std::string& name) -> const tests::CsvTable& {
    if (study != "swing" || name != "cases") throw std::runtime_error("there is no table " + name);
    return table;
  };
  const auto now = [&](const std::string& text) { return tests::compare_page(text, tables).text; };
  const auto said = [&](const std::string& text) {
    const tests::PageFigures found = tests::compare_page(text, tables);
    CAPTURE(text);
    REQUIRE(found.wrong.size() == 1);
    return found.wrong.front();
  };
  const auto marked = [](const std::string& old, const std::string& mark) { return old + "<!--= " + mark + " -->"; };
  for (const auto& [value, mark] : std::vector<std::pair<std::string, std::string>>{
           {"50.0", "swing cases mass=full step=1e-3; 100 * \"end, J\"; %.1f"},
           {"2e-7", "swing cases mass=lumped step=1e-4; \"end, J\"; %.0e"},
           {"3", "swing cases status=done; count; %.0f"},
           {"1", "swing cases status=failed,refused; count; %.0f"},
           {"1", "swing cases \"class=no contact\"; count; %.0f"},
           {"2", "swing cases step<5e-4; count; %.0f"},
           {"0.25", "swing cases mass=full; spread \"end, J\"; %.2f"},
           {"0.38", "swing cases mass=full; mean \"end, J\"; %.2f"},
           {"2", "swing cases mass=full step=1e-3; \"end, J\" / [step=1e-4] \"end, J\"; %.0f"},
           {"0.50", "swing cases mass=full step=1e-4; sqrt \"end, J\"; %.2f"}}) {
    CAPTURE(mark);
    CHECK(now("it is (" + marked("7.5e-3", mark) + " m)") == "it is (" + marked(value, mark) + " m)");
    CHECK(tests::compare_page(marked(value, mark), tables).wrong.empty());
  }
  CHECK(said(marked("0.4", "swing cases mass=full; 100 * spread \"end, J\"; %.2f")) ==
        "line 1: swing cases mass=full; 100 * spread \"end, J\"; %.2f: written 0.4, computed 25.00");
  CHECK_THAT(said(marked("1", "swing cases mass=full; \"end, J\"; %.2f")), Catch::Contains("2 rows; expected one"));
  CHECK_THAT(said(marked("1", "swing cases mass=fall; max \"end, J\"; %.2f")), Catch::Contains("no row"));
  CHECK_THAT(said(marked("1", "swing cases mas=full; count; %.0f")), Catch::Contains("no column mas"));
  CHECK_THAT(said(marked("1", "swing orders; count; %.0f")), Catch::Contains("there is no table orders"));
  CHECK_THAT(said(marked("1", "swing cases mass=full; count")), Catch::Contains("expected rows; expression; format"));
  // Those of studies that are not asked for stay.
  const std::string other = marked("1", "swing cases; count; %.0f");
  CHECK(tests::compare_page(other, tables, {"roll"}).figures == 0);

  const std::string one =
      "| scheme<!--| swing cases mass --> | J<!--| step=1e-3; {\"end, J\" %.2f}; {status} --> |\n|---|---|\n";
  CHECK(now(one + "| full | 0.5 |\n| lumped | |\n") == one + "| full | 0.50 |\n| lumped | failed |\n");
}

TEST_CASE("pages: what studies found is what they find") {
  // Studies of a few seconds, none of them chaotic.
  const std::set<std::string> quick = {"quick",       "restitution",      "energy-damped",    "family-free",
                                       "family-laws", "extreme-sections", "published-sdnd101"};
  const ScratchFolder folder;
  const tests::TablesOf tables = tests::tables_in(folder.path(), [&](const std::string& study) {
    const std::string line = "RICOCHET_PLUGIN_PATH= '" + tests::places().command + "' run '" +
                             (root / "studies" / (study + ".json")).string() + "' --out '" +
                             (folder.path() / study).string() + "' >/dev/null 2>&1";
    CHECK(std::system(line.c_str()) == 0);
  });
  int figures = 0;
  for (const fs::path& page : tests::pages_of_findings(root)) {
    const std::string text = read_text(page);
    // The section of a study says where its figures are from, or when it ran.
    for (std::size_t at = text.find("\n## "); at != std::string::npos;) {
      const std::size_t next = text.find("\n## ", at + 1);
      const std::string section = text.substr(at + 4, next - at - 4);
      CAPTURE(page, section);
      CHECK((section.starts_with("published-") || section.find("<!--= ") != std::string::npos ||
             section.find("<!-- run ") != std::string::npos));
      at = next;
    }
    for (const std::string& study : tests::studies_of(text)) {
      CAPTURE(page, study);
      CHECK(fs::exists(root / "studies" / (study + ".json")));
    }
    const tests::PageFigures compared = tests::compare_page(text, tables, quick);
    figures += compared.figures;
    for (const std::string& wrong : compared.wrong)
      FAIL_CHECK(page.filename().string() << ", " << wrong << " (`sh tests/pages.sh fill` mends the page)");
  }
  CHECK(figures >= 25);
}
