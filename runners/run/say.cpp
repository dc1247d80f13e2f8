#include "runners/run/say.hpp"

#include <unistd.h>

#include <string>

#include "runners/table/text.hpp"

namespace ricochet {
namespace {

void write(std::FILE* out, std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), out);
  std::fflush(out);
}

}  // namespace

void say(std::FILE* out, std::string_view text) {
  write(out, plain_text(text));
}

void say_in_place(std::FILE* out, std::string_view line) {
  write(out, "\r" + plain_text(line) + "\x1b[K");
}

bool is_terminal(std::FILE* out) {
  return ::isatty(::fileno(out)) != 0;
}

}  // namespace ricochet
