// What the pages tell a reader to type is typed, and what they say that it prints is compared.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "runners/command/describe_words.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
namespace fs = std::filesystem;

namespace {

const fs::path root = RICOCHET_SOURCE_DIR;

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

TEST_CASE("pages: the tutorial does what it says, line by line") {
  const ScratchFolder folder;
  int commands = 0, files = 0;
  for (const Block& block : blocks_of(root / "studies/tutorial.md")) {
    if (block.info.starts_with("json ")) {
      std::string text;
      for (const std::string& line : block.lines) text += line + "\n";
      write_text(folder.path() / block.info.substr(5), text);
      ++files;
      continue;
    }
    REQUIRE(block.info == "console");
    for (std::size_t i = 0; i < block.lines.size();) {
      REQUIRE(block.lines[i].starts_with("$ "));
      const std::string command = block.lines[i++].substr(2);
      std::vector<std::string> expected;
      while (i < block.lines.size() && !block.lines[i].starts_with("$ ")) expected.push_back(block.lines[i++]);
      const std::string line = "cd '" + folder.path().string() + "' && PATH=\"" +
                               fs::path(RICOCHET_COMMAND).parent_path().string() +
                               ":$PATH\" RICOCHET_PLUGIN_PATH= && " + command + " >.out 2>.err </dev/null";
      const int status = std::system(line.c_str());
      const std::string output = read_text(folder.path() / ".out");
      CAPTURE(command, output, read_text(folder.path() / ".err"));
      CHECK(status == 0);
      CHECK(first_missing(expected, lines_of(output)) == "");
      ++commands;
    }
  }
  CHECK(commands >= 6);
  CHECK(files == 2);
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

TEST_CASE("pages: the README is short, its study is one, and what it points at is there") {
  const std::string readme = read_text(root / "README.md");
  std::istringstream stream(readme);
  int words = 0;
  for (std::string word; stream >> word;) ++words;
  CHECK(words <= 900);
  for (const char* page : {"README.md", "studies/tutorial.md", "studies/README.md", "runners/README.md",
                           "plugins/README.md", "core/README.md", "tests/README.md"}) {
    const std::string text = read_text(root / page);
    for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
      const std::string target = text.substr(at + 2, text.find(')', at) - at - 2);
      if (target.starts_with("#") || target.starts_with("http")) continue;
      CAPTURE(page, target);
      CHECK(fs::exists((root / page).parent_path() / target.substr(0, target.find('#'))));
    }
  }
  const ScratchFolder folder;
  for (const Block& block : blocks_of(root / "README.md")) {
    if (block.info != "json") continue;
    std::string text;
    for (const std::string& line : block.lines) text += line + "\n";
    write_text(folder.path() / "study.json", text);
    const std::string line = "RICOCHET_PLUGIN_PATH= '" RICOCHET_COMMAND "' plan '" +
                             (folder.path() / "study.json").string() + "' >/dev/null 2>&1";
    CHECK(std::system(line.c_str()) == 0);
  }
}
