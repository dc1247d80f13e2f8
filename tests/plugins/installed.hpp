#pragma once
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"

namespace fs = std::filesystem;

struct Outcome {
  int code = -1;
  std::string out, err;
};

/// Runs a line of shell in a folder.
inline Outcome shell(const fs::path& folder, const std::string& line) {
  const std::string out = (folder / ".out").string(), err = (folder / ".err").string();
  const std::string all = "cd '" + folder.string() + "' && (" + line + ") >'" + out + "' 2>'" + err + "' </dev/null";
  const int status = std::system(all.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

/// Ricochet installed into a folder away from the tree, so that nothing is found there by accident.
class Prefix {
 public:
  static const Prefix& once() {
    static const Prefix all;
    return all;
  }
  fs::path prefix() const { return here_ / "prefix"; }
  /// The installed example of a role.
  fs::path example(const std::string& role) const { return prefix() / "share/ricochet/examples" / role; }
  const ScratchFolder& folder() const { return here_; }

  /// Runs the installed command in a folder.
  Outcome run(const fs::path& folder, const std::string& words, const std::string& plugin_path = "") const {
    return shell(folder,
                 "RICOCHET_PLUGIN_PATH='" + plugin_path + "' '" + (prefix() / "bin/ricochet").string() + "' " + words);
  }

 protected:
  Prefix() {
    step("'" + ricochet::tests::places().cmake + "' --install '" + ricochet::tests::places().build +
         "' --prefix prefix");
  }
  void step(const std::string& line) const {
    const Outcome outcome = shell(here_.path(), line);
    INFO(line << "\n" << outcome.out << outcome.err);
    REQUIRE(outcome.code == 0);
  }
  ScratchFolder here_;
};

/// The same, and the project of plugins in tests/plugins/out_of_tree built against what lies there.
class Installed : public Prefix {
 public:
  static const Installed& once() {
    static const Installed all;
    return all;
  }
  fs::path plugins() const { return here_ / "build" / "plugins"; }
  fs::path plugin(const std::string& name) const { return plugins() / ("time-" + name + ".so"); }

 private:
  Installed() {
    fs::copy(ricochet::tests::places().source + "/tests/plugins/out_of_tree", here_ / "project");
    fs::copy(example("time") / "leap-frog.cpp", here_ / "project/time-leap-frog.cpp");
    step("'" + ricochet::tests::places().cmake + "' -S project -B build -G '" + ricochet::tests::places().generator +
         "' -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1"
         " -DCMAKE_CXX_COMPILER='" +
         ricochet::tests::places().compiler + "' -DCMAKE_CXX_FLAGS='" + ricochet::tests::places().flags +
         "' -DCMAKE_PREFIX_PATH='" + prefix().string() + "' -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF");
    step("'" + ricochet::tests::places().cmake + "' --build build");
  }
};

/// The rows of a CSV table, by the names of its columns.
inline std::vector<std::map<std::string, std::string>> read_cases(const fs::path& file) {
  std::istringstream text(read_text(file));
  const auto cells = [](const std::string& line) {
    std::vector<std::string> result;
    std::string cell;
    bool quoted = false;
    for (const char c : line) {
      if (c == '"')
        quoted = !quoted;
      else if (c == ',' && !quoted)
        result.push_back(std::exchange(cell, ""));
      else if (c != '\r')
        cell += c;
    }
    result.push_back(cell);
    return result;
  };
  std::string line;
  std::getline(text, line);
  const auto columns = cells(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(text, line)) {
    const auto values = cells(line);
    REQUIRE(values.size() == columns.size());
    for (std::size_t i = (rows.emplace_back(), 0); i < columns.size(); ++i) rows.back()[columns[i]] = values[i];
  }
  return rows;
}
