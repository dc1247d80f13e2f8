#pragma once
#include <filesystem>
#include <functional>
#include <ricochet/contract/registry.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// Loads a library into this process and lets it register. It stays open for the life of the process, also when
/// registering fails: an exception, or a copy of what was registered, may hold its code. Throws PluginError, which
/// names the file.
void load_library(const std::filesystem::path& file, Registry& registry);

/// What a library registers, found by a child process that loads it. Its manuals are here. Its code is not: a factory
/// loads the library where it is asked for an object, which only a process does in which ForeignCode may run.
/// `remark`: is told what the child met when it let its static destructors run. Throws PluginError, which names the
/// file, where the library does not load, ends the child, or does not come to an end within 10 s.
Registry describe_library(const std::filesystem::path& file, const std::function<void(const std::string&)>& remark);

/// The libraries that children of this process were asked to describe, in the order of their names.
std::vector<std::filesystem::path> described_libraries();

/// Whether this process loaded a library in the place of a child.
bool foreign_code_ran();

/// The manuals of all methods, as bytes.
std::string manuals_to_bytes(const Registry& registry);

/// Methods with these manuals, and with factories that load the file. Texts are cut at `longest_text`. Throws
/// PluginError for bytes that are none, and as Registry does.
Registry methods_of_manuals(const std::string& bytes, const std::filesystem::path& file);

}  // namespace ricochet
