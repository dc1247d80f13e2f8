#pragma once
#include <string>

namespace ricochet::tests {

/// Where things lie, as CMake knows it. These paths stand in one source alone: all other objects are the same in every
/// folder, and a compiler cache finds them again.
struct Places {
  std::string source;                                    ///< folder of the project
  std::string build;                                     ///< folder of the build
  std::string command;                                   ///< the program `ricochet`
  std::string ranks;                                     ///< the program `ricochet-mpi`; empty where it is not built
  std::string plugins;                                   ///< folder of the methods that belong to the program
  std::string libraries;                                 ///< folder of a plugin that the catalogue's tests open
  std::string unruly;                                    ///< folder of one that harms its process
  std::string stumbling;                                 ///< library of one that fails as the tests of workers ask
  std::string cmake, generator, compiler, flags, eigen;  ///< what builds a project of plugins as this tree is built
};
const Places& places();

}  // namespace ricochet::tests
