#pragma once
#include <span>
#include <string_view>

namespace ricochet {

/// A file of plugins/examples/ROLE, carried inside the program (see examples.cmake).
struct ExampleFile {
  std::string_view role, name, text;
};
std::span<const ExampleFile> example_files();

}  // namespace ricochet
