#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/places.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

namespace command_tests {

struct Outcome {
  int code = -1;
  std::string out, err;
};

inline std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A fresh folder that goes when the test ends.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "ricochet-command-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path& path() const { return path_; }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  /// Runs the command here; `words` is a piece of shell.
  Outcome run(const std::string& words, const std::string& environment = "") const {
    const std::string line = "cd '" + path_.string() + "' && RICOCHET_PLUGIN_PATH= " + environment + " '" +
                             ricochet::tests::places().command + "' " + words + " >'" + (path_ / ".out").string() +
                             "' 2>'" + (path_ / ".err").string() + "' </dev/null";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(path_ / ".out"), read(path_ / ".err")};
  }

 private:
  fs::path path_;
};

inline nlohmann::ordered_json tiny() {
  return nlohmann::ordered_json::parse(R"({
    "name": "tiny", "question": "Does it run?", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                            "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}, "damping": {"stiffness": 1e-4}},
              "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"},
              "initial": {"displacement": "0.04*x^2", "velocity": "-2*x"}},
    "mesh": {"elements": 4},
    "methods": {"mass": ["consistent", "singular"], "contact": ["signorini"],
                "time": [{"name": "newmark-dumont-paoli", "beta": [0.1, 0.5]}]},
    "step": [1e-4], "duration": 0.01, "samples": 10
  })");
}

/// Line of the first occurrence of `part`, from 1.
inline std::string line_of(const std::string& text, const std::string& part) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(text.find(part));
  return std::to_string(1 + std::count(text.begin(), end, '\n'));
}

}  // namespace command_tests
