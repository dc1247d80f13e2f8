#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <ricochet/loader/library.hpp>
#include <string_view>

#include "runners/command/command.hpp"
#include "runners/run/exit_code.hpp"

namespace {

std::terminate_handler usual_end = nullptr;

// What is opened next does not get the number of a stream that was closed: what is printed would go there.
void keep_standard_streams() {
  int opened = ::open("/dev/null", O_RDONLY);
  while (opened >= 0 && opened <= STDERR_FILENO) opened = ::open("/dev/null", O_RDONLY);
  ::close(opened);
}

// A thread beside the first one that finds no memory ends the program as the first one does: what is stored is kept.
[[noreturn]] void end_without_memory() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    constexpr std::string_view text = "ricochet: not enough memory\n";
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    ::_exit(ricochet::exit_store);
  } catch (...) {  // what else it is the system says
  }
  usual_end();
  std::abort();
}

}  // namespace

int main(int argc, char** argv) {
  keep_standard_streams();
  usual_end = std::set_terminate(end_without_memory);
  const int code = ricochet::run_command({argv + (argc > 0 ? 1 : 0), argv + argc}, std::cout, std::cerr);
  if (!ricochet::foreign_code_ran()) return code;
  // Static destructors of third-party libraries are not to be trusted.
  std::cout.flush();
  std::cerr.flush();
  ::_exit(code);
}
