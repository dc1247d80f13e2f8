#pragma once
#include <string_view>

namespace ricochet::report {

/// A file that reports inline, carried inside the program (see page.cmake): "page.css", "script/page.js",
/// "kinds/tip.js" (whatever the folder of the kind). Empty for a name that it does not carry.
std::string_view asset(std::string_view name);

}  // namespace ricochet::report

/// Carries a file inside the program, byte by byte, by the assembler, between symbol_begin and symbol_end:
/// RICOCHET_EMBED(symbol, "path").
#define RICOCHET_EMBED(symbol, file)                                                              \
  asm(".pushsection .rodata\n"                                                                    \
      ".global " #symbol "_begin\n.hidden " #symbol "_begin\n" #symbol "_begin:\n.incbin \"" file \
      "\"\n"                                                                                      \
      ".global " #symbol "_end\n.hidden " #symbol "_end\n" #symbol                                \
      "_end:\n.byte 0\n"                                                                          \
      ".popsection\n");                                                                           \
  extern "C" {                                                                                    \
  __attribute__((visibility("hidden"))) extern const char symbol##_begin[];                       \
  __attribute__((visibility("hidden"))) extern const char symbol##_end[];                         \
  }
