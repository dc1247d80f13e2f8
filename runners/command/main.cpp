#include <fcntl.h>
#include <unistd.h>

#include <iostream>
#include <ricochet/loader/library.hpp>

#include "runners/command/command.hpp"

namespace {

// What is opened next does not get the number of a stream that was closed: what is printed would go there.
void keep_standard_streams() {
  int opened = ::open("/dev/null", O_RDONLY);
  while (opened >= 0 && opened <= STDERR_FILENO) opened = ::open("/dev/null", O_RDONLY);
  ::close(opened);
}

}  // namespace

int main(int argc, char** argv) {
  keep_standard_streams();
  const int code = ricochet::run_command({argv + (argc > 0 ? 1 : 0), argv + argc}, std::cout, std::cerr);
  if (!ricochet::foreign_code_ran()) return code;
  // Static destructors of third-party libraries are not to be trusted.
  std::cout.flush();
  std::cerr.flush();
  ::_exit(code);
}
