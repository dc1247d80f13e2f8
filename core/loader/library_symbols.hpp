#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {

/// A symbol that a library defines, with the size of its object in bytes (of a function: of its code).
struct ExportedSymbol {
  std::string name;
  std::uint64_t size = 0;
};

/// The symbols, of names that begin with `prefix`, that a shared library defines for others, by name, read from the
/// file's dynamic symbol table: none of its code runs, and a stripped library still tells them. Throws
/// std::runtime_error with a reason ("not a shared library", "damaged: …", "built for another processor") when the file
/// has no such table to read; whatever bytes the file holds, nothing outside of it is read. Source: System V ABI,
/// chapters 4 and 5.
std::vector<ExportedSymbol> exported_symbols(const std::filesystem::path& file, std::string_view prefix);

}  // namespace ricochet
