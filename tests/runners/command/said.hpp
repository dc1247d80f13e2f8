#pragma once
#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"

/// What a command of a shell ended with and wrote.
struct CommandOutput {
  int code = -1;
  std::string out, err;
};

/// Runs the program in a folder with the plugins of the tree; `words` is a piece of shell, which may write its output
/// elsewhere.
inline CommandOutput say(const ScratchFolder& here, const std::string& words) {
  const std::string line = "cd '" + here.path().string() + "' && RICOCHET_PLUGIN_PATH='" +
                           ricochet::tests::places().plugins + "' '" + ricochet::tests::places().command + "' " +
                           words + " 2>.err </dev/null";
  const bool redirected = words.find('>') != std::string::npos;
  const int status = std::system((redirected ? line : line + " >.out").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, redirected ? "" : read_text(here / ".out"),
          read_text(here / ".err")};
}
