#include <fcntl.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <memory>
#include <ricochet/contract/errors.hpp>

#include "runners/json/json_text.hpp"
#include "runners/study/load_study.hpp"

namespace ricochet {
namespace {

constexpr const char* standard_input = "-";

/// A pipe without a place in any folder: opening it waits for nobody.
bool is_open_pipe(const std::filesystem::path& name) {
  struct statfs system {};
  return ::statfs(name.c_str(), &system) == 0 && system.f_type == PIPEFS_MAGIC;
}

std::string text_of(const std::filesystem::path& name) {
  const std::string expected = "a study";
  if (name == standard_input) return read_to_end(STDIN_FILENO, expected);
  if (!is_open_pipe(name)) return read_text(name, expected);
  const int descriptor = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
  const std::unique_ptr<const int, void (*)(const int*)> closing(&descriptor, [](const int* one) { ::close(*one); });
  return read_to_end(descriptor, expected);
}

}  // namespace

std::string StudyText::place_of(const std::filesystem::path& name) {
  return name == standard_input ? "standard input" : name.string();
}

bool StudyText::is_file(const std::filesystem::path& name) {
  return name != standard_input && !is_open_pipe(name);
}

StudyText::StudyText(const std::filesystem::path& name)
    : place(place_of(name)), folder(is_file(name) ? name.parent_path() : ""), text(text_of(name)) {}

}  // namespace ricochet
