#include "runners/store/temporary_folder.hpp"

#include <stdlib.h>

#include <cerrno>
#include <system_error>

#include "runners/store/atomic_file.hpp"

namespace ricochet {
namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& use) {
  std::string name = (fs::temp_directory_path() / ("ricochet-" + use + "-XXXXXX")).string();  // as mkdtemp() asks
  if (!::mkdtemp(name.data())) throw StoreError(name + ": " + std::generic_category().message(errno));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace ricochet
