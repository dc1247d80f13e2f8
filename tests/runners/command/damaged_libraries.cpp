// Damaged copies of a plugin: `list` says what is wrong with each, or that it serves. No copy ends the command, keeps
// it waiting, or makes it speak of an internal error. RICOCHET_DAMAGED sets their number.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <iostream>
#include <map>
#include <random>

#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"

using Catch::Matchers::Contains;
using ricochet::tests::places;

namespace {

int number_of_copies() {
  const char* asked = std::getenv("RICOCHET_DAMAGED");
  constexpr int usual = 24;
  return asked ? std::atoi(asked) : usual;
}

class Damage {
 public:
  explicit Damage(std::string whole) : whole_(std::move(whole)) {}

  /// What is done to the copy of that number, and the copy.
  std::pair<std::string, std::string> copy(unsigned number) {
    random_.seed(number);
    std::string bytes = whole_;
    constexpr std::size_t header = 64, program_headers = 64 + 12 * 56, page = 4096;
    switch (number % 6) {
      case 0:
        return {"cut short", bytes.substr(0, below(bytes.size()))};
      case 1:
        flip(bytes, 16, header, 2);  // what makes it a library stays
        return {"changed in its header", bytes};
      case 2:
        flip(bytes, header, program_headers, 4);
        return {"changed in its program headers", bytes};
      case 3:
        flip(bytes, bytes.size() - bytes.size() / 8, bytes.size(), 8);
        return {"changed at its end", bytes};
      case 4: {
        const std::size_t from = below(bytes.size());
        for (std::size_t i = from; i < std::min(from + page, bytes.size()); ++i)
          bytes[i] = static_cast<char>(number % 12 == 4 ? 0 : random_());
        return {"without a page", bytes};
      }
      default:
        flip(bytes, 0, bytes.size(), 1 + below(64));
        return {"changed anywhere", bytes};
    }
  }

 private:
  std::size_t below(std::size_t end) { return random_() % end; }
  void flip(std::string& bytes, std::size_t from, std::size_t to, std::size_t most) {
    for (std::size_t left = 1 + below(most); left > 0; --left) {
      char& one = bytes[from + below(to - from)];
      one = static_cast<char>(static_cast<unsigned>(one) ^ (1U << below(8)));
    }
  }
  std::string whole_;
  std::mt19937 random_;
};

/// What a listing says of the copy, without its own words.
std::string verdict(const std::string& out) {
  for (const char* said :
       {"while it was loaded", "cannot be loaded", "damaged", "not a shared library", "another processor",
        "another ABI", "no Ricochet plugin", "names no method", "has no function", "says that it", "registers",
        "no manual", "another kind of binary", "failed while registering"})
    if (out.find(said) != std::string::npos) return said;
  return out.find("contact") != std::string::npos && out.find("unruly") != std::string::npos ? "serves"
                                                                                             : "is not there";
}

}  // namespace

TEST_CASE("damaged libraries: each is told, or serves, and nothing else comes of it") {
  const std::string whole = read_text(places().unruly + "/contact-unruly.so");
  REQUIRE(whole.size() > 10000);
  const ScratchFolder here;
  std::filesystem::create_directory(here / "plugins");
  const std::string library = (here / "plugins/contact-unruly.so").string(), out = (here / "out").string(),
                    err = (here / "err").string();
  // What it takes from a damaged library to be waited for ends after 10 s of loading and 3 s of its destructors.
  const std::string line = "ulimit -c 0; RICOCHET_PLUGIN_PATH='" + (here / "plugins").string() +
                           "' timeout -s KILL 300 '" + places().command + "' list contact >'" + out + "' 2>'" + err +
                           "' </dev/null";
  Damage damage(whole);
  std::map<std::string, int> met;
  const int copies = number_of_copies();
  for (int number = 0; number < copies; ++number) {
    const auto [what, bytes] = damage.copy(static_cast<unsigned>(number));
    write_text(library, bytes);
    const int status = std::system(line.c_str());
    const std::string said = read_text(out);
    INFO("copy " << number << ", " << what << ": " << said << read_text(err));
    REQUIRE(WIFEXITED(status));
    const int code = WEXITSTATUS(status);  // of a command that a signal ended the shell makes 128 and more
    CHECK((code == 0 || code == 4));
    CHECK_THAT(said, Contains("signorini"));
    CHECK_THAT(read_text(err), !Contains("internal error"));
    const std::string found = verdict(said);
    CHECK(found != "is not there");
    CHECK((code == 4 || found == "serves" || said.find("cannot serve") != std::string::npos));
    ++met[found];
  }
  std::cout << copies << " damaged libraries:";
  for (const auto& [found, count] : met) std::cout << " " << count << " " << found << ";";
  std::cout << "\n";
}
