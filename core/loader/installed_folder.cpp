#include <filesystem>
#include <ricochet/loader/installed_folder.hpp>

#ifndef RICOCHET_INSTALLED_PLUGINS
#define RICOCHET_INSTALLED_PLUGINS "../lib/ricochet"
#endif
#ifndef RICOCHET_INSTALLED_DATA
#define RICOCHET_INSTALLED_DATA "../share/ricochet"
#endif

namespace ricochet {
namespace fs = std::filesystem;
namespace {

fs::path beside_program(const char* relative) {
  return (fs::read_symlink("/proc/self/exe").parent_path() / relative).lexically_normal();
}

}  // namespace

fs::path installed_plugins() {
  std::error_code ignored;
  const fs::path configured = beside_program(RICOCHET_INSTALLED_PLUGINS);
  // In the folder of a build, libraries lie in lib whatever they are installed into.
  return fs::is_directory(configured, ignored) ? configured : beside_program("../lib/ricochet");
}

fs::path installed_data() {
  std::error_code ignored;
  const fs::path configured = beside_program(RICOCHET_INSTALLED_DATA);
  return fs::is_directory(configured, ignored) ? configured : fs::path();
}

}  // namespace ricochet
