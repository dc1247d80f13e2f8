#pragma once
#include <filesystem>

namespace ricochet {

/// The folder of the plugins that belong to this program, found from where the program lies: an installation may be
/// moved as a whole.
std::filesystem::path installed_plugins();

/// The folder of its pages and studies; empty where it is not installed.
std::filesystem::path installed_data();

}  // namespace ricochet
